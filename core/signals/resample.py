"""Bring stamped samples onto one clock: real stamps are honoured, uniform ones are left exactly as they are.

Between stamps positions follow a cubic spline and torques a straight line: positions are smooth and will be
differentiated twice, torques carry noise that a spline would amplify. A few rows that repeat the row before
are dropped samples and are left out; many of them are a robot that stands still.
"""

import numpy as np
from scipy.interpolate import CubicSpline

from ..arrays import Instants, InstantSeries, JointSeries, SampleMask, Samples
from ..log.model import STANDING_ROWS, LogRows, repeated_rows

UNIFORM_TOLERANCE = 1e-3
"""Stamps that deviate from a uniform clock by less than a thousandth of a step are uniform."""


def is_uniform(time: Samples, rate_hz: float) -> bool:
    """Tell whether stamps (s) lie on a uniform clock.

    Examples
    --------
    >>> is_uniform(np.array([0.0, 0.01, 0.02]), 100.0), is_uniform(np.array([0.0, 0.013, 0.02]), 100.0)
    (True, False)
    """
    grid = time[0] + np.arange(len(time)) / rate_hz
    return bool(np.max(np.abs(time - grid)) * rate_hz < UNIFORM_TOLERANCE)


def uniform(rows: LogRows, rate_hz: float) -> tuple[Samples, JointSeries, JointSeries]:
    """Give time, position and torque (or current) on a uniform clock that starts at the first stamp."""
    effort = rows.torque if rows.torque is not None else rows.current
    if effort is None:
        effort = np.zeros_like(rows.position)
    even = is_uniform(rows.time, rate_hz)
    if even and not dropped_mask(rows).any():
        return rows.time, rows.position, effort
    count = int((rows.time[-1] - rows.time[0]) * rate_hz + 1e-6) + 1
    grid = rows.time if even else rows.time[0] + np.arange(count) / rate_hz
    return grid, *on_grid(rows, effort, grid)


def on_grid(rows: LogRows, effort: JointSeries, grid: Instants) -> tuple[InstantSeries, InstantSeries]:
    """Interpolate position and effort at the instants of a grid inside the rows' time span."""
    fresh = ~dropped_mask(rows)
    time = rows.time[fresh]
    torque = np.column_stack([np.interp(grid, time, column) for column in effort[fresh].T])
    if len(time) < 4:
        return np.column_stack([np.interp(grid, time, column) for column in rows.position[fresh].T]), torque
    return np.asarray(CubicSpline(time, rows.position[fresh], axis=0)(grid)), torque


def gap_mask(rows: LogRows, grid: Instants, longest: float) -> SampleMask:
    """Mark the instants of a grid that lie where nothing was measured for longer than so many seconds.

    There interpolation only guesses at what moved meanwhile.
    """
    fresh = rows.time[~dropped_mask(rows)]
    after = np.clip(np.searchsorted(fresh, grid), 1, len(fresh) - 1)
    return np.asarray(fresh[after] - fresh[after - 1] > longest)


def dropped_mask(rows: LogRows) -> SampleMask:
    """Mark the repeats that stand for dropped samples; never the last row, beyond which nothing is known."""
    repeats = repeated_rows(rows)
    starts = np.flatnonzero(np.diff(repeats, prepend=False) & repeats)
    stops = np.flatnonzero(np.diff(repeats, append=False) & repeats) + 1
    for start, stop in zip(starts, stops, strict=True):
        if stop - start > STANDING_ROWS:
            repeats[start:stop] = False
    repeats[-1] = False
    return repeats
