"""Give the effect of a delayed torque channel: the delayed minus the predicted torque.

A delay d turns tau(t) into tau(t - d); a negative one leads. The column is the change over d, so that its
linear parameter is the delay when the two agree; without a d it is minus the rate. Source: Ljung, System
Identification (1999), ch. 4.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline

from ...arrays import JointSeries
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import AllJointsTerm, rates


@dataclass(frozen=True, eq=False)
class Delay(AllJointsTerm):
    """Model a delay of the torque channels, the same on all joints, in s near `around`."""

    believed: Prediction
    around: float = 0.0
    symbols = (("delay", "s", None),)
    kind = "time_delay"
    has_memory = True
    channel = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give (delayed minus predicted torque) / delay; for no delay, minus the rate."""
        del robot
        torque = self.believed.scaled(state)
        if self.around == 0.0 or state.time is None:
            return [-rates(torque, state)[0]]
        then = np.clip(state.time - self.around, state.time[0], state.time[-1])
        return [(_between_samples(self.believed, state)(then) - torque) / self.around]


@lru_cache(maxsize=8)
def _between_samples(believed: Prediction, state: MotionState) -> CubicSpline:
    """Give the predicted torque at any time; all delays of a scan share it."""
    return CubicSpline(np.asarray(state.time), believed.scaled(state))
