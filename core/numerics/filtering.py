"""Filter series and estimate their spectra by `scipy.signal`, which the first call loads.

With all that it loads in its turn it takes as long as NumPy, numba and linear algebra together, and a process
that computes nothing needs none of it.
"""

from typing import Literal

import numpy as np

from ..arrays import Matrix, Samples, Vector


def convolved(series: np.ndarray, response: Samples) -> np.ndarray:
    """Convolve series, along their first axis, with a response; as many samples less one as it has go."""
    from scipy.signal import oaconvolve

    return np.asarray(oaconvolve(series, response[:, None], mode="valid", axes=0))


def running_maximum(values: np.ndarray, reach: int) -> np.ndarray:
    """Give the largest of so many values on either side, along the first axis; beyond the ends lie zeros."""
    from scipy.ndimage import maximum_filter1d

    return np.asarray(maximum_filter1d(values, 2 * reach + 1, axis=0, mode="constant"))


def butterworth(order: int, cutoff_hz: float, rate_hz: float) -> Matrix:
    """Design a low-pass as sections of second order."""
    from scipy.signal import butter

    return np.asarray(butter(order, cutoff_hz, fs=rate_hz, output="sos"))


def forth_and_back(sections: Matrix, series: np.ndarray) -> np.ndarray:
    """Filter series, along their first axis, forwards and backwards: without delay."""
    from scipy.signal import sosfiltfilt

    return np.asarray(sosfiltfilt(sections, series, axis=0))


def amplitude_gain(sections: Matrix, frequency_hz: Vector, rate_hz: float) -> Vector:
    """Give the factor by which a filter multiplies the amplitude of some frequencies."""
    from scipy.signal import sosfreqz

    return np.asarray(np.abs(sosfreqz(sections, frequency_hz, fs=rate_hz)[1]))


def welch_density(
    series: np.ndarray, rate_hz: float, size: int, *, detrend: Literal["constant", False] = False
) -> tuple[Vector, np.ndarray]:
    """Give frequencies, Hz, and the power density of series, along their first axis, by Welch's method."""
    from scipy.signal import welch

    frequency, density = welch(series, rate_hz, nperseg=size, axis=0, detrend=detrend)
    return np.asarray(frequency), np.asarray(density)
