"""Show a residual over frequency, with the noise floor beside it.

Structure that no listed coordinate shows may be a line or a peak; a residual at the floor in every band is
noise.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import JointSeries, Vector
from ...numerics.power_density import SHORTEST, power_density
from ..dataset.dataset import Dataset
from .floor import NoiseFloor, passed_power


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
        frequency, density = power_density([residual[run, joint] for run in runs], _rate(dataset, runs[0]))
        shape = passed_power(dataset, frequency)
        width = float(np.trapezoid(shape, frequency))
        level = floor.rms[joint] ** 2 / max(width, 1e-300)
        found.append(ResidualSpectrum(joint + 1, frequency, density, level * shape))
    return tuple(found)


def _runs(dataset: Dataset, joint: int) -> list[slice]:
    rows = np.flatnonzero(dataset.usable[:, joint])
    breaks = np.flatnonzero((np.diff(rows) != 1) | dataset.starts[rows[1:]]) + 1
    return [slice(int(part[0]), int(part[-1]) + 1) for part in np.split(rows, breaks) if len(part)]


def _rate(dataset: Dataset, run: slice) -> float:
    """Give the rate of the kept rows, Hz."""
    return float((run.stop - run.start - 1) / (dataset.time[run.stop - 1] - dataset.time[run.start]))
