"""Give direction-dependent viscous friction: |v| times half the difference.

FV + delta forwards and FV - delta backwards is FV v + delta |v|. Source: Armstrong-Helouvry, Control of
Machines with Friction (1991).
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class AsymmetricViscous(OneJointTerm):
    """Model the half difference of forward and backward viscous friction."""

    symbols = (("delta_viscous", "N m s/rad", None),)
    kind = "friction_asymmetric"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give |v|."""
        return [np.abs(state.velocity[:, self.joint - 1])]
