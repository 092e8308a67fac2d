"""Warn of what is allowed but rarely meant: degrees for radians, millimetres for metres, another convention.

None of this is refused, because robots hang from ceilings and cranes are long. A warning gives the numbers.
"""

import numpy as np

from .inertia import pseudo_inertia
from .model import Joint, Link, RobotModel
from .modified_dh import ModifiedDHRow


def plausibility_warnings(robot: RobotModel) -> tuple[str, ...]:
    """List, in sentences with numbers, what is probably wrong in a description that can be used.

    Examples
    --------
    >>> from veritorque.core.robot.builtin import builtin_robot
    >>> plausibility_warnings(builtin_robot("yumi"))
    ()
    """
    found = _about_gravity(robot)
    for number, link in enumerate(robot.links, start=1):
        found += _about_angles(number, link) + _about_lengths(number, link)
    for number, joint in enumerate(robot.joints, start=1):
        found += _about_limits(number, joint)
    return tuple(found + _about_letters(robot) + _about_bodies(robot))


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


def _about_angles(number: int, link: Link) -> list[str]:
    if link.row is None:
        return []
    angles = {"alpha": link.row.alpha, "theta_offset": link.row.theta, "gamma": link.row.gamma}
    turns = [
        f"joint {number}: {name} is {angle:.4g} rad, more than a turn; were degrees meant?"
        for name, angle in angles.items()
        if abs(angle) > 2.0 * np.pi
    ]
    return turns + [
        f"joint {number}: {name} is {angle:.7g} rad, almost but not quite a right angle; was one meant?"
        for name, angle in angles.items()
        if 2e-5 < abs(angle - np.pi / 2 * round(angle / (np.pi / 2))) < 2e-3
    ]


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
