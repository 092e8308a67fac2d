"""Estimate white noise from fourth differences, in which a motion of limited bandwidth vanishes.

Source: Rice, Annals of Statistics 12, 1984 (differences); Huber 1981 (limits of what one of them counts).
"""

import numpy as np

from ..arrays import Instants, JointSeries, JointVector, Samples, Vector

FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
"""Weights of a fourth difference."""
OUTLYING = 4.0
"""A difference of so many standard deviations tells no more than this: torques jerk, and encoders count."""
_MEDIAN_SQUARE = 0.4549
"""Median of the square of a standard normal variable."""


def fourth_differences(values: Samples) -> Instants:
    """Give the fourth differences of a series, shorter by four."""
    return np.convolve(values, FOURTH, mode="valid")


def normal_spread(values: Vector) -> float:
    """Give the standard deviation that normal values of this median square have."""
    return float(np.sqrt(np.median(values**2) / _MEDIAN_SQUARE))


def white_noise(series: JointSeries) -> JointVector:
    """Give the RMS of each column's white noise; steps and jerks, which are rare, hardly count.

    Examples
    --------
    >>> time, noise = np.arange(4000) / 250.0, np.random.default_rng(1).normal(size=4000)
    >>> white_noise((np.sin(time) + (time > 8.0) + 0.01 * noise)[:, None]).round(3)
    array([0.01])
    """
    sizes = [_rms(fourth_differences(values)) for values in series.T]
    return np.asarray(np.array(sizes) / np.linalg.norm(FOURTH))


def _rms(differences: Vector) -> float:
    spread = normal_spread(differences)
    limit = OUTLYING * spread if spread > 0.0 else np.inf  # a coarse encoder's are mostly none
    return float(np.sqrt(np.mean(np.clip(differences, -limit, limit) ** 2)))
