"""Give the units of a joint's own quantities: metres at a prismatic joint, angles at a revolute one.

Effects are written for revolute joints. At a prismatic joint the same equation holds with position in m and
effort in N, so that an inertia becomes a mass and a stiffness N/m.
"""

import re

import numpy as np

from ..arrays import JointVector, Mask
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


def prismatic_joints(robot: RobotModel) -> Mask:
    """Mark the prismatic joints."""
    return np.array([is_prismatic(robot, joint) for joint in range(1, len(robot.joints) + 1)])


def prismatic_numbers(robot: RobotModel) -> list[int]:
    """List the prismatic joints, from 1."""
    return (np.flatnonzero(prismatic_joints(robot)) + 1).tolist()


def largest_of_kind(values: JointVector, prismatic: Mask) -> JointVector:
    """Give, per joint, the largest value among the joints of its kind: metres are not compared with angles.

    Examples
    --------
    >>> largest_of_kind(np.array([2.0, 0.012, 1.0]), np.array([False, True, False]))
    array([2.   , 0.012, 2.   ])
    """
    out = np.zeros_like(values)
    for kind in (prismatic, ~prismatic):
        out[kind] = values[kind].max(initial=0.0)
    return out
