"""Give Coulomb friction: FC times sign(velocity), smoothed where required.

The sign is wrong within the velocity's error of zero, where a measured velocity changes sign too early or too
late. A smoothed sign tanh(v / width) spreads the step over a width that the caller chooses per joint from
data that is not held out. Where a simulation says which share of its level friction takes, also at rest, that
share is the column. Source: the seed paper, eq. (4).
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import EachJointTerm


@dataclass(frozen=True)
class Coulomb(EachJointTerm):
    """Model Coulomb friction FC.

    `widths` holds one smoothing width per joint in rad/s (m/s); empty or 0 means the plain sign.
    """

    widths: tuple[float, ...] = ()
    name: str = "coulomb"
    symbol = ("FC", "N m", 0.0)

    def column(self, joint: int, state: MotionState) -> Samples:
        """Give the sign of the joint's velocity, or the share of its level where that is known."""
        if state.friction_share is not None:
            return np.asarray(state.friction_share[:, joint])
        width = self.widths[joint] if self.widths else 0.0
        return state.by_stamps(lambda velocity: direction(velocity[:, joint], width))


def direction(velocity: Samples, width: float) -> Samples:
    """Give sign(velocity), smoothed as tanh(velocity / width) where width > 0 (rad/s or m/s).

    Examples
    --------
    >>> direction(np.array([-2.0, 0.0, 0.1]), 0.0)
    array([-1.,  0.,  1.])
    """
    return np.sign(velocity) if width <= 0.0 else np.tanh(velocity / width)
