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
from .c_source import DYNAMICS

WIDTH = 110
TYPES = r"""#include <math.h>

#define VERITORQUE_MOST_LINKS 64

typedef struct {
    const char *name;
    int prismatic;         /* 0: revolute about z, 1: prismatic along z */
    int antecedent;        /* number of the link that carries it, from 1; 0: the base */
    int joint;             /* number of the joint that moves it, from 1 */
    double rotation[9];    /* row by row: from this frame into the antecedent's, at zero coordinate */
    double translation[3]; /* m, in the antecedent's frame */
    double ratio, offset;  /* its angle (rad) or stroke (m) is ratio * q[joint - 1] + offset */
    double inertial[10];   /* XX XY XZ YY YZ ZZ (kg m2, about the frame's origin) MX MY MZ (kg m) M (kg) */
} veritorque_link;

typedef struct {
    const char *name;
    double IA;    /* rotor inertia seen at the joint, kg m2 (prismatic: kg) */
    double FV;    /* viscous friction, N m s/rad (prismatic: N s/m) */
    double FC;    /* Coulomb friction, N m (prismatic: N) */
    double OFF;   /* torque offset, N m (prismatic: N) */
    double width; /* rad/s (m/s): FC acts as FC tanh(dq / width); 0: as FC sign(dq) */
} veritorque_joint;

typedef struct {
    const char *name;
    const double *weights;    /* per joint: the motor turns with the sum of weights[j] * q[j] */
    double IAM, FVM, FCM, width; /* as of a joint, of that sum */
} veritorque_motor;

typedef struct {
    const char *name;
    double gravity[3]; /* acceleration of gravity in the base frame, m/s2 */
    int links, joints, motors;
    const veritorque_link *link;
    const veritorque_joint *joint;
    const veritorque_motor *motor;
} veritorque_robot;
"""
"""What the constants of a robot are made of; two robots' headers may stand in one file."""


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
            "#ifndef VERITORQUE_INVERSE_DYNAMICS\n#define VERITORQUE_INVERSE_DYNAMICS\n",
            TYPES,
            DYNAMICS,
            "#endif /* VERITORQUE_INVERSE_DYNAMICS */\n",
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
