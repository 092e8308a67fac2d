"""Give what a torque channel that lags behind the positions adds: the predicted torque late, minus on time.

A delay d turns tau(t) into tau(t - d). The column is the change per unit of delay around `delay`, so that the
linear parameter is a correction to it; a negative delay leads. Source: Ljung, System Identification (1999),
ch. 4.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.arrays import JointSeries
from core.dynamics.prediction import Prediction
from core.dynamics.terms.effect import AllJointsTerm, Symbol, rates
from core.robot.model import RobotModel
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Delay(AllJointsTerm):
    """Model a torque channel that is late by the same time on all joints."""

    believed: Prediction
    symbols: ClassVar[tuple[Symbol, ...]] = (("delay", "s", None),)
    kind: ClassVar[str] = "time_delay"

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give minus the rate of the predicted torque."""
        del robot
        first, _ = rates(self.believed.torque(state), state)
        return [-np.asarray(first)]
