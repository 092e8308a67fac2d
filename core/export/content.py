"""Lay out an identified robot as plain rows, for the formats that are tables and not robots: YAML and MAT.

Every row carries what it needs to be read alone: names, units where they differ, and the frames that the
inertial parameters refer to.
"""

from collections.abc import Mapping

from ..document.model.caveats import REPRESENTATIVE, SOURCE, smoothing
from ..document.model.identified import IdentifiedRobot
from ..robot.model import INERTIAL_SYMBOLS, Link

FRAMES = (
    "Link frame j has rotation (into the antecedent's frame) and translation (m) relative to its antecedent "
    "(0: the base), and moves about (revolute) or along (prismatic) its z axis by ratio * q + offset."
)
BODIES = (
    "XX XY XZ YY YZ ZZ (kg m2) are about the link frame's origin, XY = -integral xy dm; MX MY MZ (kg m) are "
    "first moments, M (kg) is the mass."
)
DRIVES = (
    "tau = bodies + IA ddq + FV dq + FC sign(dq) + OFF (N m; prismatic: N). A coupled motor rotates with "
    "s = sum of weights * q and adds weight * (IAM dds + FVM ds + FCM sign(ds)) to each of its joints."
)
NOTES = (SOURCE, REPRESENTATIVE, FRAMES, BODIES, DRIVES)
DRIVE_SYMBOLS = ("IA", "FV", "FC", "OFF")
Row = dict[str, object]


def content(identified: IdentifiedRobot) -> dict[str, object]:
    """Give names, numbers, lists of numbers and lists of rows."""
    robot, values = identified.robot, identified.values
    return {
        "format": "veritorque-parameters",
        "format_version": "1.0",
        "notes": [*NOTES, *identified.remarks, *smoothing(identified)],
        "robot": robot.name,
        "gravity": [float(value) for value in robot.gravity],
        "links": [_link(number, link, values) for number, link in enumerate(robot.links, start=1)],
        "joints": [
            {"number": number, "name": joint.name}
            | {symbol: values.get(f"{symbol}{number}", 0.0) for symbol in DRIVE_SYMBOLS}
            for number, joint in enumerate(robot.joints, start=1)
        ],
        "coupled_motors": [
            {
                "number": motor.coupling.number,
                "name": motor.coupling.name,
                "joints": list(motor.coupling.joints),
                "weights": list(motor.coupling.weights),
                "IAM": motor.rotor_inertia,
                "FVM": motor.viscous,
                "FCM": motor.coulomb,
            }
            for motor in identified.motors
        ],
        "standard_parameters": [
            {
                "name": parameter.name,
                "joint": parameter.joint,
                "unit": parameter.unit,
                "value": values[parameter.name],
                "identifiable": known,
            }
            for parameter, known in zip(identified.model.parameters, identified.identifiable, strict=True)
        ],
        "base_parameters": [vars(parameter) for parameter in identified.base],
    }


def _link(number: int, link: Link, values: Mapping[str, float]) -> Row:
    symbols = {f"{symbol}{number}": symbol for symbol in INERTIAL_SYMBOLS}
    return {
        "number": number,
        "name": link.name,
        "kind": link.kind,
        "antecedent": link.antecedent,
        "joint": link.joint,
        "rotation": [[float(value) for value in line] for line in link.rotation],
        "translation": [float(value) for value in link.translation],
        "ratio": link.ratio,
        "offset": link.offset,
    } | {symbol: values[name] for name, symbol in symbols.items() if name in values}
