"""Estimate the noise floor of a residual, without a model.

Where the motion repeats, the part of the residual that does not repeat is noise: a model's error is a
function of the motion and cancels between repeats. Otherwise the torque above the bands of the motion and the
parallel filter is noise, and its power density is assumed to be the same within the data set's band. The
floor is then too low for noise that grows towards low frequencies, which its `tilt` over the high band shows.
Source: Schoukens & Pintelon, System Identification (2012), ch. 2 (periodic excitation).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.signal import detrend, welch

from ...arrays import JointSeries, JointVector, Vector
from ...signals.zero_phase import gain
from ..dataset.dataset import Dataset
from ..thresholds.residual import FLOOR
from .period import Repeats, clear_pairs, repeat_mask, repeats, shift_rows

FloorSource = Literal["repeats", "high_band", "none"]
WINDOW_SECONDS = 0.5
_BELOW_NYQUIST, _POINTS = 0.499, 4096


@dataclass(frozen=True, eq=False)
class NoiseFloor:
    """Hold the noise per joint in the data set's band, N m (N) RMS."""

    rms: JointVector
    source: tuple[FloorSource, ...]
    """The value to use and its method: repeats before the high band; NaN and ``none`` where neither
    applies."""
    tilt: JointVector
    """Power density of the high band's lower half over its upper half: 1 for white noise, above where noise
    grows towards low frequencies, NaN where there is no high band."""
    period: float | None
    """Period of the motion, s; None where it does not repeat."""


def noise_floor(dataset: Dataset, residual: JointSeries) -> NoiseFloor:
    """Estimate the noise in a data set's band from repeats of the motion and from the torque's high band.

    Parameters
    ----------
    residual
        Measured minus predicted torque at the data set's rows, N m or N; only its differences between repeats
        count, so it may come from any model, or be the torque itself.
    """
    high, tilt = _from_high_band(dataset)
    found = repeats(dataset)
    repeated = np.full(dataset.joints, np.nan) if found is None else _from_repeats(dataset, residual, found)
    use = np.isfinite(repeated)
    source: tuple[FloorSource, ...] = tuple(
        "repeats" if repeat else ("high_band" if np.isfinite(density) else "none")
        for repeat, density in zip(use, high, strict=True)
    )
    return NoiseFloor(
        rms=np.where(use, repeated, high),
        source=source,
        tilt=tilt,
        period=None if found is None else found.period,
    )


def passed_power(dataset: Dataset, frequency_hz: Vector) -> Vector:
    """Give the share of white noise's power that the parallel filter passes at some frequencies."""
    motion = dataset.motions[0]
    below = np.clip(frequency_hz, 0.0, _BELOW_NYQUIST * motion.log.rate_hz)
    recipe = motion.recipe
    return gain(below, cutoff_hz=recipe.cutoff_hz, rate_hz=motion.log.rate_hz, order=recipe.order) ** 2


def _from_high_band(dataset: Dataset) -> tuple[JointVector, JointVector]:
    """Give RMS in the data set's band and tilt per joint, from medians over windows, robust to reversals."""
    low, high, rows = np.zeros(dataset.joints), np.zeros(dataset.joints), 0
    for motion in dataset.motions:
        for segment in motion.segments:
            last = min(segment.kept, int(FLOOR.segment_seconds * segment.rate_hz / motion.recipe.decimation))
            torque = segment.tile(motion.effort_scale, slice(0, last)).torque
            density = _bands(torque, segment.rate_hz, motion.recipe.cutoff_hz)
            if density is not None:
                low, high = low + len(torque) * density[0], high + len(torque) * density[1]
                rows += len(torque)
    if not rows:
        return np.full(dataset.joints, np.nan), np.full(dataset.joints, np.nan)
    low, high = low / rows, high / rows
    grid = np.linspace(0.0, _BELOW_NYQUIST * dataset.motions[0].log.rate_hz, _POINTS)
    width = float(np.trapezoid(passed_power(dataset, grid), grid))
    tilt = np.divide(low, high, out=np.full(dataset.joints, np.nan), where=high > 0.0)
    return np.sqrt(0.5 * (low + high) * width), tilt


def _bands(torque: JointSeries, rate_hz: float, cutoff_hz: float) -> tuple[JointVector, JointVector] | None:
    """Give the mean power density of the high band's lower and upper half per joint."""
    size = int(WINDOW_SECONDS * rate_hz)
    begin, end = FLOOR.over_band * cutoff_hz, FLOOR.end * rate_hz
    if len(torque) < FLOOR.windows * size or begin >= FLOOR.least_width * end:
        return None
    frequency, density = welch(torque.T, rate_hz, nperseg=size, detrend=detrend, average="median")
    middle = 0.5 * (begin + end)
    lower = (frequency >= begin) & (frequency < middle)
    upper = (frequency >= middle) & (frequency <= end)
    # The median over frequencies too: hum is a line, not a floor.
    return np.median(density[:, lower], axis=1), np.median(density[:, upper], axis=1)


def _from_repeats(dataset: Dataset, residual: JointSeries, found: Repeats) -> JointVector:
    total, count = np.zeros(dataset.joints), np.zeros(dataset.joints)
    for stretch in dataset.stretches:
        later = shift_rows(residual[stretch.rows], found.rows)
        same = repeat_mask(dataset, stretch, found)
        both = clear_pairs(dataset, stretch, found, len(later)) & same[:, None]
        difference = later - residual[stretch.rows][: len(later)]
        total += np.sum(np.where(both, difference**2, 0.0), axis=0)
        count += both.sum(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count >= FLOOR.least_pairs, np.sqrt(0.5 * total / count), np.nan)
