"""Share what terms have in common that act on their own joint only.

One parameter, one column, one series per joint.
"""

from collections.abc import Callable

import numpy as np

from ...arrays import Samples, Series
from ...robot.joint_units import joint_unit
from ...robot.model import RobotModel
from ...robot.parameters import Parameter
from ..term import Entry


def own_joint_parameters(
    robot: RobotModel, joints: tuple[int, ...], symbol: str, unit: str, lower: float | None
) -> tuple[Parameter, ...]:
    """Name one parameter for each of the joints (from 0).

    `unit` is that of a joint that turns.
    """
    return tuple(
        Parameter(symbol, joint + 1, joint + 1, joint_unit(robot, joint + 1, unit), lower) for joint in joints
    )


def own_joint_entries(joints: tuple[int, ...]) -> tuple[Entry, ...]:
    """Pair each joint with its parameter."""
    return tuple((joint, position) for position, joint in enumerate(joints))


def own_joint_series(
    joints: tuple[int, ...], samples: int, column: Callable[[int], Samples | float]
) -> Series:
    """Stack the column of each joint."""
    rows = np.empty((len(joints), samples))
    for position, joint in enumerate(joints):
        rows[position] = column(joint)
    return rows
