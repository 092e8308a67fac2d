"""Warn of what is allowed but rarely meant: degrees for radians, millimetres for metres, another convention.

None of this is refused, because robots hang from ceilings and cranes are long. A warning gives the numbers.
"""

from collections.abc import Mapping

import numpy as np

from .inertia import pseudo_inertia
from .model import Joint, Link, RobotModel
from .modified_dh import ModifiedDHRow
from .right_angles import SAID_FROM, meant_angle, nearest_right_angle

_ALMOST = 2e-3
"""An angle (rad) this near a right angle is asked about: 1.57 and 1.571 miss one by 0.8 and 0.2 mrad."""
_BEYOND_A_TURN = "more than a turn"
_NAMED = 8
"""How many angles a sentence names before it counts the rest."""


def plausibility_warnings(robot: RobotModel) -> tuple[str, ...]:
    """List, in sentences with numbers, what is probably wrong in a description that can be used.

    Examples
    --------
    >>> from veritorque.core.robot.builtin import builtin_robot
    >>> plausibility_warnings(builtin_robot("yumi"))
    ()
    """
    found = [*robot.remarks, *_about_gravity(robot)]
    for number, link in enumerate(robot.links, start=1):
        found += _about_lengths(number, link)
    for number, joint in enumerate(robot.joints, start=1):
        found += _about_limits(number, joint)
    return tuple(found + _about_letters(robot) + _about_bodies(robot))


def unit_warnings(robot: RobotModel) -> tuple[str, ...]:
    """List those that say that angles or lengths seem to be in another unit: no fit of such a robot counts.

    Examples
    --------
    >>> from veritorque.core.robot.builtin import builtin_robot
    >>> unit_warnings(builtin_robot("yumi"))
    ()
    """
    angles = [remark for remark in robot.remarks if _BEYOND_A_TURN in remark]
    lengths = [_about_lengths(number, link) for number, link in enumerate(robot.links, start=1)]
    return (*angles, *(warning for own in lengths for warning in own))


def _about_gravity(robot: RobotModel) -> list[str]:
    found = []
    size = float(np.linalg.norm(robot.gravity))
    if not 9.7 <= size <= 9.9:
        found.append(f"gravity is {size:.4g} m/s2; on Earth it lies between 9.76 and 9.84")
    if robot.gravity[2] > 0.5 * size > 0.0:
        found.append(
            f"gravity points along +z of the base ({robot.gravity[2]:.4g} m/s2): right for a robot "
            "that hangs from a ceiling; on the floor the acceleration of gravity has a negative z"
        )
    return found


def angle_remarks(angles: Mapping[str, float]) -> list[str]:
    """List what is odd about written angles (rad), and which are taken for right angles.

    Parameters
    ----------
    angles
        As written, by what they are called.

    Examples
    --------
    >>> angle_remarks({"joint 1: alpha": 90.0, "joint 2: alpha": 1.6})
    ['joint 1: alpha is 90 rad, more than a turn; were degrees meant?']
    >>> angle_remarks({"joint 2: alpha": 1.5708})
    ['angles are taken for the right angles they are written for: joint 2: alpha 1.5708 rad']
    """
    found = [
        f"{name} is {angle:.4g} rad, {_BEYOND_A_TURN}; were degrees meant?"
        for name, angle in angles.items()
        if abs(angle) > 2.0 * np.pi
    ]
    missing, taken = list[str](), list[str]()
    for name, angle in angles.items():
        if SAID_FROM < abs(angle - nearest_right_angle(angle)) < _ALMOST:
            (missing if meant_angle(angle) == angle else taken).append(f"{name} {angle:.7g} rad")
    if missing:
        found.append(
            "angles are almost but not quite right angles and taken as written (were right angles meant?): "
            + _listed(missing)
        )
    if taken:
        found.append("angles are taken for the right angles they are written for: " + _listed(taken))
    return found


def _listed(names: list[str]) -> str:
    rest = len(names) - _NAMED
    return "; ".join(names[:_NAMED]) + (f"; and {rest} more" if rest > 0 else "")


def _about_lengths(number: int, link: Link) -> list[str]:
    longest = float(np.abs(link.translation).max())
    if longest <= 10.0:
        return []
    return [
        f"joint {number} lies {longest:.4g} m from the one before; were millimetres or centimetres meant?"
    ]


def _about_limits(number: int, joint: Joint) -> list[str]:
    if joint.limits.position is None or max(map(abs, joint.limits.position)) <= 20.0:
        return []
    lower, upper = joint.limits.position
    return [f"joint {number}: position limits {lower:.4g} .. {upper:.4g} are wide; were degrees or mm meant?"]


def _about_letters(robot: RobotModel) -> list[str]:
    """Find Craig's or standard (distal) Denavit-Hartenberg tables by their first and last rows."""
    first, last = robot.links[0].row, robot.links[-1].row
    if first is None or last is None or len(robot.links) < 2:
        return []
    return _about_rows(first, last) if (first.gamma, first.b) == (0.0, 0.0) else []


def _about_rows(first: ModifiedDHRow, last: ModifiedDHRow) -> list[str]:
    found = []
    if first.d != 0.0 and (first.alpha, first.r) == (0.0, 0.0):
        found.append(
            f"joint 1: d is {first.d:.4g} m and r is 0; Khalil's d is Craig's a and Khalil's r is Craig's d: "
            "were the letters of another convention meant?"
        )
    if first.alpha != 0.0 and (last.alpha, last.d) == (0.0, 0.0):
        found.append(
            f"joint 1: alpha is {first.alpha:.4g} rad and the last row has alpha = d = 0: a "
            "standard Denavit-Hartenberg table has this form, whose rows place the next joint, not their own"
        )
    return found


def _about_bodies(robot: RobotModel) -> list[str]:
    if robot.prior is None:
        return []
    found = []
    for number, (link, body) in enumerate(zip(robot.links, robot.prior, strict=True), start=1):
        eigenvalues = np.linalg.eigvalsh(pseudo_inertia(body))
        if eigenvalues[0] < -1e-12 * float(np.abs(eigenvalues).max()):
            found.append(
                f"link {number} ({link.name}): the body of the prior is not physically consistent, "
                f"its pseudo-inertia has the eigenvalue {eigenvalues[0]:.3g}"
            )
    return found
