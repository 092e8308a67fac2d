"""Give position-dependent Coulomb friction: sign(v) cos(h q), sign(v) sin(h q).

Eccentric gears and tight bearings have more friction at some angles. Source: Armstrong-Helouvry,
Control of Machines with Friction (1991).
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class PositionFriction(OneJointTerm):
    """Model a Coulomb level with `harmonic` cycles per revolution, their phase relative to `centre`, rad."""

    harmonic: float
    centre: float
    symbols = (("cosine", "N m", None), ("sine", "N m", None))
    kind = "friction_position_dependent"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give cosine and sine of h (q - centre), each times sign(v)."""
        sign = state.direction[:, self.joint - 1]
        angle = self.harmonic * (state.position[:, self.joint - 1] - self.centre)
        return [sign * np.cos(angle), sign * np.sin(angle)]
