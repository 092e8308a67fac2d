"""Give a torque channel whose zero drifts: evenly, or fast at first as electronics that warm up.

The parameter is the whole drift from the first instant to the last; its course is 1 - exp(-t / tc), which is
even where tc is many times the duration. Source: the step response of a first-order lag.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.arrays import Samples
from core.dynamics.terms.effect import OneJointTerm, Symbol
from core.robot.model import RobotModel
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Drift(OneJointTerm):
    """Model a drifting offset; `start`, `duration` and `time_constant` in s."""

    start: float
    duration: float
    time_constant: float
    symbols: ClassVar[tuple[Symbol, ...]] = (("total_drift", "N m", None),)
    kind: ClassVar[str] = "torque_offset_drift"
    channel: ClassVar[bool] = True

    def columns(self, robot: RobotModel, state: MotionState) -> list[Samples]:
        """Give the share of the drift that is over."""
        del robot
        if state.time is None:
            return [np.zeros(len(state.position))]
        passed = state.time - self.start
        whole = np.expm1(-self.duration / self.time_constant)
        return [np.asarray(np.expm1(-passed / self.time_constant) / whole)]
