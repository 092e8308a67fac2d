"""Model the autocorrelation of a residual by an autoregression per joint.

The rows of a filtered residual are correlated, and deviations and p-values that ignore it are wrong by
factors. The autoregression prewhitens residual and columns alike. Runs of consecutive rows begin with
predictors of lower order, which gives the exact likelihood of a stationary process.
Sources: Burg 1975; Brockwell & Davis, Time Series (1991), ch. 5 and 8.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from ...arrays import Indices, Matrix, SquareMatrix, Vector, Weights
from ...numerics.recursions import innovate, reflect
from ...numerics.short_columns import prewhitened
from ..thresholds.regression import NOISE


@dataclass(frozen=True, eq=False)
class ARNoise:
    """Hold the best linear predictors of a stationary residual from its past."""

    predictors: tuple[Weights, ...]
    """Coefficients for 0, 1, ... p past values, latest first."""
    deviations: Vector
    """Standard deviation of the innovation of each predictor, N m."""

    @property
    def order(self) -> int:
        """Give the order of the autoregression."""
        return len(self.predictors) - 1

    def whitened(self, columns: Matrix, run_index: Indices) -> Matrix:
        """Prewhiten columns: turn them into innovations of unit variance.

        Parameters
        ----------
        columns
            Rows, run after run.
        run_index
            Per row, its index within its run, from 0.
        """
        return prewhitened(columns, run_index, self.weights)

    def whitening(self, run_index: Indices) -> csr_array:
        """Give the prewhitening as a matrix: each row less its prediction from earlier rows of its run."""
        known, lags = np.minimum(run_index, self.order), np.arange(self.order + 1)
        inside = lags <= known[:, None]
        columns = (np.arange(len(run_index))[:, None] - lags)[inside]
        starts = np.concatenate([[0], np.cumsum(known + 1)])
        return csr_array((self.weights[known][inside], columns, starts), (len(run_index), len(run_index)))

    def innovations(self, residual: Vector, run_index: Indices) -> Vector:
        """Prewhiten one column, at less cost than by the matrix."""
        out = np.empty(len(residual))
        innovate(np.array(residual), run_index, self.weights, out)
        return out

    @cached_property
    def weights(self) -> SquareMatrix:
        """Give, for 0, 1, ... p known values, the weights of a value and of those before it."""
        weights = np.zeros((self.order + 1, self.order + 1))
        for known, predictor in enumerate(self.predictors):
            weights[known, 0] = 1.0
            weights[known, 1 : known + 1] = -predictor
        return np.asarray(weights / self.deviations[:, None])

    def departure(self, other: "ARNoise", residual: Vector, run_index: Indices) -> float:
        """Give the Kullback-Leibler divergence of another noise from this one, for rows like a residual's."""
        own, theirs = (noise.innovations(residual, run_index) for noise in (self, other))
        ratio = float(theirs @ theirs) / max(float(own @ own), 1e-300)
        scale = other.log_deviations(run_index) - self.log_deviations(run_index)
        return scale + 0.5 * len(run_index) * (ratio - 1.0)

    def log_likelihood(self, residual: Vector, run_index: Indices) -> float:
        """Give the log-likelihood of a residual, up to a constant."""
        white = self.innovations(residual, run_index)
        return -0.5 * float(white @ white) - self.log_deviations(run_index)

    def log_deviations(self, run_index: Indices) -> float:
        """Give the sum over rows of the logarithm of the innovation's deviation."""
        counts = np.bincount(np.minimum(run_index, self.order), minlength=self.order + 1)
        return float(counts @ np.log(self.deviations))


def fit_ar_noise(
    residual: Vector, run_index: Indices, order: int | None = None, *, taken: float = 0.0
) -> ARNoise:
    """Fit an autoregression to a residual; of the highest order that its length allows by default.

    A fixed order keeps likelihoods comparable: one chosen by a criterion jumps between hypotheses.

    Parameters
    ----------
    taken
        Degrees of freedom of the fit that left the residual.
    """
    predictors, variances = _burg(residual, run_index)
    if order is None:
        order = min(len(variances) - 1, len(residual) // NOISE.rows_per_order)
    raised = 1.0 / max(1.0 - taken / max(len(residual), 1), NOISE.least_freedom)
    return ARNoise(tuple(predictors[: order + 1]), np.sqrt(raised * variances[: order + 1]))


def run_indices(follows: np.ndarray) -> Indices:
    """Count the rows within their runs from 0; `follows` is false where a run begins.

    Examples
    --------
    >>> run_indices(np.array([False, True, True, False, True]))
    array([0, 1, 2, 0, 1])
    """
    index = np.arange(len(follows))
    begin = np.maximum.accumulate(np.where(follows, 0, index))
    return np.asarray(index - begin)


def _burg(residual: Vector, run_index: Indices) -> tuple[list[Weights], Weights]:
    """Give predictors of rising order by Burg's method, which the ends of runs do not bias."""
    predictors, variances = np.zeros((1 + NOISE.order, NOISE.order)), np.zeros(1 + NOISE.order)
    known = reflect(
        np.array(residual), run_index, NOISE.shrinkage, NOISE.rows_per_reflection, predictors, variances
    )
    return [predictors[order, :order] for order in range(known + 1)], variances[: known + 1]
