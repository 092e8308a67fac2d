"""Give the units of a joint's own quantities: one that slides has metres where others have angles.

Effects are written for joints that turn; along a slide the same equation holds with position in m and effort
in N, so that an inertia becomes a mass and a stiffness N/m.
"""

import re

from .model import RobotModel

_ALONG = (
    (re.compile(r"\(N m\)"), "N"),
    (re.compile(r"\bN m\b"), "N"),
    (re.compile(r"\brad\b"), "m"),
    (re.compile(r"\bkg m2\b"), "kg"),
)


def along_slide(unit: str) -> str:
    """Turn the unit of a joint that turns into that of one that slides.

    Examples
    --------
    >>> [along_slide(unit) for unit in ("N m", "N m s/rad", "rad/(N m)", "kg m2", "1", "s")]
    ['N', 'N s/m', 'm/N', 'kg', '1', 's']
    """
    for turning, sliding in _ALONG:
        unit = turning.sub(sliding, unit)
    return unit


def slides(robot: RobotModel, joint: int) -> bool:
    """Tell whether a joint, counted from 1, slides; where it moves several links, its first one decides."""
    return next(link.kind for link in robot.links if link.joint == joint) == "prismatic"


def joint_unit(robot: RobotModel, joint: int, unit: str) -> str:
    """Give the unit of a joint's own quantity, from what it is where joints turn."""
    return along_slide(unit) if slides(robot, joint) else unit
