"""Determine from the positions whether a motion repeats, and its period.

The part of the torque that a repeated motion does not repeat is noise, whatever the model. Only instants
count at which every joint has the same position and velocity as a period before.
"""

from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from ...arrays import JointMask, JointSeries, JointVector, Rows, Vector
from ...robot.joint_units import largest_of_kind, prismatic_joints
from ..dataset.dataset import Dataset
from ..dataset.stretch import Stretch
from ..thresholds.residual import FLOOR

NEWTON_STEPS = 5
_TAPS, _TAPS_OF_A_LOG = 24, 4
_LONGEST_LAG = 0.9
_WHOLE = 1e-6
_KAISER = 6.0


@dataclass(frozen=True, eq=False)
class Repeats:
    """Hold after how many rows (not a whole number in general) and seconds a motion repeats."""

    rows: float
    period: float


def repeats(dataset: Dataset) -> Repeats | None:
    """Find the shortest period of the longest stretch; None where the motion does not repeat."""
    stretch = max(dataset.stretches, key=lambda stretch: stretch.rows.stop - stretch.rows.start)
    position = dataset.state.position[stretch.rows]
    if len(position) < _TAPS_OF_A_LOG * _TAPS:
        return None
    step = float(np.mean(np.diff(dataset.time[stretch.rows])))
    moving = np.std(position, axis=0) > _least_swing(dataset, position)
    mismatch = _mismatch(position[:, moving])
    for valley in _minima(mismatch):
        lag = _refine_lag(
            position[:, moving], dataset.state.velocity[stretch.rows][:, moving] * step, float(valley)
        )
        found = Repeats(lag, lag * step)
        same = repeat_mask(dataset, stretch, found)
        if same.sum() * step >= FLOOR.repeat_seconds and same.mean() >= FLOOR.repeat_share:
            return found
    return None


def _least_swing(dataset: Dataset, series: JointSeries) -> JointVector:
    """Give, per joint, the swing below which it does not move: a share of the largest of its kind.

    It is infinite where all joints of a kind are held.
    """
    recipe = dataset.motions[0].recipe
    kinds = prismatic_joints(dataset.robot)
    fastest = largest_of_kind(recipe.rms_speed - recipe.still_speed, kinds)
    return np.where(fastest > 0.0, FLOOR.moving * largest_of_kind(np.std(series, axis=0), kinds), np.inf)


def repeat_mask(dataset: Dataset, stretch: Stretch, found: Repeats) -> np.ndarray:
    """Mark the instants of a stretch, from its first on, that the motion repeats a period later."""
    same = None
    for series in (dataset.state.position[stretch.rows], dataset.state.velocity[stretch.rows]):
        later = shift_rows(series, found.rows)
        swing = np.maximum(np.std(series, axis=0), _least_swing(dataset, series))
        near = np.all(np.abs(later - series[: len(later)]) <= FLOOR.same * swing, axis=1)
        same = near if same is None else same & near
    return np.zeros(0, dtype=bool) if same is None else same


def shift_rows(series: Rows, rows: float) -> Rows:
    """Give the series some rows later, whole or not, for as many rows as have a value.

    Between rows it is interpolated by a windowed sinc, which keeps the power of all that lies below the
    parallel filter's cut-off.

    Examples
    --------
    >>> shift_rows(np.arange(30.0)[:, None], 2.0)[:3, 0]
    array([2., 3., 4.])
    """
    whole = int(np.floor(rows))
    part = rows - whole
    if part < _WHOLE:
        return series[whole:]
    offsets = np.arange(1 - _TAPS // 2, _TAPS // 2 + 1)
    weights = np.sinc(offsets - part) * _kaiser((offsets - part) / (_TAPS / 2))
    weights /= weights.sum()
    padded = np.pad(series, ((max(0, _TAPS // 2 - 1 - whole), 0), (0, 0)), mode="edge")
    first = max(0, whole - _TAPS // 2 + 1)
    count = len(padded) - first - _TAPS + 1
    if count <= 0:
        return series[:0]
    windows = np.lib.stride_tricks.sliding_window_view(padded[first:], _TAPS, axis=0)[:count]
    return np.asarray(windows @ weights)


def clear_pairs(dataset: Dataset, stretch: Stretch, found: Repeats, rows: int) -> JointMask:
    """Mark, for the first rows of a stretch, where row and repeat are clear of reversals and ends."""
    clear = dataset.clear[stretch.rows]
    later = int(np.floor(found.rows))
    ceiling = min(later + 1, len(clear))
    second = np.pad(clear[ceiling:], ((0, 1), (0, 0)))[:rows]
    return np.asarray(clear[:rows] & clear[later : later + rows] & second)


def _kaiser(offset: Vector) -> Vector:
    inside = np.clip(1.0 - offset**2, 0.0, None)
    return np.asarray(np.i0(_KAISER * np.sqrt(inside)) / np.i0(_KAISER))


def _mismatch(position: JointSeries) -> Vector:
    """Give, per lag, the mean squared change over twice the variance, over all joints: 0 for a repeat."""
    count = len(position)
    centred = (position - position.mean(axis=0)) / np.std(position, axis=0)
    size = next_fast_len(2 * count, real=True)
    product = irfft(np.abs(rfft(centred, size, axis=0)) ** 2, size, axis=0)[:count]
    squares = np.cumsum(np.pad(centred**2, ((1, 0), (0, 0))), axis=0)
    lags = np.arange(count)
    both = squares[count - lags] + squares[count] - squares[lags]
    return np.asarray(np.mean(both - 2.0 * product, axis=1) / (2.0 * (count - lags)))


def _minima(mismatch: Vector) -> list[int]:
    """List the lags of low minima beyond the first rise, shortest first."""
    last = int(FLOOR.longest_lag * len(mismatch))
    risen = np.flatnonzero(mismatch[:last] > FLOOR.valley)
    if not len(risen):
        return []
    inner = np.arange(max(int(risen[0]), 1), last - 1)
    here, left, right = mismatch[inner], mismatch[inner - 1], mismatch[inner + 1]
    low = (here < left) & (here <= right) & (here < FLOOR.valley)
    return [int(lag) for lag in inner[low]]


def _refine_lag(position: JointSeries, slope: JointSeries, lag: float) -> float:
    """Refine a lag between the rows by Newton steps on the half of the instants that match best.

    A motion that starts from rest does not repeat during its start; that half is left out.
    """
    last = _LONGEST_LAG * (len(position) - 1)
    scale = np.std(position, axis=0)
    for _ in range(NEWTON_STEPS):
        later = shift_rows(position, lag)
        missed = (later - position[: len(later)]) / scale
        size = np.sum(missed**2, axis=1)
        better = size <= np.median(size)
        along = slope[: len(missed)][better] / scale
        lag -= float(np.sum(missed[better] * along) / max(np.sum(along**2), 1e-300))
        lag = float(np.clip(lag, 1.0, last))
    return lag
