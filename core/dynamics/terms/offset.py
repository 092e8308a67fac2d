"""Give the constant torque offset: amplifier offset and asymmetric Coulomb friction, which are not separable.

Source: the seed paper, eq. (4).
"""

from dataclasses import dataclass
from typing import ClassVar

from ...arrays import Series
from ...robot.model import RobotModel
from ...robot.parameters import Parameter
from ...signals.state import MotionState
from ..term import Entry
from .effect import own_joint_entries, own_joint_parameters, own_joint_series


@dataclass(frozen=True)
class Offset:
    """Model the torque offset OFF."""

    name: str = "offset"
    remembers: ClassVar[bool] = False
    channel: ClassVar[bool] = False
    loads: ClassVar[bool] = False

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List OFF of every joint that has it."""
        return own_joint_parameters(robot, _joints(robot), "OFF", "N m", None)

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Pair each joint with its own parameter."""
        return own_joint_entries(_joints(robot))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter."""
        return own_joint_series(_joints(robot), len(state.position), lambda _joint: 1.0)


def _joints(robot: RobotModel) -> tuple[int, ...]:
    return tuple(index for index, joint in enumerate(robot.joints) if "offset" in joint.friction)
