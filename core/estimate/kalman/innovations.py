"""Say what a Kalman filter assumed, how well it foresaw, and what it knew of the parameters over time."""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import JointVector, Matrix, Samples


@dataclass(frozen=True, eq=False)
class Innovations:
    """Hold what tells whether a filter's assumptions hold."""

    position_noise: JointVector
    torque_noise: JointVector
    """Deviations that it assumed, rad or m, and N m or N: that of the torque at the first fit's band."""
    variance: JointVector
    """Per joint, of what it did not foresee of the positions, over what it expected: 1 where all holds."""
    shortened: float
    """Share of samples at which parameters had to differ by less, for the mass matrix to stay positive."""
    dispersion: float
    """Factor on the variance of the parameters by which blocks differ more than the filter expects."""
    start_scale: float
    """Factor on the deviations of the first fit with which it began: less than asked where that failed."""


@dataclass(frozen=True, eq=False)
class Track:
    """Hold the base parameters over time, as a filter follows them whose parameters drift."""

    log: tuple[int, ...]
    """Number of the log at every instant, from 0."""
    time: Samples
    """Instants, s: the ends of the fitted blocks."""
    value: Matrix
    standard_deviation: Matrix
    """Instants x base parameters."""

    def widened(self, dispersion: float) -> "Track":
        """Give it with variances as much larger as blocks scatter more than the filter expects."""
        return replace(self, standard_deviation=self.standard_deviation * np.sqrt(max(dispersion, 1.0)))
