"""Give the drift of a torque channel's offset: linear, or faster at first as electronics warm up.

The parameter is the total drift from the first instant to the last. Its course is 1 - exp(-t / tc), which is
linear where tc is many times the duration. Source: the step response of a first-order lag.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class Drift(OneJointTerm):
    """Model a drifting offset; `start`, `duration` and `time_constant` in s."""

    start: float
    duration: float
    time_constant: float
    symbols = (("total_drift", "N m", None),)
    kind = "torque_offset_drift"
    channel = True

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the share of the drift that has passed."""
        if state.time is None:
            return [np.zeros(len(state.position))]
        return [course(state.time - self.start, self.duration, self.time_constant)]


def course(passed: Samples, duration: float, time_constant: float) -> Samples:
    """Give the share of a drift after some of its duration has passed (all in s).

    Examples
    --------
    >>> course(np.array([0.0, 5.0, 10.0]), 10.0, 1e6).round(5)
    array([0. , 0.5, 1. ])
    """
    return np.asarray(np.expm1(-passed / time_constant) / np.expm1(-duration / time_constant))
