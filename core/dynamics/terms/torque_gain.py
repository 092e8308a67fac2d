"""Give the effect of a gain error of one torque channel or of all: their own predicted torque.

The channel reads (1 + e) times the true torque, so that the column is the predicted torque. Source:
Gautier & Briot, IFAC World Congress 2011.
"""

from dataclasses import dataclass

from ...arrays import JointSeries, Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import AllJointsTerm, OneJointTerm


@dataclass(frozen=True, eq=False)
class TorqueGain(OneJointTerm):
    """Model a relative gain error of a torque channel."""

    believed: Prediction
    symbols = (("relative_error", "1", None),)
    kind = "torque_gain"
    channel = True

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the joint's predicted torque."""
        return [self.believed.applied(state)[:, self.joint - 1]]


@dataclass(frozen=True, eq=False)
class CommonGain(AllJointsTerm):
    """Model the same relative gain error of all torque channels."""

    believed: Prediction
    symbols = (("relative_error", "1", None),)
    kind = "torque_gain"
    channel = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the predicted torque."""
        del robot
        return [self.believed.applied(state)]


@dataclass(frozen=True, eq=False)
class GainOfLog(AllJointsTerm):
    """Model the same relative gain error of all torque channels in one of several logs (from 0)."""

    believed: Prediction
    log: int
    symbols = CommonGain.symbols
    kind = CommonGain.kind
    channel = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the predicted torque; none outside of its log."""
        del robot
        return [self.believed.applied(state) * state.in_log(self.log)[:, None]]
