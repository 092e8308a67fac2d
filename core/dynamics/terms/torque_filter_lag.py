"""Give the effect of a low-pass filter in the torque channel: the filtered minus the predicted torque.

A first-order filter with time constant T gives tau / (1 + T s). To first order in T it is a delay by T; to
second order it has T^2 s^2 where a delay has half as much. The column is the difference over T, so that
its linear parameter is the time constant when the two agree. Source: Oppenheim & Willsky, Signals and Systems
(1997), ch. 6.
"""

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from ...arrays import JointSeries
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import AllJointsTerm, step_of


@dataclass(frozen=True, eq=False)
class FilterLag(AllJointsTerm):
    """Model a first-order low-pass of all torque channels; `around` is the linearisation point in s."""

    believed: Prediction
    around: float
    symbols = (("time_constant", "s", 0.0),)
    kind = "torque_filter_lag"
    has_memory = True
    channel = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give (filtered minus predicted torque) / time constant."""
        del robot
        torque = self.believed.scaled(state)
        return [(filter_first_order(torque, step_of(state), self.around) - torque) / self.around]


def filter_first_order(values: JointSeries, step: float, time_constant: float) -> JointSeries:
    """Filter columns by 1 / (1 + T s), exact for linear interpolation, in steady state at the first sample.

    Parameters
    ----------
    step, time_constant
        Time between samples and T, both in s.

    Examples
    --------
    In steady state a ramp is delayed by the time constant.

    >>> ramp = np.arange(200.0)[:, None]
    >>> float((ramp - filter_first_order(ramp, 1.0, 4.0))[-1, 0])
    4.0
    """
    pole = np.exp(-step / time_constant)
    held = (1.0 - pole) * time_constant / step
    ahead = (1.0 - held, held - pole)
    start = (1.0 - ahead[0]) * values[:1]
    return np.asarray(lfilter(ahead, (1.0, -pole), values, axis=0, zi=start)[0])
