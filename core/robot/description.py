"""Turn a robot description, the JSON document of the service, into a `RobotModel`.

Two conventions: ``modified-dh`` (Khalil-Kleinfinger rows, see `core.robot.modified_dh`) and ``frames`` (any
placement given as rotation and translation; joints that mimic another one), in which every `RobotModel` can
be written (`core.robot.writing`).
"""

from collections.abc import Mapping
from typing import cast

import numpy as np

from ..arrays import LinkParameters, LinkTable
from ..errors import RobotError
from .fields import Fields
from .inertia import from_mass_properties
from .model import FRICTION_KINDS, Coupling, Joint, JointKind, Limits, Link, RobotModel
from .modified_dh import ModifiedDHRow
from .parameters import INERTIAL_SYMBOLS, INERTIAL_UNITS

MODIFIED_DH, FRAMES = "modified-dh", "frames"
MOST_JOINTS = 64
LEVEL_GRAVITY = (0.0, 0.0, -9.81)

ROBOT_FIELDS = {
    "name": "a text",
    "convention": f"{MODIFIED_DH} (the default) or {FRAMES}",
    "joints": f"a list of 1 to {MOST_JOINTS} joints",
    "gravity": "the acceleration of gravity in the base frame, m/s2, by default [0, 0, -9.81]",
    "couplings": "a list of motors that turn with a weighted sum of joints",
    "prior": "null, or one entry per joint with the inertial parameters believed beforehand",
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
    "gear_ratio": "null or motor turns per joint turn",
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
    "ratio": "a number: the joint turns by ratio times its coordinate plus offset (default 1)",
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
PRIOR_FIELDS = {
    "standard": "an object with XX XY XZ YY YZ ZZ (kg m2) MX MY MZ (kg m) M (kg) about the frame's origin",
    "mass": "a number in kg",
    "center_of_mass": "three numbers in m in the link's frame",
    "inertia_at_com": "six numbers XX XY XZ YY YZ ZZ in kg m2 about the mass centre, along the frame's axes",
}
SYMBOL_FIELDS = {symbol: f"a number in {unit}" for symbol, unit in INERTIAL_UNITS.items()}


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
    top = Fields(description, "the description", "", ROBOT_FIELDS)
    convention = top.choice("convention", (MODIFIED_DH, FRAMES), default=MODIFIED_DH)
    rows = [
        Fields(row, f"joint {number}", f"/joints/{number - 1}", JOINT_FIELDS_OF[convention])
        for number, row in enumerate(top.items("joints", least=1, most=MOST_JOINTS), start=1)
    ]
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
        prior=_prior(top, len(links)),
    )


def _numbers(joints: tuple[Joint, ...], owners: list[tuple[int, Fields]]) -> dict[str, int]:
    _refuse_twins([joint.name for joint in joints], "name", [row for _, row in owners])
    return {joint.name: number for number, joint in enumerate(joints, start=1)}


def _refuse_twins(names: list[str], field: str, rows: list[Fields]) -> None:
    for position, name in enumerate(names):
        if name in names[:position]:
            rows[position].refuse(field, f"repeats {name}, which is taken")


def _joint(row: Fields, number: int) -> Joint:
    friction = row.items("friction", most=len(FRICTION_KINDS)) if "friction" in row.value else FRICTION_KINDS
    if any(kind not in FRICTION_KINDS for kind in friction):
        row.refuse("friction", "names a kind that does not exist")
    return Joint(
        name=row.text("name", default=f"joint_{number}"),
        limits=_limits(row),
        rotor_inertia=row.flag("rotor_inertia", default=True),
        friction=tuple(kind for kind in FRICTION_KINDS if kind in friction),
        torque_constant=row.optional_number("torque_constant"),
        gear_ratio=row.optional_number("gear_ratio"),
    )


def _limits(row: Fields) -> Limits:
    if not row.has("limits"):
        return Limits()
    limits = Fields(row.value["limits"], f"{row.where}: limits", f"{row.pointer}/limits", LIMIT_FIELDS)
    position = None
    if limits.has("position"):
        lower, upper = (float(limit) for limit in limits.numbers("position", 2))
        if lower >= upper:
            limits.refuse("position", "has its lower limit at or above the upper one")
        position = (lower, upper)
    return Limits(
        position,
        limits.optional_number("velocity", positive=True),
        limits.optional_number("torque", positive=True),
    )


