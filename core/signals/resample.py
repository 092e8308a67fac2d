"""Bring stamped samples onto one clock: real stamps are used, uniform ones are left exactly as they are.

Between stamps positions follow a cubic spline and torques a straight line: positions are smooth and will be
differentiated twice, torques carry noise that a spline would amplify. A few rows that repeat the row before
are dropped samples and are left out; many of them are a robot that stands still. Absurd positions are
replaced before a spline is laid through them: it would spread one of them over its neighbours, and none would
look absurd any more.
"""

from typing import NamedTuple

import numpy as np

from ..arrays import Beside, Instants, InstantSeries, JointSeries, JointVector, SampleMask, Samples
from ..log.model import STANDING_ROWS, LogRows, repeated_rows, rows_at
from ..numerics.marked_runs import marked_runs
from .clock import is_even
from .derivative import absurd_reach, continued, median, without_absurd

MEDIAN_ORDER = 5
"""Of the median from which a spike's distance is measured, as when the log's spikes were found."""


class Readings(NamedTuple):
    """Hold positions and efforts on an even clock."""

    position: JointSeries
    effort: JointSeries
    unknown: SampleMask
    """Instants at which nothing was measured for long."""
    stamps: Samples | None
    """The stamps of the samples between which they were interpolated; None where they are as measured."""


def uniform_positions(rows: LogRows, rate_hz: float, median_order: int) -> JointSeries:
    """Give the positions on a uniform clock that starts at the first stamp, without absurd samples."""
    plausible = without_spikes(rows.position, median_order)
    even = is_even(rows.time, plausible, rate_hz)
    if even and not dropped_mask(rows).any():
        return plausible
    count = int((rows.time[-1] - rows.time[0]) * rate_hz + 1e-6) + 1
    grid = rows.time if even else rows.time[0] + np.arange(count) / rate_hz
    return positions_on(grid, rows, median_order)


def positions_on(grid: Instants, rows: LogRows, median_order: int) -> InstantSeries:
    """Interpolate the positions, without absurd samples, at instants inside the rows' time span."""
    from scipy.interpolate import CubicSpline  # takes as long to load as NumPy, and even stamps need none

    fresh = ~dropped_mask(rows)
    time, position = rows.time[fresh], without_spikes(rows.position[fresh], median_order)
    if len(time) < 4:
        return linear(grid, time, position)
    return np.asarray(CubicSpline(time, position, axis=0)(grid))


def efforts_on(grid: Instants, rows: LogRows, limits: JointVector) -> InstantSeries:
    """Interpolate torques (or currents), without spikes, at instants inside the rows' time span."""
    fresh = ~dropped_mask(rows)
    return linear(grid, rows.time[fresh], plausible_effort(rows_at(rows, fresh), limits))


def plausible_effort(rows: LogRows, limits: JointVector) -> JointSeries:
    """Put medians of five samples in the place of efforts that lie further from these than their limit."""
    effort = effort_of(rows)
    if not np.isfinite(limits).any() or len(effort) < MEDIAN_ORDER:
        return effort
    medians = median(continued(effort, MEDIAN_ORDER // 2), MEDIAN_ORDER)
    return np.asarray(np.where(np.abs(effort - medians) > limits, medians, effort))


def effort_of(rows: LogRows) -> JointSeries:
    """Give the torques, else the currents, else zeros."""
    effort = rows.torque if rows.torque is not None else rows.current
    return np.zeros_like(rows.position) if effort is None else effort


def without_spikes(position: JointSeries, median_order: int) -> JointSeries:
    """Replace the absurd samples of a whole stretch, which is continued beyond its ends to judge these."""
    return without_absurd(continued(position, absurd_reach(median_order)), median_order)


def beside(grid: Samples, stamps: Instants, velocity: JointSeries) -> tuple[Beside, Samples]:
    """Give the velocities at the stamps before and behind each instant of a grid.

    The share says how far the instant lies from the first to the second.
    """
    at = linear(stamps, grid, velocity)
    after = np.clip(np.searchsorted(stamps, grid), 1, len(stamps) - 1)
    share = (grid - stamps[after - 1]) / (stamps[after] - stamps[after - 1])
    return np.stack([at[after - 1], at[after]], axis=-1), np.clip(share, 0.0, 1.0)


def linear(grid: Instants, time: Samples, values: JointSeries) -> InstantSeries:
    """Interpolate every column on a straight line at the instants of a grid."""
    return np.column_stack([np.interp(grid, time, column) for column in values.T])


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
    for start, stop in marked_runs(repeats).tolist():
        if stop - start > STANDING_ROWS:
            repeats[start:stop] = False
    repeats[-1] = False
    return repeats
