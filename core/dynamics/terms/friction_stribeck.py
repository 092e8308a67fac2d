"""Give Stribeck friction: an excess over the Coulomb level that decays with speed.

sign(v) exp(-(v / vs)^2), with vs the Stribeck velocity. Source: Bo & Pavelescu 1982; Bittencourt &
Gunnarsson 2012.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class Stribeck(OneJointTerm):
    """Model the excess of friction near standstill; `stribeck_velocity` in rad/s (m/s)."""

    stribeck_velocity: float
    symbols = (("excess_torque", "N m", 0.0),)
    kind = "friction_stribeck"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give sign(v) exp(-(v / vs)^2)."""
        velocity = state.velocity[:, self.joint - 1]
        return [state.direction[:, self.joint - 1] * np.exp(-((velocity / self.stribeck_velocity) ** 2))]
