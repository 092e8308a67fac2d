"""Give the units of a joint's own quantities: metres at a prismatic joint, angles at a revolute one.

Effects are written for revolute joints. At a prismatic joint the same equation holds with position in m and
effort in N, so that an inertia becomes a mass and a stiffness N/m.
"""

import re

from .model import RobotModel

_PRISMATIC = (
    (re.compile(r"\(N m\)"), "N"),
    (re.compile(r"\bN m\b"), "N"),
    (re.compile(r"\brad\b"), "m"),
    (re.compile(r"\bkg m2\b"), "kg"),
)


def prismatic_unit(unit: str) -> str:
    """Turn the unit of a revolute joint into that of a prismatic one.

    Examples
    --------
    >>> [prismatic_unit(unit) for unit in ("N m", "N m s/rad", "rad/(N m)", "kg m2", "1", "s")]
    ['N', 'N s/m', 'm/N', 'kg', '1', 's']
    """
    for revolute, prismatic in _PRISMATIC:
        unit = revolute.sub(prismatic, unit)
    return unit


def is_prismatic(robot: RobotModel, joint: int) -> bool:
    """Tell whether a joint, counted from 1, is prismatic; of several links that it moves the first counts."""
    return next(link.kind for link in robot.links if link.joint == joint) == "prismatic"


def joint_unit(robot: RobotModel, joint: int, unit: str) -> str:
    """Give the unit of a joint's own quantity, from its unit at a revolute joint."""
    return prismatic_unit(unit) if is_prismatic(robot, joint) else unit
