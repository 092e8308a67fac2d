"""Bound the band by the noise of positions, as errors in variables.

Noise of a position grows with the square of frequency on its way to an acceleration. There it weakens
what a fit finds, by its power over the power of that part of the acceleration which positions, speeds and
the other accelerations do not tell. In a pendulum that swings freely this part is small, because its
acceleration follows from its angle. Source: Fuller, Measurement Error Models (1987), ch. 1; Frisch &
Waugh (1933) for the part.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import JointSeries, JointVector, Mask, Matrix
from ..numerics.filtering import butterworth, forth_and_back, welch_density
from .derivative import differentiate

ATTENUATION = 1e-3
"""Share of an acceleration's own part that noise may have in the band of noisy positions. Source: simulated
robots, on which least squares and instrumental variables are equally good up to 3e-4 and differ fourfold
at 9e-3."""
OUTWEIGHED = 1.0
"""Positions are noisy where noise within the band that the motion asks for has more power than that part.
Where it has less, a narrower band loses as much as it gains: on a measured arm at 0.3, 5 % of the held-
out error."""
OWN_PART = 0.01
"""An acceleration follows from positions and speeds if less than this share of its power is its own: a motion
of a few sines. Noise then turns what no fit separates, and predictions of such motion stay as they are."""
SPECTRUM_OVER_RATE = 0.2
"""Spectra are read up to this share of the rate, where derivatives lack 3 % at most."""
BINS_PER_OCTAVE = 3
OVER_BAND = 2.0
"""The motion's acceleration is regressed within twice its band."""
_ROWS_PER_COLUMN = 4
_SECONDS = 8.0


def noise_cutoff(windows: Sequence[JointSeries], rate_hz: float, band_hz: float, moving: Mask) -> float:
    """Give the frequency (Hz) up to which noise attenuates no joint by more than `ATTENUATION`.

    Infinite where no bound is known: the motion tells its accelerations by itself, or the log is short.

    Parameters
    ----------
    windows
        Stretches of positions on a uniform clock, samples x joints.
    band_hz, moving
        The motion's band, and which joints move.
    """
    own = np.mean([own_acceleration(window, rate_hz, band_hz) for window in windows], axis=0)
    floor = np.mean([noise_floor(window, rate_hz, band_hz) for window in windows], axis=0)
    known = moving & (own > 0.0) & (floor > 0.0)
    if not known.any():
        return np.inf
    # The integral of (2 pi f)^4 times the floor, up to f, is the share's power.
    allowed = ATTENUATION * own[known] / (floor[known] * (2.0 * np.pi) ** 4 / 5.0)
    return float(np.min(allowed**0.2))


def noise_floor(position: JointSeries, rate_hz: float, band_hz: float) -> JointVector:
    """Give the power density of a position's noise, rad2/Hz (m2/Hz): where the acceleration's is least.

    From there the motion's own density rises downwards, and the noise's upwards.

    Notes
    -----
    A joint that sticks at its reversals starts with a step of acceleration, whose density does not rise with
    frequency. Where it does not rise at least in proportion up to the highest frequency that is read, what is
    least is still motion, and the noise is not above the density at that highest frequency.
    """
    velocity = differentiate(position, rate_hz)
    size = 2 * (min(len(velocity), max(64, int(_SECONDS * rate_hz))) // 2)
    frequency, power = welch_density(velocity, rate_hz, size)
    highest = SPECTRUM_OVER_RATE * rate_hz
    count = max(1, int(BINS_PER_OCTAVE * np.log2(max(highest / band_hz, 1.0))))
    edges = highest * 2.0 ** (-np.arange(count, -1.0, -1.0) / BINS_PER_OCTAVE)
    bins = np.digitize(frequency, edges)
    turns, speeds = list[float](), list[JointVector]()
    for number in range(1, len(edges)):
        inside = bins == number
        if inside.any():
            speeds.append(np.median(power[inside], axis=0))
            turns.append(2.0 * np.pi * float(np.mean(frequency[inside])))
    if not speeds:
        return np.zeros(position.shape[1])
    density, turn = np.array(speeds), np.array(turns)
    least, joints = np.argmin(density * turn[:, None] ** 2, axis=0), np.arange(position.shape[1])
    rises = density[-1] * turn[-1] >= density[least, joints] * turn[least]
    place = np.where(rises, least, len(turn) - 1)
    return np.asarray(density[place, joints] / turn[place] ** 2)


def own_acceleration(position: JointSeries, rate_hz: float, band_hz: float) -> JointVector:
    """Give the power of the part of every acceleration that nothing else in the motion tells.

    Zero where positions and speeds leave less than `OWN_PART` of it, or there are too few rows to say.
    """
    low = butterworth(4, min(OVER_BAND * band_hz, SPECTRUM_OVER_RATE * rate_hz), rate_hz)
    edge, thin = int(rate_hz / band_hz), max(1, int(rate_hz / (4.0 * OVER_BAND * band_hz)))
    joints = position.shape[1]
    if len(position) < 2 * edge + thin * _ROWS_PER_COLUMN * (1 + 4 * joints) + 32:
        return np.zeros(joints)
    smooth = forth_and_back(low, position)
    velocity = differentiate(smooth, rate_hz)
    acceleration = differentiate(velocity, rate_hz)[edge : -edge or None : thin]
    place, speed = smooth[6:-6][edge : -edge or None : thin], velocity[3:-3][edge : -edge or None : thin]
    columns = np.hstack([np.ones((len(place), 1)), place, np.sin(place), np.cos(place), speed])
    whole, left = np.var(acceleration, axis=0), _left(acceleration, columns)
    own = [np.mean(_left(left[:, [joint]], np.delete(left, joint, axis=1)) ** 2) for joint in range(joints)]
    return np.asarray(np.where(np.mean(left**2, axis=0) < OWN_PART * whole, 0.0, own))


def _left(values: JointSeries, columns: Matrix) -> JointSeries:
    """Give what columns do not tell of some values."""
    scaled = columns / np.maximum(np.linalg.norm(columns, axis=0), np.finfo(float).tiny)
    return np.asarray(values - scaled @ np.linalg.lstsq(scaled, values, rcond=1e-10)[0])
