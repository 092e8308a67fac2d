"""Give the effect of low-passed positions: the torque of the motion as it was, minus that of the logged one.

A zero-phase low-pass has the gain 1 / (1 + (T w)^(2 order)), so that the motion as it was is the logged one
plus what its inverse adds: to first order in T^(2 order), what the same filter takes from the logged one. The
column is the change of torque by that over T^(2 order), so that its linear parameter is T^(2 order) when the
two agree. Source: Oppenheim & Schafer, Discrete-Time Signal Processing, ch. 7.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from ...arrays import JointSeries, Series
from ...robot.model import Parameter, RobotModel
from ...signals.state import MotionState
from ...signals.zero_phase import gain
from ..prediction import Prediction
from .effect import AllJointsTerm, step_of

HIGHEST = 0.45
"""Largest cut-off, as a share of the rate of the states: the kernel needs one below a half."""
PERIODS = 3.0
"""Periods of the cut-off by which a motion is continued at its ends."""


@dataclass(frozen=True, eq=False)
class PositionFilter(AllJointsTerm):
    """Model positions behind a zero-phase low-pass whose order is 1 or 2; `around` is T^(2 order)."""

    believed: Prediction
    around: float
    order: int = 1
    most: int = 1
    """Terms of the inverse's series in what the filter takes: its gain is at most their number."""
    symbols = (("time_power", "s2", 0.0),)
    kind = "position_filter"
    has_memory = True
    channel = True

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """Give the power of the time constant, with its unit."""
        return tuple(replace(own, unit=f"s{2 * self.order}") for own in super().parameters(robot))

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of torque by what the filter took, per unit of T^(2 order)."""
        del robot
        taken = _taken(state, cutoff_hz(self.around, self.order), self.order, self.most)
        change = np.zeros(state.position.shape[::-1])
        for joint, shift in enumerate(zip(*taken, strict=True)):
            self.believed.add_change(state, joint, shift, change)
            change[joint] += self.believed.rotor(joint + 1) * shift[2]
            change[joint] += self.believed.viscous(joint + 1) * shift[1]
        return [(change / self.around).T]


def _parts(state: MotionState) -> tuple[JointSeries, JointSeries, JointSeries]:
    """Give position, velocity and acceleration."""
    return state.position, state.velocity, state.acceleration


def cutoff_hz(time_power: float, order: int) -> float:
    """Give the frequency at which the filter halves an amplitude, Hz.

    Examples
    --------
    >>> round(cutoff_hz(1e-4, 1), 2)
    15.92
    """
    return float(time_power ** (-0.5 / order) / (2.0 * np.pi))


def time_power(cutoff: float, order: int) -> float:
    """Give T^(2 order) of the cut-off, s^(2 order).

    Examples
    --------
    >>> round(cutoff_hz(time_power(12.0, 2), 2), 6)
    12.0
    """
    return float((2.0 * np.pi * cutoff) ** (-2 * order))


def _taken(state: MotionState, cutoff: float, order: int, most: int) -> list[Series]:
    """Give what the inverse of the filter adds to positions, velocities and accelerations."""
    rate = 1.0 / step_of(state)
    reach = min(int(np.ceil(PERIODS * rate / cutoff)), len(state.position) - 1)
    transformed, length = _transformed(state, reach)
    frequency, size = np.fft.rfftfreq(length, 1.0 / rate), 2 * (transformed.shape[1] - 1)
    passed = gain(frequency, cutoff_hz=min(cutoff, HIGHEST * rate), rate_hz=rate, order=order)
    inverse = np.sum((1.0 - passed) ** np.arange(1.0, most + 1.0)[:, None], axis=0)
    added = irfft(transformed * inverse, size)[:, reach : reach + len(state.position)]
    return np.split(np.ascontiguousarray(added), 3)


@lru_cache(maxsize=8)
def _transformed(state: MotionState, reach: int) -> tuple[np.ndarray, int]:
    """Transform a motion that is continued at its ends; give the length too. Filters share it."""
    series = np.vstack([part.T for part in _parts(state)])
    padded = np.pad(series, ((0, 0), (reach, reach)), mode="reflect", reflect_type="odd")
    length = next_fast_len(padded.shape[1], real=True)
    return rfft(padded, 2 * (length // 2)), length
