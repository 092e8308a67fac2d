"""Take a first look at a log's positions: every joint's band, speed and whether it moves at all."""

from dataclasses import dataclass

import numpy as np

from ..arrays import JointSeries, JointVector, Mask, Matrix, Vector
from ..log.model import JointLog
from ..numerics.filtering import amplitude_gain, butterworth, forth_and_back, welch_density
from .derivative import differentiate_throughout
from .noise_band import noise_floor
from .resample import uniform_positions
from .white_noise import white_noise

MOTION_SHARE = 0.995
"""Share of a joint's velocity power that its motion band holds."""
LEAST_NOISE = 0.1 * (1.0 - MOTION_SHARE)
"""Share of the power that noise has to hold to be subtracted: less hardly widens the band. Set by hand."""
ABOVE_NOISE = 4.0
"""Ratio of a frequency's power to that of noise from which it holds motion: with less, what is left of noise
adds up over all frequencies. Estimates of a spectrum scatter by less than this. Set by hand."""
NOISY_SHARE = 0.4
"""Noise alone has half of its velocity's power above this share of the survey's low-pass."""
_SURVEY_SECONDS = 60.0
_SURVEY_ROWS = 1000
"""At least so many rows: stamps in another unit make a second of few."""
_SURVEYS = 8


@dataclass(frozen=True, eq=False)
class Survey:
    """Hold what a first look at a log shows."""

    bands: JointVector
    """Band of every joint's velocity, Hz."""
    speeds: JointVector
    """RMS speed of every joint (rad/s or m/s)."""
    noisy: Mask
    """Joints whose velocity is noise only."""
    noise: JointVector
    """RMS of the white noise of every joint's positions (rad or m)."""
    positions: list[JointSeries]
    """The windows' positions on a uniform clock."""
    slowest: float
    """Mean rate (Hz) of the slowest window: rows that were never recorded make it less than the log's."""


def survey_of(log: JointLog, median_order: int) -> Survey:
    """Read band and speed of every joint from up to eight windows of the longest segment."""
    start, stop = max(log.segments, key=lambda segment: segment[1] - segment[0])
    length = min(stop - start, max(int(_SURVEY_SECONDS * log.rate_hz), _SURVEY_ROWS))
    count = min(_SURVEYS, max(1, (stop - start) // length))
    firsts = np.linspace(start, stop - length, count).astype(int)
    read = [log.source.rows(int(first), int(first) + length) for first in firsts]
    slowest = min((length - 1) / float(rows.time[-1] - rows.time[0]) for rows in read)
    resampled = [uniform_positions(rows, log.rate_hz, median_order) for rows in read]
    shortest = min(map(len, resampled))  # where stamps scatter, windows of as many rows last differently
    positions = [position[:shortest] for position in resampled]
    velocities = [_velocity(position, log.rate_hz) for position in positions]
    speeds = np.sqrt(np.mean([np.mean(velocity**2, axis=0) for velocity in velocities], axis=0))
    power = np.mean([_power(velocity, log.rate_hz) for velocity in velocities], axis=0)
    frequency = np.fft.rfftfreq(2 * (power.shape[0] - 1), 1.0 / log.rate_hz)
    bands, middles = (_band(frequency, power, share) for share in (MOTION_SHARE, 0.5))
    noisy = middles > NOISY_SHARE * _low_pass_hz(log.rate_hz)
    if not noisy.all():
        noise = _noise_power(positions, frequency, log.rate_hz, float(bands[~noisy].max()))
        noise *= noise.sum(axis=0) > LEAST_NOISE * power.sum(axis=0)
        bands = _band(frequency, np.where(power > ABOVE_NOISE * noise, power - noise, 0.0), MOTION_SHARE)
    white = np.sqrt(np.mean([white_noise(position) ** 2 for position in positions], axis=0))
    return Survey(bands, speeds, noisy, white, positions, slowest)


def _noise_power(
    positions: list[JointSeries], frequency: Vector, rate_hz: float, band_hz: float
) -> np.ndarray:
    """Give the power density of the noise of velocities, whose positions' density is that above a band."""
    density = np.mean([noise_floor(position, rate_hz, band_hz) for position in positions], axis=0)
    passed = amplitude_gain(_low_pass(rate_hz), frequency, rate_hz) ** 4
    return np.asarray(np.outer((2.0 * np.pi * frequency) ** 2 * passed, density))


def _band(frequency: Vector, power: np.ndarray, share: float) -> JointVector:
    """Give the frequency (Hz) below which a share of each joint's power lies."""
    held = np.cumsum(power, axis=0)
    return np.array([frequency[np.argmax(total >= share * total.max())] for total in held.T])


def _low_pass(rate_hz: float) -> Matrix:
    return butterworth(2, _low_pass_hz(rate_hz), rate_hz)


def _low_pass_hz(rate_hz: float) -> float:
    return min(0.2 * rate_hz, 40.0)


def _velocity(position: JointSeries, rate_hz: float) -> JointSeries:
    smooth = forth_and_back(_low_pass(rate_hz), position)
    return differentiate_throughout(smooth, rate_hz)


def _power(velocity: JointSeries, rate_hz: float) -> np.ndarray:
    size = min(len(velocity), max(64, int(8.0 * rate_hz)))
    _, power = welch_density(velocity, rate_hz, 2 * (size // 2))
    floor = np.median(power[int(0.7 * len(power)) :], axis=0)
    return np.asarray(np.maximum(power - floor, 0.0))
