"""Give the effect of friction and offset that differ from those of the operating point's model.

All three columns are in the standard model, too; they are separable from it only where its own parameters are
fixed. Source: Bittencourt & Gunnarsson 2012, on friction that changes between two runs.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .coulomb import direction
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class FrictionChange(OneJointTerm):
    """Model a change of viscous and Coulomb friction and of the offset."""

    width: float = 0.0
    """Width over which the sign of velocity is smoothed, rad/s or m/s; 0 for the plain sign."""
    symbols = (
        ("delta_viscous", "N m s/rad", None),
        ("delta_coulomb", "N m", None),
        ("delta_offset", "N m", None),
    )
    kind = "friction_change"

    @property
    def changes(self) -> tuple[str, ...]:
        """Name the parameters that change."""
        return tuple(f"{symbol}{self.joint}" for symbol in ("FV", "FC", "OFF"))

    def columns(self, state: MotionState) -> list[Samples]:
        """Give velocity, its sign, and one."""
        velocity = state.velocity[:, self.joint - 1]
        dry = state.by_stamps(lambda speeds: direction(speeds[:, self.joint - 1], self.width))
        return [velocity, dry, np.ones_like(velocity)]
