"""Give what a compliant gear adds when the encoder sits on the motor: the link lags by torque over stiffness.

The link's position is q - H(load / K), to first order in the compliance 1 / K; H is the response of the
link's inertia on spring and damper, one below their resonance. What the load changes by is linear in 1 / K.
Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.arrays import JointSeries
from core.dynamics.prediction import Prediction
from core.dynamics.terms.effect import AllJointsTerm, Symbol, rates, step_of
from core.robot.model import RobotModel
from core.signals.state import MotionState
from core.signals.zero_phase import kernel


@dataclass(frozen=True, eq=False)
class Elasticity(AllJointsTerm):
    """Model a compliant gear.

    Attributes
    ----------
    band_hz
        Loads are smoothed at it before they are differentiated.
    resonance_hz, damping_ratio
        Of the link's inertia on the gear's spring: below it the link follows the load at once.
    """

    believed: Prediction
    band_hz: float
    resonance_hz: float
    damping_ratio: float
    symbols: ClassVar[tuple[Symbol, ...]] = (("compliance", "rad/(N m)", 0.0),)
    kind: ClassVar[str] = "joint_elasticity"
    remembers: ClassVar[bool] = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of all joints' loads per unit of compliance."""
        del robot
        own = self.joint - 1
        load = smoothed(self.believed.load(state)[:, [own]], state, self.band_hz)
        load = swung(load, state, self.resonance_hz, self.damping_ratio)
        first, second = rates(load, state)
        return [-self.believed.change(state, own, MotionState(load, first, second))]


def swung(values: JointSeries, state: MotionState, resonance_hz: float, damping_ratio: float) -> JointSeries:
    """Let columns pass a spring with a mass on it, gain one at rest; the series is mirrored at its ends."""
    count = len(values)
    mirrored = np.concatenate([values, values[::-1]])
    ratio = np.fft.rfftfreq(2 * count, step_of(state)) / resonance_hz
    response = 1.0 / (1.0 - ratio**2 + 2j * damping_ratio * ratio)
    return np.asarray(
        np.fft.irfft(np.fft.rfft(mirrored, axis=0) * response[:, None], 2 * count, axis=0)[:count]
    )


def smoothed(values: JointSeries, state: MotionState, band_hz: float) -> JointSeries:
    """Low-pass columns without delay; beyond its ends a series is continued by its end values."""
    response = kernel(min(band_hz, 0.4 / step_of(state)), 1.0 / step_of(state), 2)
    reach = len(response) // 2
    padded = np.pad(values, ((reach, reach), (0, 0)), mode="edge")
    return np.column_stack([np.convolve(column, response, mode="valid") for column in padded.T])
