"""Change one thing in a measured log or in the description of its robot.

Only what is added is computed; motion and all else that the torque holds are as measured. Torques of added
bodies and forces come from pinocchio.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pinocchio as pin
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

from tests.tools import Motion, pinocchio_model, pinocchio_torque
from veritorque.core.log.model import JointLog, LogRows, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.inertia import from_mass_properties
from veritorque.core.robot.model import RobotModel

SMOOTH_HZ = 10.0
"""Cut-off below which the motion of measured positions is taken for what is added."""
Array = np.ndarray


def with_torque(log: JointLog, changed: Callable[[LogRows], Array]) -> JointLog:
    """Give the log with another torque."""
    rows = whole_rows(log)
    return log_from_arrays(log.name, rows.time, rows.position, changed(rows))


def with_position(log: JointLog, changed: Callable[[LogRows], Array]) -> JointLog:
    """Give the log with other positions."""
    rows = whole_rows(log)
    return log_from_arrays(log.name, rows.time, changed(rows), rows.torque)


def only_joint(rows: LogRows, joint: int, torque: Array) -> Array:
    """Add a torque to one joint (from 1)."""
    out = np.array(rows.torque)
    out[:, joint - 1] += torque
    return out


def smooth_motion(rows: LogRows) -> Motion:
    """Give the motion below `SMOOTH_HZ`, on an even clock and back."""
    step = float(np.median(np.diff(rows.time)))
    even = np.arange(rows.time[0], rows.time[-1] + 0.5 * step, step)
    low_pass = butter(3, min(0.9, 2.0 * SMOOTH_HZ * step), output="sos")
    columns = np.column_stack([np.interp(even, rows.time, column) for column in rows.position.T])
    position = sosfiltfilt(low_pass, columns, axis=0)
    velocity = np.gradient(position, step, axis=0)
    acceleration = np.gradient(velocity, step, axis=0)

    def back(series: Array) -> Array:
        return np.column_stack([np.interp(rows.time, even, column) for column in series.T])

    return Motion(back(position), back(velocity), back(acceleration))


def delayed(log: JointLog, seconds: float) -> JointLog:
    """Delay all torques."""

    def late(rows: LogRows) -> Array:
        return np.column_stack([np.interp(rows.time - seconds, rows.time, one) for one in rows.torque.T])

    return with_torque(log, late)


def filtered(log: JointLog, seconds: float) -> JointLog:
    """Pass all torques through a low-pass filter of first order, as a recorder does."""

    def passed(rows: LogRows) -> Array:
        share = 1.0 - np.exp(-np.diff(rows.time) / seconds)
        out = np.array(rows.torque)
        for row, part in enumerate(share, start=1):
            out[row] = out[row - 1] + part * (rows.torque[row] - out[row - 1])
        return out

    return with_torque(log, passed)


def scaled(log: JointLog, joint: int, factor: float) -> JointLog:
    """Multiply one joint's torque."""
    return with_torque(log, lambda rows: only_joint(rows, joint, (factor - 1.0) * rows.torque[:, joint - 1]))


def clipped(log: JointLog, joint: int, share: float) -> JointLog:
    """Limit one joint's torque to a share of the largest."""

    def limited(rows: LogRows) -> Array:
        most = share * float(np.max(np.abs(rows.torque[:, joint - 1])))
        out = np.array(rows.torque)
        out[:, joint - 1] = np.clip(out[:, joint - 1], -most, most)
        return out

    return with_torque(log, limited)


def sprung(log: JointLog, joint: int, stiffness: float, rest: float) -> JointLog:
    """Hold a joint by a spring (N m/rad) at rest somewhere (rad): the drive has to hold against it."""
    return with_torque(
        log, lambda rows: only_joint(rows, joint, stiffness * (rows.position[:, joint - 1] - rest))
    )


def rippled(log: JointLog, joint: int, amplitude: float, cycles: int) -> JointLog:
    """Add a wave over the joint's angle."""
    return with_torque(
        log, lambda rows: only_joint(rows, joint, amplitude * np.sin(cycles * rows.position[:, joint - 1]))
    )


