"""Show a residual over frequency, with the noise floor beside it.

Structure that no listed coordinate shows may be a line or a peak; a residual at the floor in every band is
noise. Source: Welch, IEEE Trans. Audio Electroacoust. 15(2), 1967.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import welch

from ...arrays import JointSeries, Vector
from ..dataset.dataset import Dataset
from .floor import NoiseFloor, passed_power

LONGEST = 256
SHORTEST = 32
"""Runs of fewer usable rows say nothing about frequency."""


@dataclass(frozen=True, eq=False)
class ResidualSpectrum:
    """Hold one joint's power density and the floor's, (N m)^2/Hz (N^2/Hz), over frequency in Hz.

    `joint` counts from 1. The floor is shaped by the parallel filter as white noise would be.
    """

    joint: int
    frequency_hz: Vector
    density: Vector
    floor: Vector


def residual_spectra(
    dataset: Dataset, residual: JointSeries, floor: NoiseFloor
) -> tuple[ResidualSpectrum, ...]:
    """Estimate densities by Welch's method over runs of usable rows; a joint without any is left out."""
    found = []
    for joint in range(dataset.joints):
        runs = [run for run in _runs(dataset, joint) if run.stop - run.start >= SHORTEST]
        if not runs:
            continue
        size = min(LONGEST, max(run.stop - run.start for run in runs))
        frequency, density = _welch([residual[run, joint] for run in runs], _rate(dataset, runs[0]), size)
        shape = passed_power(dataset, frequency)
        width = float(np.trapezoid(shape, frequency))
        level = floor.rms[joint] ** 2 / max(width, 1e-300)
        found.append(ResidualSpectrum(joint + 1, frequency, density, level * shape))
    return tuple(found)


def _welch(runs: Sequence[np.ndarray], rate_hz: float, size: int) -> tuple[Vector, Vector]:
    """Average the runs' densities, each weighted by its rows; shorter runs are padded with zeros."""
    total, rows = np.zeros(size // 2 + 1), 0
    frequency = np.fft.rfftfreq(size, 1.0 / rate_hz)
    for run in runs:
        length = min(size, len(run))
        _, density = welch(run, rate_hz, nperseg=length, nfft=size, detrend=False)
        total, rows = total + len(run) * density, rows + len(run)
    return frequency, np.asarray(total / rows)


def _runs(dataset: Dataset, joint: int) -> list[slice]:
    rows = np.flatnonzero(dataset.usable[:, joint])
    breaks = np.flatnonzero((np.diff(rows) != 1) | dataset.starts[rows[1:]]) + 1
    return [slice(int(part[0]), int(part[-1]) + 1) for part in np.split(rows, breaks) if len(part)]


def _rate(dataset: Dataset, run: slice) -> float:
    """Give the rate of the kept rows, Hz."""
    return float((run.stop - run.start - 1) / (dataset.time[run.stop - 1] - dataset.time[run.start]))
