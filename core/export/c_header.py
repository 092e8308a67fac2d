"""Write an identified robot as a C header: its parameters as constants, and the torque they stand for.

Controllers need the model without a library. The header is C99, needs math.h alone, and says units, order and
conventions beside every number.
"""

import json
import re
import textwrap
from collections.abc import Iterable, Sequence

import numpy as np

from ..document.model.caveats import caveats
from ..document.model.identified import IdentifiedRobot
from ..dynamics.terms.coulomb import Coulomb
from ..dynamics.terms.coupling import GearCoupling
from ..robot.model import Link
from .c_source import TYPES_AND_DYNAMICS

WIDTH = 110


def write_c_header(identified: IdentifiedRobot) -> str:
    """Write the header; the robot is a constant named as the robot is, as far as C can say it.

    Raises
    ------
    OptionError
        If the model has no bodies.
    """
    name = c_name(identified.robot.name)
    guard = f"VERITORQUE_ROBOT_{name.upper()}_H"
    return "\n".join(
        [
            _comment([*caveats(identified), *_calls(name)]),
            f"#ifndef {guard}\n#define {guard}\n",
            TYPES_AND_DYNAMICS,
            _array("veritorque_link", f"{name}_links", _links(identified)),
            _array("veritorque_joint", f"{name}_joints", _joints(identified)),
            _motors(identified, name),
            _robot(identified, name),
            f"#endif /* {guard} */\n",
        ]
    )


def _calls(name: str) -> list[str]:
    """Say what can be called for the robot."""
    return [
        f"Torque of a motion: veritorque_inverse_dynamics(&{name}, q, dq, ddq, tau).",
        f"Torque of gravity: veritorque_gravity(&{name}, q, tau).",
        f"Inertia matrix: veritorque_inertia_matrix(&{name}, q, M).",
    ]


def c_name(text: str) -> str:
    """Make a C identifier of a name.

    Examples
    --------
    >>> c_name("7-axis arm"), c_name("yumi-left")
    ('robot_7_axis_arm', 'yumi_left')
    """
    word = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_").lower()
    return word if word[:1].isalpha() else f"robot_{word}".rstrip("_")


def _comment(sentences: Iterable[str]) -> str:
    lines = [line for sentence in sentences for line in textwrap.wrap(sentence, WIDTH)]
    return "/* " + "\n   ".join(lines).replace("*/", "* /").replace("/*", "/ *") + " */"


def _links(identified: IdentifiedRobot) -> list[str]:
    pairs = zip(identified.robot.links, identified.links, strict=True)
    return [_link(link, body) for link, body in pairs]


def _link(link: Link, body: np.ndarray) -> str:
    return (
        f"{_text(link.name)}, {int(link.kind == 'prismatic')}, {link.antecedent}, {link.joint},\n"
        f"     {_row(link.rotation.ravel())},\n     {_row(link.translation)}, "
        f"{float(link.ratio)!r}, {float(link.offset)!r},\n"
        f"     {_row(body)}"
    )


def _joints(identified: IdentifiedRobot) -> list[str]:
    count = len(identified.robot.joints)
    drives = [identified.of_joints(symbol) for symbol in ("IA", "FV", "FC", "OFF")]
    widths = _widths(identified, Coulomb, count)
    return [
        f"{_text(joint.name)}, " + ", ".join(repr(float(number)) for number in numbers)
        for joint, numbers in zip(identified.robot.joints, zip(*drives, widths, strict=True), strict=True)
    ]


def _motors(identified: IdentifiedRobot, name: str) -> str:
    motors = identified.motors
    if not motors:
        return ""
    weights, rows = [], []
    widths = _widths(identified, GearCoupling, len(motors))
    for index, (motor, width) in enumerate(zip(motors, widths, strict=True)):
        whole = np.zeros(len(identified.robot.joints))
        whole[[joint - 1 for joint in motor.coupling.joints]] = motor.coupling.weights
        weights.append(f"static const double {name}_weights_{index}[] = {_row(whole)};")
        numbers = (motor.rotor_inertia, motor.viscous, motor.coulomb, float(width))
        listed = ", ".join(map(repr, numbers))
        rows.append(f"{_text(motor.coupling.name)}, {name}_weights_{index}, {listed}")
    return "\n".join([*weights, _array("veritorque_motor", f"{name}_motors", rows)])


def _robot(identified: IdentifiedRobot, name: str) -> str:
    robot, motors = identified.robot, len(identified.motors)
    counts = f"{len(robot.links)}, {len(robot.joints)}, {motors}"
    arrays = f"{name}_links, {name}_joints, {f'{name}_motors' if motors else '0'}"
    return (
        f"static const veritorque_robot {name} = {{\n"
        f"    {_text(robot.name)}, {_row(robot.gravity)}, {counts}, {arrays}}};\n"
    )


def _widths(identified: IdentifiedRobot, kind: type[Coulomb | GearCoupling], count: int) -> Sequence[float]:
    found = [term.widths for term in identified.model.terms if isinstance(term, kind)]
    return found[0] if found and found[0] else (0.0,) * count


def _array(kind: str, name: str, rows: Iterable[str]) -> str:
    listed = ",\n".join(f"    {{{row}}}" for row in rows)
    return f"static const {kind} {name}[] = {{\n{listed}}};\n"


def _row(values: np.ndarray) -> str:
    return "{" + ", ".join(repr(float(value) + 0.0) for value in values) + "}"


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False)