def rubbing(log: JointLog, joint: int, more: float) -> JointLog:
    """Add Coulomb friction (N m)."""
    return with_torque(
        log, lambda rows: only_joint(rows, joint, more * np.sign(smooth_motion(rows).velocity[:, joint - 1]))
    )


def warming(log: JointLog, joint: int, viscous: float, seconds: float) -> JointLog:
    """Add viscous friction (N m s/rad) that decays while the joint warms up."""

    def added(rows: LogRows) -> Array:
        speed = smooth_motion(rows).velocity[:, joint - 1]
        return only_joint(rows, joint, viscous * np.exp(-(rows.time - rows.time[0]) / seconds) * speed)

    return with_torque(log, added)


def drifting(log: JointLog, joint: int, torque: float) -> JointLog:
    """Let a torque's zero drift evenly, by so much (N m) from begin to end."""

    def added(rows: LogRows) -> Array:
        return only_joint(rows, joint, torque * (rows.time - rows.time[0]) / float(np.ptp(rows.time)))

    return with_torque(log, added)


def turned_encoder(log: JointLog, joint: int, angle: float) -> JointLog:
    """Let an encoder read too much (rad)."""
    return with_position(log, lambda rows: rows.position + angle * (np.arange(log.joints) == joint - 1))


def loaded(log: JointLog, robot: RobotModel, mass: float, centre: Array) -> JointLog:
    """Fix a body (kg; centre, m, in the frame of the last link) to the last link."""
    bodies = np.zeros((len(robot.links), 10))
    bodies[-1] = from_mass_properties(mass, centre, 0.004 * mass * np.eye(3))

    def added(rows: LogRows) -> Array:
        return np.asarray(rows.torque + pinocchio_torque(robot, bodies, smooth_motion(rows)))

    return with_torque(log, added)


def pushed(log: JointLog, robot: RobotModel, span: tuple[float, float], torque: float) -> JointLog:
    """Push the last link between two instants (s), so that some joint has to hold so much (N m)."""

    def added(rows: LogRows) -> Array:
        unit = torque_of_unit_push(rows, robot, span)
        inside = (rows.time > span[0]) & (rows.time < span[1])
        shape = np.sin(np.pi * (rows.time - span[0]) / (span[1] - span[0])) * inside
        return np.asarray(rows.torque - torque / np.max(np.abs(unit)) * shape[:, None] * unit)

    return with_torque(log, added)


def torque_of_unit_push(rows: LogRows, robot: RobotModel, span: tuple[float, float]) -> Array:
    """Give the joints' torque (N m) under a push of 1 N where the arm is in the middle of a span (s)."""
    model = pinocchio_model(
        robot, np.tile(from_mass_properties(1.0, np.zeros(3), np.eye(3)), (len(robot.links), 1))
    )
    data = model.createData()
    inside = (rows.time > span[0]) & (rows.time < span[1])
    middle = rows.position[inside][inside.sum() // 2]
    jacobian = pin.computeJointJacobian(model, data, middle, model.njoints - 1)
    way = np.array([0.3, 0.4, -0.87])
    force = data.oMi[model.njoints - 1].rotation.T @ (way / np.linalg.norm(way))
    return np.asarray(jacobian[:3].T @ force)


def with_row(robot: RobotModel, joint: int, **changes: float) -> RobotModel:
    """Describe a link's row with other entries, each by so much more."""
    links = list(robot.links)
    old = links[joint - 1]
    assert old.row is not None
    row = replace(old.row, **{name: getattr(old.row, name) + by for name, by in changes.items()})
    rotation, translation = row.placement()
    links[joint - 1] = replace(old, rotation=rotation, translation=translation, row=row)
    return replace(robot, links=tuple(links))


def tilted(robot: RobotModel, angle: float, about: Array) -> RobotModel:
    """Describe the base tilted (rad)."""
    turned = Rotation.from_rotvec(angle * about / np.linalg.norm(about)).apply(robot.gravity)
    return replace(robot, gravity=turned)
