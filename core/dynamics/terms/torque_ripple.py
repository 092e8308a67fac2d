"""Give torque ripple: cos(h q) and sin(h q).

Cogging, wave generators and gear teeth repeat per revolution of motor or gear, at h cycles per revolution of
the joint. Source: Madsen et al. 2020 (strain-wave gears).
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class Ripple(OneJointTerm):
    """Model a torque with `harmonic` cycles per revolution, their phase relative to `centre`, rad."""

    harmonic: float
    centre: float
    symbols = (("cosine", "N m", None), ("sine", "N m", None))
    kind = "torque_ripple"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give cosine and sine of h (q - centre)."""
        angle = self.harmonic * (state.position[:, self.joint - 1] - self.centre)
        return [np.cos(angle), np.sin(angle)]
