"""Test whether errors of the measured motion bias least squares, where instruments give another estimate.

Both estimates are linear in the noise of the torque, d = chi_iv - chi_ls = B [Z W]'e, so that the covariance
of their difference follows from the same lagged products as each one's own, memory included. Where the
columns hold no error of their own, d'(cov d)^+ d is chi-square. Sources: Hausman, Econometrica 46, 1978; Wu
1973; Durbin 1954.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters, Indices, Matrix
from ..estimate.system import RANK_TOLERANCE, System, column_scale, solved_by, stacked
from ..numerics.chi2_tail import log_chi2_tail
from ..regressor.factor import INSTRUMENT, Factor
from ..regressor.memory import Memory
from .inference import inverse_information

SIGNIFICANCE = 0.05
"""p-value above which a difference is not significant. By convention: Fisher 1925."""
NO_DIFFERENCE = 1e-6
"""Variance, in units of least squares' own, below which a direction of the difference is rounding."""


@dataclass(frozen=True)
class Endogeneity:
    """Hold the test, and how well the instruments follow the columns that they stand for."""

    statistic: float
    degrees: int
    p_value: float
    largest: float
    """Largest difference of a base parameter, in standard deviations of least squares'."""
    weakest: float
    """Least canonical correlation of instruments and the columns that the motion excites: 1 where they span
    the same, 0 where one column has no instrument."""


def endogeneity(
    system: System, factors: tuple[Factor, ...], memory: tuple[Memory, ...], columns_of: tuple[Indices, ...]
) -> Endogeneity:
    """Compare instrumental variables with least squares on the same rows and weights.

    Parameters
    ----------
    system
        The instrumental equations, without a prior.
    factors, memory
        Per joint, the factor and the lagged products of its rows [Z W y].
    columns_of
        Per joint, the base parameters that its columns are of.
    """
    size = len(system.triangle)
    least = stacked(tuple(map(_without_instruments, factors)), columns_of, size, system.noise)
    bread, own_bread = (inverse_information(one.triangle.T @ one.triangle) for one in (system, least))
    linear = np.hstack([bread @ np.asarray(system.carried), -own_bread])
    found = system.solved()
    spread = _spread(memory, columns_of, system, found)
    covariance, own = linear @ spread @ linear.T, own_bread @ spread[size:, size:] @ own_bread
    difference = found - least.solved()
    deviation = np.sqrt(np.maximum(np.diag(own), 1e-300))
    values, vectors = np.linalg.eigh(covariance / np.outer(deviation, deviation))
    kept = values > NO_DIFFERENCE
    along = vectors[:, kept].T @ (difference / deviation)
    statistic, degrees = float(np.sum(along**2 / values[kept])), int(np.count_nonzero(kept))
    chance = float(np.exp(log_chi2_tail(statistic, degrees))) if degrees else 1.0
    shared = solved_by(least.triangle.T, system.triangle.T)
    excited = np.linalg.matrix_rank(least.triangle / column_scale(least.triangle), RANK_TOLERANCE)
    correlations = np.linalg.svd(shared, compute_uv=False)[:excited]
    largest = float(np.max(np.abs(difference / deviation), initial=0.0))
    return Endogeneity(statistic, degrees, chance, largest, float(min(correlations.min(initial=1.0), 1.0)))


def _without_instruments(factor: Factor) -> Factor:
    instruments = dict(factor.groups)[INSTRUMENT]
    return Factor.of(factor.triangle[:, instruments:])


def _spread(
    memory: tuple[Memory, ...], columns_of: tuple[Indices, ...], system: System, values: BaseParameters
) -> Matrix:
    """Give [Z W]'V [Z W] of the weighted rows."""
    size = len(values)
    total = np.zeros((2 * size, 2 * size))
    for products, columns, noise in zip(memory, columns_of, system.noise, strict=True):
        both: Indices = np.concatenate([columns, size + columns])
        autocovariance = products.autocovariance(values[columns]) / max(products.rows, 1)
        total[np.ix_(both, both)] += products.spread(autocovariance) / noise**4
    return total
