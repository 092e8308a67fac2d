"""Average a residual over every coordinate of the motion, with errors that include its autocorrelation.

The residual depends on a coordinate where bin means differ by many standard errors. A chi-square over all
bins, with their covariance under autocorrelated noise, gives the p-value. The fit has made the averages
smaller than noise would, so the p-values are cautious. The noise is estimated again from the deviations from
the bin means; otherwise an effect would count as noise. Over time and temperature every bin is visited once
and would absorb slow noise. There the noise of the fit is used, which may include a slow drift.
Source: Percival & Walden, Spectral Analysis (1993), ch. 6 and 8.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ...arrays import Indices, JointSeries, SquareMatrix, Vector, Weights
from ...dynamics.prediction import Prediction
from ...numerics.distributions import chi2_tail
from ..dataset.dataset import Dataset
from ..regression.ar_noise import ARNoise, fit_ar_noise, run_indices
from .coordinates import coordinate, coordinate_names
from .floor import NoiseFloor, noise_floor
from .memory import covariance_of_sums
from .spectrum import ResidualSpectrum, residual_spectra

BINS = 30
FEWEST_IN_BIN = 8
"""Rows of a bin at least: with fewer rows there are fewer bins."""
VISITED_ONCE = ("time", "temperature")
_RIDGE = 1e-9


@dataclass(frozen=True, eq=False)
class Dependence:
    """Show how one joint's residual depends on one coordinate."""

    coordinate: str
    joint: int
    unit: str
    """The coordinate, the joint (from 1) whose residual it is, and the coordinate's unit."""
    centre: Vector
    mean: Vector
    standard_error: Vector
    count: Indices
    """Per bin: median of the coordinate, mean residual and its standard error (N m or N), rows."""
    statistic: float
    degrees_of_freedom: int
    p_value: float
    """Chi-square of the bins' means about their common value, with its p-value."""


@dataclass(frozen=True, eq=False)
class Atlas:
    """Hold a residual over every coordinate and over frequency, and the noise floor below it."""

    dependences: tuple[Dependence, ...]
    spectra: tuple[ResidualSpectrum, ...]
    floor: NoiseFloor


def atlas(
    dataset: Dataset, residual: JointSeries, operating_point: Prediction, noise: Sequence[ARNoise]
) -> Atlas:
    """Show a residual over time, angle, speed, load, travel, temperature, the other joints and frequency.

    Rows next to reversals are left out: there a measured velocity's sign is not the direction of friction.

    Parameters
    ----------
    residual
        Measured minus predicted torque at the data set's rows, N m or N.
    noise
        Noise model per joint, estimated from the fitted rows; used over time and temperature.
    """
    begins = np.flatnonzero(dataset.starts)
    found = []
    for name in coordinate_names(dataset):
        for joint in range(1, dataset.joints + 1):
            along = coordinate(dataset, operating_point, name, joint)
            if along is None:
                continue
            label = _bins(along.values, dataset.clear[:, joint - 1])
            if label.max(initial=-1) >= 1:
                binned = _Binned(along.values, residual[:, joint - 1], label, begins)
                own = noise[joint - 1] if name in VISITED_ONCE else _noise_beside(binned)
                found.append(_dependence(name, joint, along.unit, binned, own))
    floor = noise_floor(dataset, residual)
    return Atlas(tuple(found), residual_spectra(dataset, residual, floor), floor)


@dataclass(frozen=True, eq=False)
class _Binned:
    """Hold a coordinate, a residual, each row's bin (-1: left out), and where stretches begin."""

    values: Vector
    residual: Vector
    label: Indices
    begins: Indices


def _noise_beside(binned: _Binned) -> ARNoise:
    """Estimate the noise from the deviations from the bins' means."""
    rows = np.flatnonzero(binned.label >= 0)
    label = binned.label[rows]
    count = np.bincount(label)
    mean = np.bincount(label, binned.residual[rows]) / count
    follows = (np.diff(rows, prepend=-2) == 1) & ~np.isin(rows, binned.begins)
    return fit_ar_noise(binned.residual[rows] - mean[label], run_indices(follows), taken=float(len(count)))


def _dependence(name: str, joint: int, unit: str, binned: _Binned, noise: ARNoise) -> Dependence:
    label = binned.label
    rows = np.flatnonzero(label >= 0)
    count = np.bincount(label[rows])
    weights = np.zeros((len(label), len(count)))
    weights[rows, label[rows]] = 1.0 / count[label[rows]]
    mean = weights.T @ binned.residual
    covariance = covariance_of_sums(noise, weights, binned.begins)
    statistic, freedom = _about_common_value(mean, covariance), len(count) - 1
    return Dependence(
        coordinate=name,
        joint=joint,
        unit=unit,
        centre=_medians(binned.values[rows], label[rows], count),
        mean=mean,
        standard_error=np.sqrt(np.diag(covariance)),
        count=count,
        statistic=statistic,
        degrees_of_freedom=freedom,
        p_value=chi2_tail(statistic, freedom),
    )


def _medians(values: Vector, label: Indices, count: Indices) -> Weights:
    """Give the median of every bin.

    Examples
    --------
    >>> _medians(np.array([3.0, 1.0, 5.0, 2.0]), np.array([0, 1, 0, 0]), np.array([3, 1]))
    array([3., 1.])
    """
    ordered, begins = values[np.lexsort((values, label))], np.cumsum(count) - count
    return np.asarray(0.5 * (ordered[begins + (count - 1) // 2] + ordered[begins + count // 2]))


def _bins(values: Vector, mask: np.ndarray) -> Indices:
    """Sort rows into bins of nearly equal counts, numbered from 0; -1 where a row is left out."""
    label = np.full(len(values), -1)
    rows = np.flatnonzero(mask & np.isfinite(values))
    bins = min(BINS, len(rows) // FEWEST_IN_BIN)
    if bins < 2:
        return label
    inner = np.quantile(values[rows], np.arange(1, bins) / bins)
    _, label[rows] = np.unique(np.searchsorted(inner, values[rows]), return_inverse=True)
    return label


def _about_common_value(mean: Vector, covariance: SquareMatrix) -> float:
    size = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    factor = cho_factor(covariance / np.outer(size, size) + _RIDGE * np.eye(len(mean)), lower=True)
    both = cho_solve(factor, np.column_stack([mean / size, 1.0 / size]))
    common = float(mean / size @ both[:, 1] / (1.0 / size @ both[:, 1]))
    left = (mean - common) / size
    return float(left @ cho_solve(factor, left))
