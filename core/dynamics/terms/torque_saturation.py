"""Give the excess of a logged command over the torque that a saturated drive applies.

The motion shows the applied torque only: it stays at the limit while the command exceeds it. The excess is
zero where the limit is reached and left; between these instants a and b it is approximated by a parabola,
(t - a)(b - t) / 2, and its skew, because a controller first accumulates an error and then reduces it. Source:
the polynomials of least degree with these zeros.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...numerics.marked_runs import marked_runs
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class Saturation(OneJointTerm):
    """Model the excess of a command over `limit`, N m (N)."""

    believed: Prediction
    limit: float
    symbols = (("bulge", "N m/s2", 0.0), ("skew", "N m/s3", None))
    kind = "torque_saturation"
    has_memory = True
    channel = True

    def columns(self, state: MotionState) -> list[Samples]:
        """Give parabola and skew over every interval in which the predicted torque is beyond the limit."""
        torque = self.believed.applied(state)[:, self.joint - 1]
        bulge, skew = np.zeros_like(torque), np.zeros_like(torque)
        if state.time is None:
            return [bulge, skew]
        excess = np.abs(torque) - self.limit
        for first, stop in marked_runs(excess > 0.0).tolist():
            begin, end = _crossing(state.time, excess, first, -1), _crossing(state.time, excess, stop - 1, 1)
            now = state.time[first:stop]
            arch = np.sign(torque[first]) * 0.5 * (now - begin) * (end - now)
            bulge[first:stop] = arch
            skew[first:stop] = arch * (now - 0.5 * (begin + end))
        return [bulge, skew]


def _crossing(time: Samples, excess: Samples, inside: int, step: int) -> float:
    """Give the instant, s, between a sample beyond the limit and its neighbour, at which it was reached."""
    outside = inside + step
    if not 0 <= outside < len(time):
        return float(time[inside])
    share = excess[inside] / (excess[inside] - excess[outside])
    return float(time[inside] + share * (time[outside] - time[inside]))
