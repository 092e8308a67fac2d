"""Turn a robot description, the JSON document of the service, into a `RobotModel`.

Two conventions: ``modified-dh`` (Khalil-Kleinfinger rows, see `core.robot.modified_dh`) and ``frames`` (any
placement given as rotation and translation; joints that mimic another one), in which every `RobotModel` can
be written (`core.robot.writing`).
"""

from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np

from ..fields import Fields
from .link_data import RobotFields, read_frames, read_prior, read_rotation, read_shapes
from .model import FRICTION_KINDS, Coupling, Joint, JointKind, Limits, Link, RobotModel
from .modified_dh import ModifiedDHRow
from .plausibility import angle_remarks
from .right_angles import meant_angle

MODIFIED_DH, FRAMES = "modified-dh", "frames"
MOST_JOINTS = 64
LEVEL_GRAVITY = (0.0, 0.0, -9.81)

ROBOT_FIELDS = {
    "name": "a text",
    "convention": f"{MODIFIED_DH} (the default) or {FRAMES}",
    "joints": f"a list of 1 to {MOST_JOINTS} joints",
    "gravity": "the acceleration of gravity in the base frame, m/s2, by default [0, 0, -9.81]",
    "couplings": "a list of motors whose angle is a weighted sum of joint positions",
    "prior": "null, or one entry per joint with the inertial parameters of a prior",
    "frames": "null, or a list of named frames fixed to links, such as the flange",
    "shapes": "null, or per joint null or four numbers x, y, z, radius in m: a ball that holds the link",
}
JOINT_FIELDS = {
    "name": "a text (default joint_<number>)",
    "link": "a text: the moving body's name (default: the joint's)",
    "type": "revolute or prismatic",
    "antecedent": "the number of the joint that carries this one, 0 for the base (default: the joint before)",
    "limits": "an object with position [lower, upper], velocity and torque",
    "rotor_inertia": "true (default) or false",
    "friction": f"a list taken from {', '.join(FRICTION_KINDS)} (default: all)",
    "torque_constant": "null or a number in N m/A, motor side",
    "gear_ratio": "null or motor turns per joint turn (prismatic: rad per m)",
}
ROW_FIELDS = {
    "alpha": "an angle in rad about x, from the antecedent's z axis to this one",
    "d": "a distance in m along x, from the antecedent's z axis to this one",
    "r": "a distance in m along z; the variable of a prismatic joint adds to it",
    "theta_offset": "an angle in rad about z; the variable of a revolute joint adds to it",
    "gamma": "an angle in rad about the antecedent's z axis (default 0)",
    "b": "a distance in m along the antecedent's z axis (default 0)",
}
FRAME_FIELDS = {
    "rotation": "three rows of three numbers: a rotation matrix from this frame into the antecedent's",
    "translation": "three numbers in m: this frame's origin in the antecedent's frame",
    "ratio": "a number: the joint moves by ratio times its coordinate plus offset (default 1)",
    "offset": "a number in rad or m (default 0)",
    "mimics": "null or the name of the joint whose coordinate moves this one too",
}
JOINT_FIELDS_OF = {MODIFIED_DH: JOINT_FIELDS | ROW_FIELDS, FRAMES: JOINT_FIELDS | FRAME_FIELDS}
LIMIT_FIELDS = {
    "position": "null or [lower, upper] in rad or m",
    "velocity": "null or a positive number in rad/s or m/s",
    "torque": "null or a positive number in N m or N",
}
COUPLING_FIELDS = {
    "name": "a text",
    "number": "the number in its parameters' names (default: its last joint)",
    "joints": "at least two different joint numbers, counted from 1",
    "weights": "one number per joint",
}


def robot_from_description(description: object) -> RobotModel:
    """Read a robot description.

    Raises
    ------
    RobotError
        If a field is missing, unknown, of the wrong type or not finite; the evidence holds a JSON pointer to
        it.

    Examples
    --------
    >>> row = {"type": "revolute", "alpha": 0, "d": 0, "r": 0.3, "theta_offset": 0}
    >>> robot = robot_from_description({"name": "one joint", "joints": [row]})
    >>> robot.links[0].translation
    array([0. , 0. , 0.3])
    """
    top = RobotFields(description, "the description", "", ROBOT_FIELDS)
    rows = _rows(top)
    owners = [(number, row) for number, row in enumerate(rows, start=1) if not row.has("mimics")]
    joints = tuple(_joint(row, number) for number, row in owners)
    numbers = _numbers(joints, owners)
    links = tuple(_link(row, number, numbers) for number, row in enumerate(rows, start=1))
    _refuse_twins([link.name for link in links], "link", rows)
    return RobotModel(
        name=top.text("name"),
        links=links,
        joints=joints,
        gravity=top.numbers("gravity", 3) if "gravity" in top.value else np.array(LEVEL_GRAVITY),
        couplings=_couplings(top, len(joints)),
        prior=read_prior(top, len(links)),
        remarks=tuple(angle_remarks(_written_angles(rows))),
        frames=read_frames(top, len(links)),
        shapes=read_shapes(top, len(links)),
    )


