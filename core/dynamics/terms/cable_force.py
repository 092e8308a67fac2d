"""Give the torque of a hose or cable once it is taut: a spring over part of the range.

(q - qa)+ where it pulls above the angle qa at which it engages, -(qa - q)+ where it pulls below. Source: the
one-sided linear spring.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class Cable(OneJointTerm):
    """Model a one-sided spring beyond `engage_angle`, rad (m): above it if `side` >= 0, else below it."""

    engage_angle: float
    side: float
    symbols = (("stiffness", "N m/rad", 0.0),)
    kind = "cable_force"
    loads = True

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the angle beyond the engagement, with its sign."""
        beyond = state.position[:, self.joint - 1] - self.engage_angle
        return [np.maximum(beyond, 0.0) if self.side >= 0.0 else np.minimum(beyond, 0.0)]
