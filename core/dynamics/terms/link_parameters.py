"""Give the effect of a link's inertial parameters that differ from those of the operating point's model.

The ten columns are in the standard model, too, alone or grouped; they are separable from it only where its
own parameters are fixed. Source: Khalil & Dombre (2002), ch. 9.
"""

from dataclasses import dataclass

from ...arrays import JointSeries
from ...robot.model import INERTIAL_SYMBOLS, INERTIAL_UNITS, RobotModel
from ...signals.state import MotionState
from .effect import AllJointsTerm
from .payload_change import body_torques


@dataclass(frozen=True, eq=False)
class LinkChange(AllJointsTerm):
    """Model a change of all ten parameters of a link (number from 1)."""

    link: int
    symbols = tuple((f"delta_{symbol}", INERTIAL_UNITS[symbol], None) for symbol in INERTIAL_SYMBOLS)
    kind = "link_parameters"
    loads = True

    @property
    def changes(self) -> tuple[str, ...]:
        """Name the parameters that change."""
        return tuple(f"{symbol}{self.link}" for symbol in INERTIAL_SYMBOLS)

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the torque per unit of change."""
        return list(body_torques(robot, self.link, state))
