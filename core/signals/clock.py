"""Tell on which clock samples were taken: that of their stamps, or an even one whose stamps came late.

A recorder that stamps a message when it arrives scatters the stamps of samples that a controller took evenly.
Positions tell: what they deviate from a smooth motion, row by row, follows velocity times the scatter where
the samples were taken at their stamps, and is independent of it where they were not.
"""

import numpy as np

from ..arrays import RowSeries, Samples, Vector
from .white_noise import FOURTH, OUTLYING, fourth_differences, normal_spread

UNIFORM_TOLERANCE = 1e-3
"""Stamps that deviate from a uniform clock by less than a thousandth of a step are uniform."""
NEAR, WINDOW, SHIFT = 1.0, 25, 0.5
"""Rows are complete whose stamps lie within so many steps of an even clock, and whose means over so many rows
differ from those of the next by less than so many steps: a row that was left out shifts them by one."""
HALFWAY, DEVIATIONS = 0.5, 3.0
"""The clock is even where positions follow less than half of the scatter, by so many standard deviations."""
ROWS = 65_536
"""So many rows tell enough."""


def is_uniform(time: Samples, rate_hz: float) -> bool:
    """Tell whether stamps (s) lie on a uniform clock.

    Examples
    --------
    >>> is_uniform(np.array([0.0, 0.01, 0.02]), 100.0), is_uniform(np.array([0.0, 0.013, 0.02]), 100.0)
    (True, False)
    """
    grid = time[0] + np.arange(len(time)) / rate_hz
    return bool(np.max(np.abs(time - grid)) * rate_hz < UNIFORM_TOLERANCE)


def is_even(time: Samples, position: RowSeries, rate_hz: float) -> bool:
    """Tell whether samples were taken evenly, whatever their stamps (s) show beside.

    Parameters
    ----------
    position
        Of the first samples, up to `ROWS`, without absurd ones; more of them are not looked at.

    Examples
    --------
    >>> even = np.arange(2000) / 250.0
    >>> late = even + 1e-3 * np.random.default_rng(1).random(2000)
    >>> is_even(late, np.sin(even)[:, None], 250.0), is_even(late, np.sin(late)[:, None], 250.0)
    (True, False)
    """
    if is_uniform(time, rate_hz):
        return True
    scatter, step = _scatter(time)
    if not _is_complete(scatter / step):
        return False
    first = position[:ROWS]
    share, deviation = _followed(first, scatter[: len(first)], step)
    return bool(share + DEVIATIONS * deviation < HALFWAY)


def _scatter(time: Samples) -> tuple[Vector, float]:
    """Give how far stamps lie from the nearest even clock, and its step."""
    number = np.arange(len(time)) - 0.5 * (len(time) - 1)
    step = float(number @ time / (number @ number)) if len(time) > 1 else 1.0
    return time - time.mean() - step * number, step


def _is_complete(scatter: Vector) -> bool:
    """Tell whether no row was left out, by how far the stamps lie from an even clock, in steps."""
    sums = np.concatenate([[0.0], np.cumsum(scatter)])
    means = (sums[WINDOW:] - sums[:-WINDOW]) / WINDOW
    shifts = np.abs(means[WINDOW:] - means[:-WINDOW])
    return bool(np.max(np.abs(scatter)) <= NEAR and np.max(shifts, initial=0.0) < SHIFT)


def _followed(position: RowSeries, scatter: Vector, step: float) -> tuple[float, float]:
    """Estimate the share of the stamps' scatter that positions follow, with its standard deviation."""
    together = power = 0.0
    for values in position.T:
        left = fourth_differences(values)
        wanted = fourth_differences(np.gradient(values) / step * scatter)
        spread = normal_spread(left)
        if spread > 0.0:
            together += float(np.clip(left / spread, -OUTLYING, OUTLYING) @ wanted) / spread
            power += float(wanted @ wanted) / spread**2
    # Fourth differences of noise resemble each other over five rows.
    return together / max(power, 1e-300), float(np.sqrt(len(FOURTH) / max(power, 1e-300)))