def _written_angles(rows: Sequence[RobotFields]) -> dict[str, float]:
    """Give the angles (rad) of a table as written, by what they are called."""
    return {
        f"{row.where}: {name}": row.number(name)
        for row in rows
        for name in ("alpha", "theta_offset", "gamma")
        if name in row.value
    }


def _rows(top: RobotFields) -> list[RobotFields]:
    convention = top.choice("convention", (MODIFIED_DH, FRAMES)) if "convention" in top.value else MODIFIED_DH
    return [
        RobotFields(row, f"joint {number}", f"/joints/{number - 1}", JOINT_FIELDS_OF[convention])
        for number, row in enumerate(top.items("joints", least=1, most=MOST_JOINTS), start=1)
    ]


def _numbers(joints: tuple[Joint, ...], owners: Sequence[tuple[int, Fields]]) -> dict[str, int]:
    _refuse_twins([joint.name for joint in joints], "name", [row for _, row in owners])
    return {joint.name: number for number, joint in enumerate(joints, start=1)}


def _refuse_twins(names: list[str], field: str, rows: Sequence[Fields]) -> None:
    for position, name in enumerate(names):
        if name in names[:position]:
            rows[position].refuse(field, f"repeats {name}, which is taken")


def _joint(row: Fields, number: int) -> Joint:
    friction = row.items("friction", most=len(FRICTION_KINDS)) if "friction" in row.value else FRICTION_KINDS
    if any(kind not in FRICTION_KINDS for kind in friction):
        row.refuse("friction", "names a kind that does not exist")
    return Joint(
        name=_name(row, number),
        limits=_limits(row),
        rotor_inertia=row.flag("rotor_inertia") if "rotor_inertia" in row.value else True,
        friction=tuple(kind for kind in FRICTION_KINDS if kind in friction),
        torque_constant=row.optional_number("torque_constant"),
        gear_ratio=row.optional_number("gear_ratio"),
    )


def _limits(row: Fields) -> Limits:
    if not row.has("limits"):
        return Limits()
    limits = row.inner("limits", LIMIT_FIELDS, f"{row.where}: limits")
    position = None
    if limits.has("position"):
        lower, upper = (float(limit) for limit in limits.numbers("position", 2))
        if lower >= upper:
            limits.refuse("position", "has its lower limit at or above the upper one")
        position = (lower, upper)
    velocity, torque = (limits.optional_number(name, positive=True) for name in ("velocity", "torque"))
    return Limits(position, velocity, torque)


def _link(row: Fields, number: int, numbers: Mapping[str, int]) -> Link:
    kind = cast("JointKind", row.choice("type", ("revolute", "prismatic")))
    before = number - 1
    antecedent = row.integer("antecedent", (0, before)) if "antecedent" in row.value else before
    own = _name(row, number)
    name = row.text("link") if "link" in row.value else own
    if "rotation" not in row.meanings:
        modified = ModifiedDHRow(
            alpha=meant_angle(row.number("alpha")),
            d=row.number("d"),
            r=row.number("r"),
            theta=meant_angle(row.number("theta_offset")),
            gamma=meant_angle(row.number("gamma", 0.0)),
            b=row.number("b", 0.0),
        )
        return Link(name, kind, antecedent, numbers[own], *modified.placement(), row=modified)
    joint = _mimicked_joint(row, numbers) if row.has("mimics") else numbers[own]
    ratio, offset = row.number("ratio", 1.0), row.number("offset", 0.0)
    return Link(
        name, kind, antecedent, joint, read_rotation(row), row.numbers("translation", 3), ratio, offset
    )


def _name(row: Fields, number: int) -> str:
    return row.text("name") if "name" in row.value else f"joint_{number}"


def _mimicked_joint(row: Fields, numbers: Mapping[str, int]) -> int:
    master = row.text("mimics")
    if master not in numbers:
        row.refuse("mimics", "names no joint that moves by itself")
    for field in ("limits", "rotor_inertia", "friction", "torque_constant", "gear_ratio"):
        if field in row.value:
            row.refuse(field, f"belongs to {master}, which this joint mimics")
    return numbers[master]


def _couplings(top: Fields, joints: int) -> tuple[Coupling, ...]:
    listed = top.items("couplings", most=joints) if top.has("couplings") else ()
    couplings: list[Coupling] = []
    for position, value in enumerate(listed):
        entry = RobotFields(value, f"coupling {position + 1}", f"/couplings/{position}", COUPLING_FIELDS)
        members = entry.integers("joints", (1, joints), least=2, most=joints)
        numbered = "number" in entry.value
        number = entry.integer("number", (1, 1000)) if numbered else members[-1]
        weights = tuple(float(weight) for weight in entry.numbers("weights", len(members)))
        if number in {earlier.number for earlier in couplings}:
            entry.refuse("number" if numbered else "joints", f"gives it the number {number}, which is taken")
        couplings.append(Coupling(entry.text("name"), number, members, weights))
    return tuple(couplings)
