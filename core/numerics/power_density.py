"""Estimate a power density from several runs of samples.

Source: Welch, IEEE Trans. Audio Electroacoust. 15(2), 1967.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Vector

LONGEST = 256
"""Rows of one transform: more resolve finer, fewer are averaged more."""
SHORTEST = 32
"""Shorter runs say nothing about frequency."""


def power_density(runs: Sequence[np.ndarray], rate_hz: float) -> tuple[Vector, Vector]:
    """Give frequencies, Hz, and the mean of the runs' densities; both empty where no run is long enough.

    Each run is weighted by its rows; those below the length of the transform are padded with zeros.
    """
    from scipy.signal import welch

    long = [run for run in runs if len(run) >= SHORTEST]
    if not long:
        return np.zeros(0), np.zeros(0)
    size = min(LONGEST, max(map(len, long)))
    total, rows = np.zeros(size // 2 + 1), 0
    for run in long:
        _, density = welch(run, rate_hz, nperseg=min(size, len(run)), nfft=size, detrend=False)
        total, rows = total + len(run) * density, rows + len(run)
    return np.fft.rfftfreq(size, 1.0 / rate_hz), np.asarray(total / rows)
