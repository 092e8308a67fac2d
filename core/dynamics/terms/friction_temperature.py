"""Give temperature-dependent friction: over the logged temperature, or over the time since the start.

With a sensor the regressor is the temperature above a reference. Without one it is 1 - exp(-t / tc), the
course of a body under constant heating, and the parameters are the change over the whole warm-up. Sources:
Bittencourt & Gunnarsson, J. Dyn. Sys. Meas. Control 134(5), 2012; Simoni et al. 2019 (no sensor).
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class TemperatureFriction(OneJointTerm):
    """Model friction over the logged temperature; `reference` in degC; zero where none was logged."""

    reference: float
    symbols = (("coulomb_slope", "N m/K", None), ("viscous_slope", "N m s/rad/K", None))
    kind = "friction_temperature"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give sign(v) and v, each times the temperature above the reference."""
        velocity = state.velocity[:, self.joint - 1]
        if state.temperature is None:
            return [np.zeros_like(velocity), np.zeros_like(velocity)]
        return _weighted(state, self.joint - 1, state.temperature[:, self.joint - 1] - self.reference)


@dataclass(frozen=True, eq=False)
class WarmUpFriction(OneJointTerm):
    """Model friction over the time since `start`, s, with the time constant of the warm-up, s.

    The parameters keep the names of the form with a sensor, but are changes over the whole warm-up. Zero
    where the motion has no time.
    """

    start: float
    time_constant: float
    symbols = (("coulomb_slope", "N m", None), ("viscous_slope", "N m s/rad", None))
    kind = "friction_temperature"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give sign(v) and v, each times the share of the warm-up that has passed."""
        velocity = state.velocity[:, self.joint - 1]
        if state.time is None:
            return [np.zeros_like(velocity), np.zeros_like(velocity)]
        return _weighted(state, self.joint - 1, -np.expm1(-(state.time - self.start) / self.time_constant))


def _weighted(state: MotionState, joint: int, warmth: Samples) -> list[Samples]:
    return [state.direction[:, joint] * warmth, state.velocity[:, joint] * warmth]
