"""Give Coulomb friction: FC times sign(velocity), smoothed where required.

The sign is wrong within the velocity's error of zero, where a measured velocity changes sign too early or too
late. A smoothed sign tanh(v / width) spreads the step over a width that the caller chooses per joint from
data that is not held out. Source: the seed paper, eq. (4).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Samples, Series
from ...robot.model import RobotModel
from ...robot.parameters import Parameter
from ...signals.state import MotionState
from ..term import Entry
from .effect import own_joint_entries, own_joint_parameters, own_joint_series


@dataclass(frozen=True)
class Coulomb:
    """Model Coulomb friction FC.

    `widths` holds one smoothing width per joint in rad/s (m/s); empty or 0 means the plain sign.
    """

    widths: tuple[float, ...] = ()
    name: str = "coulomb"
    remembers: ClassVar[bool] = False
    channel: ClassVar[bool] = False
    loads: ClassVar[bool] = False

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List FC of every joint that has it."""
        return own_joint_parameters(robot, _joints(robot), "FC", "N m", 0.0)

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Pair each joint with its own parameter."""
        return own_joint_entries(_joints(robot))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter."""
        widths = self.widths or (0.0,) * len(robot.joints)
        return own_joint_series(
            _joints(robot),
            len(state.position),
            lambda joint: direction(state.velocity[:, joint], widths[joint]),
        )


def direction(velocity: Samples, width: float) -> Samples:
    """Give sign(velocity), smoothed as tanh(velocity / width) where width > 0 (rad/s or m/s).

    Examples
    --------
    >>> direction(np.array([-2.0, 0.0, 0.1]), 0.0)
    array([-1.,  0.,  1.])
    """
    return np.sign(velocity) if width <= 0.0 else np.tanh(velocity / width)


def _joints(robot: RobotModel) -> tuple[int, ...]:
    return tuple(index for index, joint in enumerate(robot.joints) if "coulomb" in joint.friction)
