"""Spoil a sound robot and its log in one thing, drawn from a seed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from veritorque.core.log.columns.assignment import Assignment, assigned
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import RobotModel


@dataclass(frozen=True, eq=False)
class Spoilt:
    """Hold a robot and a log that disagree, and what was done to them."""

    robot: RobotModel
    log: JointLog
    conflict: str | None
    """Name of the conflict; None where nothing was spoilt."""
    joints: tuple[int, ...] = ()
    channel: str | None = None
    gravity: np.ndarray | None = None
    """The true direction, where mounting was described wrongly."""


Spoiler = Callable[[RobotModel, JointLog, np.random.Generator], Spoilt]


def _joint(robot: RobotModel, rng: np.random.Generator) -> int:
    return int(rng.integers(len(robot.joints)))


def torque_sign(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Reverse one torque, or all."""
    plain, joint = Assignment.as_measured(log.joints), _joint(robot, rng)
    joints = tuple(range(log.joints)) if rng.random() < 0.2 else (joint,)
    spoilt = replace(plain, torque=plain.torque.scaled(-1.0, *joints))
    return Spoilt(robot, assigned(log, spoilt), "torque_sign", tuple(one + 1 for one in joints), "torque")


def position_sign(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Reverse one position."""
    plain, joint = Assignment.as_measured(log.joints), _joint(robot, rng)
    spoilt = replace(plain, position=plain.position.scaled(-1.0, joint))
    return Spoilt(robot, assigned(log, spoilt), "position_sign", (joint + 1,), "position")


def channels_swapped(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Exchange torques, positions or both of two joints."""
    plain = Assignment.as_measured(log.joints)
    first, second = sorted(int(one) for one in rng.choice(log.joints, 2, replace=False))
    channel = str(rng.choice(["torque", "position", "both"]))
    if channel != "torque":
        plain = replace(plain, position=plain.position.exchanged(first, second))
    if channel != "position":
        plain = replace(plain, torque=plain.torque.exchanged(first, second))
    return Spoilt(robot, assigned(log, plain), "channels_swapped", (first + 1, second + 1), channel)


def other_order(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Log the joints backwards, or with an inner one last as a controller's added axis is."""
    joints = list(range(log.joints))
    if log.joints > 3 and rng.random() < 0.7:
        joints.append(joints.pop(int(rng.integers(1, log.joints - 2))))
    else:
        joints.reverse()
    plain = Assignment.as_measured(log.joints)
    spoilt = replace(plain, position=plain.position.in_order(joints), torque=plain.torque.in_order(joints))
    moved = tuple(place + 1 for place, joint in enumerate(joints) if place != joint)
    return Spoilt(robot, assigned(log, spoilt), "channels_swapped", moved, "both")


def mounting(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Describe the robot as mounted otherwise: on a wall, below a ceiling, or leaning by some angle."""
    usual = Rotation.from_euler(
        "x" if rng.random() < 0.5 else "y", rng.choice([90.0, -90.0, 180.0]), degrees=True
    )
    tilted = Rotation.from_rotvec(np.radians(rng.uniform(20.0, 160.0)) * _unit(rng))
    turn = usual if rng.random() < 0.6 else tilted
    true = np.asarray(robot.gravity)
    return Spoilt(replace(robot, gravity=turn.apply(true)), log, "mounting", gravity=true)


def position_linkage(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Count one position together with that of the joint before, about a parallel axis; else nothing."""
    turning = [link for link in robot.links if link.kind == "revolute"]
    pairs = [
        (robot.links[link.antecedent - 1].joint, link.joint)
        for link in turning
        if link.antecedent and np.isclose(abs(link.rotation[2, 2]), 1.0)
    ]
    if not pairs:
        return Spoilt(robot, log, None)
    plain = Assignment.as_measured(log.joints)
    other, joint = pairs[int(rng.integers(len(pairs)))]
    linked = plain.position.with_added(float(rng.choice([-1.0, 1.0])), other - 1, joint - 1)
    return Spoilt(
        robot, assigned(log, replace(plain, position=linked)), "position_linkage", (joint,), "position"
    )


def zero_quarter_turn(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Move the zero of one joint by quarter turns."""
    plain, joint = Assignment.as_measured(log.joints), _joint(robot, rng)
    angle = np.radians(float(rng.choice([90.0, 180.0, -90.0])))
    spoilt = replace(plain, position=plain.position.moved(angle, joint))
    return Spoilt(robot, assigned(log, spoilt), "zero_quarter_turn", (joint + 1,), "position")


def zero_offset(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Move the zero of one joint by some angle that is no quarter turn."""
    plain, joint = Assignment.as_measured(log.joints), _joint(robot, rng)
    angle = np.radians(rng.uniform(15.0, 75.0) + 90.0 * float(rng.integers(4)))
    spoilt = replace(plain, position=plain.position.moved(angle, joint))
    return Spoilt(robot, assigned(log, spoilt), "zero_offset", (joint + 1,), "position")


def unit(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Take one torque in mN m for N m."""
    plain, joint = Assignment.as_measured(log.joints), _joint(robot, rng)
    spoilt = replace(plain, torque=plain.torque.scaled(1000.0, joint))
    return Spoilt(robot, assigned(log, spoilt), "unit", (joint + 1,), "torque")


def gear_ratio(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Take one torque on the motor's side of a gear."""
    plain, joint = Assignment.as_measured(log.joints), _joint(robot, rng)
    spoilt = replace(plain, torque=plain.torque.scaled(1.0 / rng.uniform(20.0, 160.0), joint))
    return Spoilt(robot, assigned(log, spoilt), "gear_ratio", (joint + 1,), "torque")


def motor_side(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Take all positions on the motors' side of gears, in rad, which may have been declared as degrees."""
    plain, joints = Assignment.as_measured(log.joints), tuple(range(1, log.joints + 1))
    declared = np.pi / 180.0 if rng.random() < 0.5 else 1.0
    position = plain.position
    for joint in range(log.joints):
        position = position.scaled(declared * rng.uniform(50.0, 160.0), joint)
    return Spoilt(robot, assigned(log, replace(plain, position=position)), "gear_ratio", joints, "position")


def time_base(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Stretch the stamps beside a measured velocity."""
    rows, factor = whole_rows(log), float(rng.choice([0.5, 2.0, 1.25, 4.0]))
    velocity = np.gradient(rows.position, rows.time, axis=0)
    spoilt = log_from_arrays(log.name, rows.time * factor, rows.position, rows.torque, velocity=velocity)
    return Spoilt(robot, spoilt, "time_base")


def time_offset(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Log the torques by a clock that is 0.08 to 0.8 s late or early."""
    rows = whole_rows(log)
    late = float(np.exp(rng.uniform(np.log(0.08), np.log(0.8)))) * float(rng.choice([-1.0, 1.0]))
    then = rows.time - late
    inside = (then >= rows.time[0]) & (then <= rows.time[-1])
    torque = np.stack([np.interp(then[inside], rows.time, own) for own in rows.torque.T], axis=1)
    spoilt = log_from_arrays(log.name, rows.time[inside], rows.position[inside], torque)
    return Spoilt(robot, spoilt, "time_offset", (), "torque")


def other_signal(robot: RobotModel, log: JointLog, rng: np.random.Generator) -> Spoilt:
    """Log in the place of a torque a joint's position or velocity, another torque, or noise."""
    rows, joint, kind = whole_rows(log), _joint(robot, rng), int(rng.integers(4))
    assert rows.torque is not None
    other = (joint + 1) % log.joints
    signals = (
        lambda: rows.position[:, joint],
        lambda: np.gradient(rows.position[:, joint], rows.time),
        lambda: rows.torque[:, other],
        lambda: rng.uniform(0.01, 1.0) * rng.normal(size=len(rows.time)),
    )
    torque = rows.torque.copy()
    torque[:, joint] = signals[kind]()
    spoilt = log_from_arrays(log.name, rows.time, rows.position, torque)
    return Spoilt(robot, spoilt, "other_signal", (joint + 1,), "torque")


def nothing(robot: RobotModel, log: JointLog, _rng: np.random.Generator) -> Spoilt:
    """Leave everything as it is."""
    return Spoilt(robot, log, None)


def _unit(rng: np.random.Generator) -> np.ndarray:
    way = rng.normal(size=3)
    return np.asarray(way / np.linalg.norm(way))


SPOILERS: Mapping[str, Spoiler] = {
    spoiler.__name__: spoiler
    for spoiler in (
        nothing,
        torque_sign,
        position_sign,
        channels_swapped,
        other_order,
        mounting,
        position_linkage,
        zero_quarter_turn,
        zero_offset,
        unit,
        gear_ratio,
        motor_side,
        other_signal,
        time_base,
        time_offset,
    )
}
"""The ways to spoil, by the name of the conflict."""
