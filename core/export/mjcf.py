"""Write the identified robot as MJCF, MuJoCo's own form, which has a place for every standard parameter.

Rotor inertia is armature, viscous friction damping, Coulomb friction frictionloss; a coupled motor is a fixed
tendon with the same three; an offset is the bias of the joint's actuator, so that `ctrl` is the torque that
the log measures. Source: MuJoCo's XML reference.
"""

from collections.abc import Sequence
from xml.etree import ElementTree as ET

import numpy as np
from scipy.spatial.transform import Rotation as Turn

from ..arrays import LinkParameters, Rotation, Vector
from ..document.model.caveats import caveats, smoothing
from ..document.model.identified import IdentifiedRobot
from ..robot.inertia import mass_properties
from .elements import child, comment, document
from .movers import Mover, free_name, movers

KINDS = {"revolute": "hinge", "prismatic": "slide"}


def write_mjcf(identified: IdentifiedRobot) -> str:
    """Write an MJCF model.

    Raises
    ------
    OptionError
        If the model has no bodies, or one of them is physically inconsistent.
    RobotError
        If a joint's coordinate is scaled, which MJCF cannot say.
    """
    placed = movers(identified.robot)
    root = ET.Element("mujoco", model=identified.robot.name)
    comment(root, (*caveats(identified), *smoothing(identified), _DRIVES))
    child(root, "compiler", angle="radian", inertiafromgeom="false", autolimits="true")
    child(root, "option", gravity=identified.robot.gravity)
    _write_bodies(child(root, "worldbody"), placed, identified)
    _write_motors(root, placed, identified)
    _write_mimics(root, placed)
    _write_actuators(root, placed, identified)
    return document(root)


_DRIVES = (
    "armature is IA, damping FV, frictionloss FC; a tendon is a coupled motor with IAM, FVM and FCM. "
    "An actuator's ctrl is the logged joint torque; its bias subtracts the offset OFF."
)


def _write_bodies(world: ET.Element, placed: Sequence[Mover], identified: IdentifiedRobot) -> None:
    base = free_name("base", [mover.link.name for mover in placed])
    parts = [child(world, "body", name=base)]
    child(parts[0], "inertial", mass=0.0, pos=np.zeros(3), diaginertia=np.zeros(3))  # it moves nothing
    drives = {"armature": "IA", "damping": "FV", "frictionloss": "FC"}
    values = {name: identified.of_joints(symbol) for name, symbol in drives.items()}
    for mover, inertial in zip(placed, identified.bodies, strict=True):
        part = child(
            parts[mover.parent],
            "body",
            name=mover.link.name,
            pos=mover.translation,
            quat=_quaternion(mover.rotation),
        )
        _write_inertial(part, inertial)
        own = {name: series[mover.link.joint - 1] for name, series in values.items()}
        child(
            part,
            "joint",
            name=mover.name,
            type=KINDS[mover.kind],
            axis=np.array([0.0, 0.0, mover.sign]),
            range=None if mover.range is None else np.array(mover.range),
            **({} if mover.following else own),
        )
        parts.append(part)


def _write_inertial(part: ET.Element, body: LinkParameters) -> None:
    """Add a body along its principal axes, so that the compiler need not look for them."""
    mass, centre, inertia = mass_properties(body)
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 0] *= np.sign(np.linalg.det(axes))
    child(part, "inertial", mass=mass, pos=centre, quat=_quaternion(axes), diaginertia=moments)


def _write_motors(root: ET.Element, placed: Sequence[Mover], identified: IdentifiedRobot) -> None:
    if not identified.motors:
        return
    own = {mover.link.joint: mover.name for mover in placed if mover.following is None}
    tendons = child(root, "tendon")
    for motor in identified.motors:
        fixed = child(
            tendons,
            "fixed",
            name=motor.coupling.name,
            armature=motor.rotor_inertia,
            damping=motor.viscous,
            frictionloss=motor.coulomb,
        )
        for joint, weight in zip(motor.coupling.joints, motor.coupling.weights, strict=True):
            child(fixed, "joint", joint=own[joint], coef=weight)


def _write_mimics(root: ET.Element, placed: Sequence[Mover]) -> None:
    followers = [(mover.name, mover.following) for mover in placed if mover.following is not None]
    if not followers:
        return
    equality = child(root, "equality")
    for name, follower in followers:
        polynomial = np.array([follower.offset, follower.ratio, 0.0, 0.0, 0.0])
        child(equality, "joint", joint1=name, joint2=follower.master, polycoef=polynomial)


def _write_actuators(root: ET.Element, placed: Sequence[Mover], identified: IdentifiedRobot) -> None:
    actuators = child(root, "actuator")
    offsets = identified.of_joints("OFF")
    for mover in placed:
        if mover.following is None:
            limit = mover.joint.limits.torque
            child(
                actuators,
                "general",
                name=mover.name,
                joint=mover.name,
                ctrlrange=None if limit is None else np.array([-limit, limit]),
                gainprm=1.0,
                biastype="affine",
                biasprm=np.array([-offsets[mover.link.joint - 1], 0.0, 0.0]),
            )


def _quaternion(rotation: Rotation) -> Vector:
    """Write a rotation as w, x, y, z."""
    return np.asarray(Turn.from_matrix(rotation).as_quat(scalar_first=True))
