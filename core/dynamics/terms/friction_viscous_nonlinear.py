"""Give nonlinear viscous friction: sign(v) |v|^p beside the linear FV v.

A power p below one is fluid friction that saturates, above one it is drag. Source: Bittencourt & Gunnarsson,
J. Dyn. Sys. Meas. Control 134(5), 2012.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class NonlinearViscous(OneJointTerm):
    """Model friction that grows with a power of speed; `exponent` without unit."""

    exponent: float
    symbols = (("coefficient", "N m (s/rad)^p", None),)
    kind = "friction_viscous_nonlinear"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give sign(v) |v|^p."""
        velocity = state.velocity[:, self.joint - 1]
        return [np.sign(velocity) * np.abs(velocity) ** self.exponent]
