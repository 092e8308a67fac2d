"""Write the identified robot as a URDF: links at our frames, the rest where URDF has a place for it.

URDF has places for bodies, viscous and Coulomb friction and mimic joints; rotor inertia, torque offsets and
coupled motors stand in a comment. It assumes that gravity points along -z of the root: where it does not, a
link `world` carries the base with the tilt. Source: the ROS URDF XML specification.
"""

from xml.etree import ElementTree as ET

import numpy as np

from ..arrays import LinkParameters, Rotation, Vector3
from ..document.model.caveats import caveats, of_motors, per_joint, rotors, smoothing, without_place
from ..document.model.identified import IdentifiedRobot
from ..robot.frames import rotation_to, rpy_of_rotation
from ..robot.inertia import mass_properties
from .elements import child, comment, document
from .movers import Mover, free_name, movers

UNLIMITED = 1e9
"""URDF requires effort and velocity limits: N m and rad/s where none is known."""
LONGEST_STROKE = 1e3
"""Limits of a prismatic joint, m, which URDF requires even if none are known."""


def write_urdf(identified: IdentifiedRobot) -> str:
    """Write a URDF.

    Raises
    ------
    OptionError
        If the model has no bodies, or one of them is physically inconsistent.
    RobotError
        If a joint's coordinate is scaled, which URDF cannot say.
    """
    placed = movers(identified.robot)
    root = ET.Element("robot", name=identified.robot.name)
    armature = without_place("URDF", "rotor inertia (armature, IA)", rotors(identified))
    comment(root, (*caveats(identified), *armature, *left_out(identified, "URDF")))
    taken = [mover.link.name for mover in placed]
    base = free_name("base", taken)
    _write_base(root, identified.robot.gravity, base, free_name("world", [*taken, base]))
    names = [base, *taken]
    viscous, coulomb = identified.of_joints("FV"), identified.of_joints("FC")
    for mover, body in zip(placed, identified.bodies, strict=True):
        link = child(root, "link", name=mover.link.name)
        write_inertial(link, body)
        joint = _write_joint(root, mover, names[mover.parent])
        if mover.following is None:
            index = mover.link.joint - 1
            child(joint, "dynamics", damping=viscous[index], friction=coulomb[index])
    return document(root)


def left_out(identified: IdentifiedRobot, format_name: str) -> tuple[str, ...]:
    """List what URDF (and SDF) cannot represent."""
    return (
        *without_place(format_name, "torque offsets (OFF)", per_joint(identified, "OFF", "N m")),
        *without_place(format_name, "coupled motors", of_motors(identified)),
        *smoothing(identified),
    )


def upright(gravity: Vector3) -> Rotation | None:
    """Give the base's rotation in a world whose gravity points along -z; None where it does already."""
    size = float(np.linalg.norm(gravity))
    if size == 0.0 or (gravity[0] == 0.0 and gravity[1] == 0.0 and gravity[2] < 0.0):
        return None
    return np.asarray(rotation_to(-gravity / size).T)


def write_inertial(link: ET.Element, body: LinkParameters) -> None:
    """Add a body about its mass centre, along the link's axes."""
    mass, centre, inertia = mass_properties(body)
    inertial = child(link, "inertial")
    child(inertial, "origin", xyz=centre, rpy=np.zeros(3))
    child(inertial, "mass", value=mass)
    axes = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    child(inertial, "inertia", **{name: inertia[entry] for name, entry in axes.items()})


def _write_base(root: ET.Element, gravity: Vector3, base: str, world: str) -> None:
    turn = upright(gravity)
    if turn is not None:
        child(root, "link", name=world)
    child(root, "link", name=base)
    size = float(np.linalg.norm(gravity))
    comment(root, [f"Gravity is {size!r} m/s2 along -z of the root link."])
    if turn is not None:
        joint = child(root, "joint", name=f"{world}_to_{base}", type="fixed")
        child(joint, "origin", xyz=np.zeros(3), rpy=rpy_of_rotation(turn))
        child(joint, "parent", link=world)
        child(joint, "child", link=base)


def _write_joint(root: ET.Element, mover: Mover, parent: str) -> ET.Element:
    limits = mover.joint.limits
    revolute = mover.kind == "revolute"
    kind = "continuous" if revolute and mover.range is None else mover.kind
    joint = child(root, "joint", name=mover.name, type=kind)
    child(joint, "origin", xyz=mover.translation, rpy=rpy_of_rotation(mover.rotation))
    child(joint, "parent", link=parent)
    child(joint, "child", link=mover.link.name)
    child(joint, "axis", xyz=np.array([0.0, 0.0, mover.sign]))
    lower, upper = mover.range or ((None, None) if revolute else (-LONGEST_STROKE, LONGEST_STROKE))
    child(
        joint,
        "limit",
        lower=lower,
        upper=upper,
        effort=UNLIMITED if limits.torque is None else limits.torque,
        velocity=UNLIMITED if limits.velocity is None else limits.velocity,
    )
    if mover.following is not None:
        follower = mover.following
        child(joint, "mimic", joint=follower.master, multiplier=follower.ratio, offset=follower.offset)
    return joint
