"""Give the effect of joint elasticity with motor-side encoders: the link lags by torque over stiffness.

The link's position is q - H(load / K), to first order in the compliance 1 / K. H is the response of the
link's inertia on spring and damper, one below their resonance. The change of the load is linear in 1 / K.
Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq

from ...arrays import JointSeries, Samples, Spectrum
from ...robot.joint_units import joint_unit
from ...robot.model import Parameter, RobotModel
from ...signals.state import MotionState
from ...signals.zero_phase import kernel
from ..gear import Gear
from ..prediction import Prediction
from .effect import AllJointsTerm, rates, step_of


@dataclass(frozen=True, eq=False)
class Elasticity(AllJointsTerm):
    """Model joint elasticity."""

    believed: Prediction
    band_hz: float
    """Bandwidth at which loads are smoothed before differentiation."""
    resonance_hz: float
    damping_ratio: float
    """Those of the link's inertia on the spring: below it the link follows the load without lag."""
    motor_inertia: float = 0.0
    """Rotor inertia that the operating point's load contains, kg m2 (kg)."""
    symbols = (("compliance", "rad/(N m)", 0.0),)
    kind = "joint_elasticity"
    has_memory = True

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the compliance, in the unit of its joint."""
        return tuple(
            replace(compliance, unit=joint_unit(robot, self.joint, compliance.unit))
            for compliance in super().parameters(robot)
        )

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of all joints' loads per unit of compliance."""
        del robot
        gear = Gear(self.believed, self.joint, self.motor_inertia)
        load = _load_spectrum(gear, state, self.band_hz)
        lag = -resonate(load, state, self.resonance_hz, self.damping_ratio)[:, None]
        return [gear.change(state, MotionState(lag, *rates(lag, state)))]


@lru_cache(maxsize=64)
def _load_spectrum(gear: Gear, state: MotionState, band_hz: float) -> Spectrum:
    """Give the spectrum of a transmission's smoothed load; cached for a scan."""
    return spectrum_of(smooth(gear.load(state)[:, None], state, band_hz)[:, 0])


def spectrum_of(values: Samples) -> Spectrum:
    """Transform a series that is mirrored at its end and padded by its first value to a fast length."""
    size = next_fast_len(2 * len(values), real=True)
    held = np.full(size - 2 * len(values), values[0])
    return np.asarray(rfft(np.concatenate([values, values[::-1], held])))


def resonate(spectrum: Spectrum, state: MotionState, resonance_hz: float, damping_ratio: float) -> Samples:
    """Filter a series of a state's samples by a mass on a spring, with gain one at rest."""
    count = len(state.position)
    size = next_fast_len(2 * count, real=True)
    ratio = rfftfreq(size, step_of(state)) / resonance_hz
    response = 1.0 / (1.0 - ratio**2 + 2j * damping_ratio * ratio)
    return np.asarray(irfft(spectrum * response, size)[:count])


def smooth(values: JointSeries, state: MotionState, band_hz: float) -> JointSeries:
    """Filter columns by a zero-phase low-pass; beyond its ends a series is continued by its end values."""
    response = kernel(min(band_hz, 0.4 / step_of(state)), 1.0 / step_of(state), 2)
    reach = len(response) // 2
    padded = np.pad(values, ((reach, reach), (0, 0)), mode="edge")
    return np.column_stack([np.convolve(column, response, mode="valid") for column in padded.T])