def _link(row: Fields, number: int, numbers: Mapping[str, int]) -> Link:
    kind = cast("JointKind", row.choice("type", ("revolute", "prismatic")))
    antecedent = row.integer("antecedent", (0, number - 1), default=number - 1)
    own = row.text("name", default=f"joint_{number}")
    name = row.text("link", default=own)
    if "rotation" not in row.meanings:
        modified = ModifiedDHRow(
            alpha=row.number("alpha"),
            d=row.number("d"),
            r=row.number("r"),
            theta=row.number("theta_offset"),
            gamma=row.number("gamma", 0.0),
            b=row.number("b", 0.0),
        )
        return Link(name, kind, antecedent, numbers[own], *modified.placement(), row=modified)
    joint = _mimicked(row, numbers) if row.has("mimics") else numbers[own]
    ratio, offset = row.number("ratio", 1.0), row.number("offset", 0.0)
    return Link(name, kind, antecedent, joint, _rotation(row), row.numbers("translation", 3), ratio, offset)


def _mimicked(row: Fields, numbers: Mapping[str, int]) -> int:
    master = row.text("mimics")
    if master not in numbers:
        row.refuse("mimics", "names no joint that moves by itself")
    for field in ("limits", "rotor_inertia", "friction", "torque_constant", "gear_ratio"):
        if field in row.value:
            row.refuse(field, f"belongs to {master}, which this joint mimics")
    return numbers[master]


def _rotation(row: Fields) -> np.ndarray:
    lines = row.items("rotation", least=3, most=3)
    axes = [Fields({"rotation": line}, row.where, row.pointer, row.meanings) for line in lines]
    rotation = np.array([line.numbers("rotation", 3) for line in axes])
    # Six written digits are enough; more than that is not a rotation.
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-5 or np.linalg.det(rotation) < 0.0:
        row.refuse("rotation", "is not a rotation: its rows are not orthonormal and right-handed")
    return rotation


def _couplings(top: Fields, joints: int) -> tuple[Coupling, ...]:
    listed = top.items("couplings", most=joints) if top.has("couplings") else ()
    couplings: list[Coupling] = []
    for position, value in enumerate(listed):
        one = Fields(value, f"coupling {position + 1}", f"/couplings/{position}", COUPLING_FIELDS)
        count = len(one.items("joints", least=2, most=joints))
        members = [
            Fields({"joints": member}, one.where, one.pointer, COUPLING_FIELDS).integer("joints", (1, joints))
            for member in one.items("joints", least=2, most=joints)
        ]
        number = one.integer("number", (1, 1000), default=members[-1])
        weights = tuple(float(weight) for weight in one.numbers("weights", count))
        if number in {earlier.number for earlier in couplings}:
            one.refuse(
                "joints" if "number" not in one.value else "number",
                f"gives it the number {number}, which is taken",
            )
        couplings.append(Coupling(one.text("name"), number, tuple(members), weights))
    return tuple(couplings)


def _prior(top: Fields, links: int) -> LinkTable | None:
    if not top.has("prior"):
        return None
    bodies = top.items("prior", least=links, most=links)
    return np.array([_body(value, number) for number, value in enumerate(bodies, start=1)])


def _body(value: object, number: int) -> LinkParameters:
    body = Fields(value, f"the prior of joint {number}", f"/prior/{number - 1}", PRIOR_FIELDS)
    if "standard" in body.value:
        if len(body.value) > 1:
            raise RobotError(
                f"{body.where} is given twice",
                evidence={"pointer": body.pointer, "fields": list(body.value)},
                remedy="give either standard, or mass, center_of_mass and inertia_at_com",
            )
        table = Fields(body.value["standard"], body.where, f"{body.pointer}/standard", SYMBOL_FIELDS)
        return np.array([table.number(symbol) for symbol in INERTIAL_SYMBOLS])
    xx, xy, xz, yy, yz, zz = body.numbers("inertia_at_com", 6)
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return from_mass_properties(body.number("mass"), body.numbers("center_of_mass", 3), inertia)
