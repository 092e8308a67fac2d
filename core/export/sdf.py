"""Write the identified robot as SDFormat, Gazebo's form: links at our frames, the rest where it has a place.

Bodies, viscous and Coulomb friction and mimic joints have one; rotor inertia, torque offsets and coupled
motors stand in a comment. Gravity belongs to the world: the base is fixed to it, tilted so that gravity
points along -z. Source: SDFormat specification 1.7 (frames) and 1.11 (mimic).
"""

from xml.etree import ElementTree as ET

import numpy as np

from core.arrays import LinkParameters, Rotation, Vector3
from core.export.caveats import caveats
from core.export.elements import child, comment, document, text_of
from core.export.identified import IdentifiedRobot
from core.export.movers import Mover, free_name, movers
from core.export.urdf import left_out, upright
from core.robot.frames import rpy_of_rotation
from core.robot.inertia import mass_properties


def write_sdf(identified: IdentifiedRobot) -> str:
    """Write an SDFormat model.

    Raises
    ------
    OptionError
        If the model has no bodies, or one of them cannot exist.
    RobotError
        If a joint's coordinate is scaled, which SDFormat cannot say.
    """
    placed = movers(identified.robot)
    names = [free_name("base", [mover.link.name for mover in placed]), *(mover.link.name for mover in placed)]
    root = ET.Element("sdf", version="1.11" if any(mover.following for mover in placed) else "1.7")
    model = child(root, "model", name=identified.robot.name)
    size = float(np.linalg.norm(identified.robot.gravity))
    gravity = f"Gravity is {size!r} m/s2 along -z of the model's frame."
    comment(model, (*caveats(identified), *left_out(identified, "SDFormat"), gravity))
    base = child(model, "link", name=names[0])
    turn = upright(identified.robot.gravity)
    _write_pose(base, np.zeros(3), np.eye(3) if turn is None else turn)
    free = free_name("world_to_base", [mover.name for mover in placed])
    fixed = child(model, "joint", name=free, type="fixed")
    child(fixed, "parent").text = "world"
    child(fixed, "child").text = names[0]
    drives = [identified.of_joints(symbol) for symbol in ("FV", "FC")]
    for mover, body in zip(placed, identified.bodies, strict=True):
        link = child(model, "link", name=mover.link.name)
        _write_pose(link, mover.translation, mover.rotation, relative_to=names[mover.parent])
        _write_inertial(link, body)
        index = mover.link.joint - 1
        friction = None if mover.following else (drives[0][index], drives[1][index])
        _write_joint(model, mover, names[mover.parent], friction)
    return document(root)


def _write_pose(
    part: ET.Element, translation: Vector3, rotation: Rotation, *, relative_to: str | None = None
) -> None:
    pose = child(part, "pose", relative_to=relative_to)
    pose.text = text_of(np.concatenate([translation, rpy_of_rotation(rotation)]))


def _write_inertial(link: ET.Element, body: LinkParameters) -> None:
    mass, centre, inertia = mass_properties(body)
    inertial = child(link, "inertial")
    _write_pose(inertial, centre, np.eye(3))
    child(inertial, "mass").text = text_of(mass)
    table = child(inertial, "inertia")
    axes = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    for name, place in axes.items():
        child(table, name).text = text_of(inertia[place])


def _write_joint(model: ET.Element, mover: Mover, parent: str, friction: tuple[float, float] | None) -> None:
    joint = child(model, "joint", name=mover.name, type=mover.kind)
    child(joint, "parent").text = parent
    child(joint, "child").text = mover.link.name
    axis = child(joint, "axis")
    child(axis, "xyz").text = text_of(np.array([0.0, 0.0, mover.sign]))
    limits = mover.joint.limits
    bounds = {"effort": limits.torque, "velocity": limits.velocity}
    bounds |= dict(zip(("lower", "upper"), mover.range or (None, None), strict=True))
    known = {name: value for name, value in bounds.items() if value is not None}
    if known:
        limit = child(axis, "limit")
        for name, value in known.items():
            child(limit, name).text = text_of(value)
    if friction is not None:
        dynamics = child(axis, "dynamics")
        child(dynamics, "damping").text = text_of(friction[0])
        child(dynamics, "friction").text = text_of(friction[1])
    if mover.following is not None:
        mimic = child(axis, "mimic", joint=mover.following.master)
        child(mimic, "multiplier").text = text_of(mover.following.ratio)
        child(mimic, "offset").text = text_of(mover.following.offset)
        child(mimic, "reference").text = text_of(0.0)
