"""Low-pass without delay: the zero-phase Butterworth filter as the symmetric kernel it is.

Running a Butterworth filter forwards and backwards multiplies the spectrum by |H|^2, which for the bilinear
design is 1 / (1 + (tan(w/2) / tan(wc/2))^(2 order)). Its impulse response decays exponentially, so cut where
it has fallen below rounding it gives a finite kernel that can be applied to any stretch of a long log by
itself; away from the ends it equals `scipy.signal.sosfiltfilt`. Source: Oppenheim & Schafer, Discrete-Time
Signal Processing, ch. 7.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import Samples, Vector
from ..errors import OptionError

HIGHEST_ORDER = 12
_FLOOR = 1e-14


def gain(frequency_hz: Vector, *, cutoff_hz: float, rate_hz: float, order: int) -> Vector:
    """Give the filter's gain; at the cut-off it is one half, since each of the two passes halves the power.

    Examples
    --------
    >>> gain(np.array([0.0, 10.0]), cutoff_hz=10.0, rate_hz=250.0, order=5)
    array([1. , 0.5])
    """
    half = np.pi / rate_hz
    with np.errstate(over="ignore"):
        return np.asarray(
            1.0 / (1.0 + (np.tan(half * frequency_hz) / np.tan(half * cutoff_hz)) ** (2 * order))
        )


@lru_cache(maxsize=64)
def kernel(cutoff_hz: float, rate_hz: float, order: int) -> Samples:
    """Give the symmetric impulse response, of odd length, cut where it has fallen to 1e-14 of its peak.

    Raises
    ------
    OptionError
        If the cut-off is not between zero and half the rate, or the order is not from 1 to 12.
    """
    if not 0.0 < cutoff_hz < 0.5 * rate_hz or not 1 <= order <= HIGHEST_ORDER:
        raise OptionError(
            "the low-pass filter cannot be built",
            evidence={"cutoff_hz": cutoff_hz, "nyquist_hz": 0.5 * rate_hz, "order": order},
            remedy="ask for a cut-off above 0 and below half the sampling rate, and an order from 1 to "
            f"{HIGHEST_ORDER}",
        )
    size = 1 << int(np.ceil(np.log2(max(64.0, 80.0 * order * rate_hz / cutoff_hz))))
    response = np.fft.irfft(
        gain(np.fft.rfftfreq(size, 1.0 / rate_hz), cutoff_hz=cutoff_hz, rate_hz=rate_hz, order=order)
    )
    half = response[: size // 2]
    reach = int(np.flatnonzero(np.abs(half) > _FLOOR * half[0])[-1])
    both = np.concatenate([half[reach:0:-1], half[: reach + 1]])
    both.setflags(write=False)
    return both


@dataclass(frozen=True, eq=False)
class Modes:
    """Give a symmetric kernel away from its middle as a sum of decays: h(n) = Re sum(weights poles^|n|)."""

    poles: np.ndarray
    """Complex, inside the unit circle; of conjugate ones that in the upper half."""
    weights: np.ndarray


@lru_cache(maxsize=64)
def modes(cutoff_hz: float, rate_hz: float, order: int) -> Modes:
    """Give the modes of the kernel: the residues at those poles of |H|^2 that decay.

    With s = (z - 1) / (z + 1) / tan(wc/2) it is 1 / (1 + (-s^2)^order), whose poles in s lie evenly on the
    unit circle.
    """
    wide = np.tan(np.pi * cutoff_hz / rate_hz)
    angles = np.pi * (0.5 + (2.0 * np.arange((order + 1) // 2) + 1.0) / (2.0 * order))
    analog = np.exp(1j * angles)
    poles = (1.0 + wide * analog) / (1.0 - wide * analog)
    weights = -analog * wide * (poles + 1.0) ** 2 / (4.0 * order * poles)
    return Modes(poles, weights * np.where(2 * np.arange(len(poles)) + 1 == order, 1.0, 2.0))


def reach_of(response: Samples, share: float) -> int:
    """Count the samples beyond which one side of a symmetric kernel holds less than a share of its mass.

    Examples
    --------
    >>> reach_of(np.array([0.25, 0.5, 0.25]), 0.1)
    1
    """
    half = np.abs(response[len(response) // 2 :])
    outside = np.cumsum(half[::-1])[::-1] / np.abs(response).sum()
    return int(np.flatnonzero(outside > share)[-1])
