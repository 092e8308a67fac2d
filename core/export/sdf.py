"""Write the identified robot as SDFormat, Gazebo's form: links at our frames, the rest where it has a place.

Bodies, viscous and Coulomb friction and mimic joints have one; torque offsets and coupled motors stand in a
comment. Rotor inertia has one in Drake's extension, which other readers pass over, and mimics stand there
once more, because Drake does not read SDFormat's own. Gravity belongs to the world: the base is fixed to it,
tilted so that gravity points along -z. Source: SDFormat specification 1.7 (frames, names) and 1.11 (mimic);
Drake, the page "Parsing Models".
"""

from collections.abc import Sequence
from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np

from ..arrays import LinkParameters, Rotation, Vector3
from ..document.model.caveats import caveats, rotors
from ..document.model.identified import IdentifiedRobot
from ..robot.frames import rpy_of_rotation
from ..robot.inertia import mass_properties
from .elements import child, comment, document, text_of
from .movers import Mover, free_name, movers
from .urdf import left_out, upright


def write_sdf(identified: IdentifiedRobot) -> str:
    """Write an SDFormat model.

    Raises
    ------
    OptionError
        If the model has no bodies, or one of them is physically inconsistent.
    RobotError
        If a joint's coordinate is scaled, which SDFormat cannot say.
    """
    names, placed = _sdf_names(movers(identified.robot))
    version = "1.11" if any(mover.following for mover in placed) else "1.7"
    root = ET.Element("sdf", {"version": version, "xmlns:drake": "drake.mit.edu"})
    model = child(root, "model", name=_sdf_name(identified.robot.name))
    size = float(np.linalg.norm(identified.robot.gravity))
    gravity = f"Gravity is {size!r} m/s2 along -z of the model's frame."
    comment(
        model, (*caveats(identified), *_of_rotors(identified), *left_out(identified, "SDFormat"), gravity)
    )
    base = child(model, "link", name=names[0])
    turn = upright(identified.robot.gravity)
    _write_pose(base, np.zeros(3), np.eye(3) if turn is None else turn)
    free = free_name("world_to_base", [*names, *(mover.name for mover in placed)])
    fixed = child(model, "joint", name=free, type="fixed")
    child(fixed, "parent").text = "world"
    child(fixed, "child").text = names[0]
    drives = np.column_stack([identified.of_joints(symbol) for symbol in ("FV", "FC", "IA")])
    for mover, body in zip(placed, identified.bodies, strict=True):
        link = child(model, "link", name=mover.link.name)
        _write_pose(link, mover.translation, mover.rotation, relative_to=names[mover.parent])
        _write_inertial(link, body)
        drive = None if mover.following else drives[mover.link.joint - 1]
        _write_joint(model, mover, names[mover.parent], drive)
    return document(root)


def _of_rotors(identified: IdentifiedRobot) -> tuple[str, ...]:
    listed = "; ".join(rotors(identified))
    sentence = (
        "SDFormat cannot represent rotor inertia (armature, IA); Drake reads it from drake:rotor_inertia, "
        f"other tools ignore it: {listed}."
    )
    return (sentence,) if listed else ()


def _sdf_names(placed: Sequence[Mover]) -> tuple[list[str], list[Mover]]:
    """Give the links' names, the base's first, and the movers by names that SDFormat takes.

    Links and joints share one set of names. Joints keep theirs, by which logs and controllers call them; a
    link that is called as a joint is called ``..._link``.
    """
    joints: dict[str, str] = {}
    for mover in placed:
        joints[mover.name] = free_name(_sdf_name(mover.name), list(joints.values()))
    wanted = [_sdf_name(mover.link.name) for mover in placed]
    names = [free_name("base", [*joints.values(), *wanted])]
    for name in wanted:
        taken = [*joints.values(), *names]
        names.append(name if name not in taken else free_name(f"{name}_link", [*taken, *wanted]))
    return names, [
        replace(
            mover,
            name=joints[mover.name],
            link=replace(mover.link, name=name),
            following=mover.following and replace(mover.following, master=joints[mover.following.master]),
        )
        for mover, name in zip(placed, names[1:], strict=True)
    ]


def _sdf_name(name: str) -> str:
    """Write a name as SDFormat takes one: ``world`` and ``__name__`` are its own, ``::`` parts nested names.

    Examples
    --------
    >>> _sdf_name("left::elbow"), _sdf_name("world"), _sdf_name("__model__"), _sdf_name("joint_1")
    ('left_elbow', 'world_', 'model', 'joint_1')
    """
    plain = name.replace("::", "_")
    if plain.startswith("__") and plain.endswith("__"):
        plain = plain.strip("_") or "_"
    return free_name(plain, ["world"])


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
    for name, entry in axes.items():
        child(table, name).text = text_of(inertia[entry])


def _write_joint(model: ET.Element, mover: Mover, parent: str, drive: Vector3 | None) -> None:
    """Add a joint; drive is viscous friction, Coulomb friction and rotor inertia, None of one that mimics."""
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
    if drive is not None:
        dynamics = child(axis, "dynamics")
        child(dynamics, "damping").text = text_of(drive[0])
        child(dynamics, "friction").text = text_of(drive[1])
        child(joint, "drake:rotor_inertia").text = text_of(drive[2])
        child(joint, "drake:gear_ratio").text = text_of(1.0)
    if mover.following is not None:
        follower = mover.following
        mimic = child(axis, "mimic", joint=follower.master)
        child(mimic, "multiplier").text = text_of(follower.ratio)
        child(mimic, "offset").text = text_of(follower.offset)
        child(mimic, "reference").text = text_of(0.0)
        child(joint, "drake:mimic", joint=follower.master, multiplier=follower.ratio, offset=follower.offset)
