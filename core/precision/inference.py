"""Give every base parameter its standard deviation, with the residual's memory taken into account.

For independent residuals of variance sigma^2 = ||rho||^2 / (n - d) the covariance is sigma^2 (W'W)^-1 and %P
= 100 sqrt(diag) / |chi|; the seed's equation (10) omits (W'W)^-1. Filtered samples are not independent, so
the covariance is the sandwich (W'W)^-1 W'V W (W'W)^-1 with V the residual's own autocovariance: bread, meat,
bread. With instruments Z the meat is that of Z, carried to the equations that are solved. Sources: Khalil &
Dombre (2002), ch. 12; Newey & West 1987.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters, Indices, JointVector, Matrix, SquareMatrix, Vector, Weights
from ..estimate.gaussian_prior import GaussianPrior
from ..estimate.system import System, column_scale
from ..regressor.memory import Memory

_RANK_TOLERANCE = 1e-8
_RESOLVED = 1e-12
"""Eigenvalue of W'W over the largest, columns of unit size, below which rounding may be a part of it."""
_ROUNDS = 3
INTERVAL_95 = 1.959964
POOR_PERCENT = 30.0
"""Relative deviation, %, above which a number counts as poorly known. Set by hand, as the page of a result
marks it."""


@dataclass(frozen=True, eq=False)
class Inference:
    """Hold how well the base parameters of any estimator are known."""

    information: SquareMatrix
    """W'W of the weighted equations."""
    meat: SquareMatrix
    """W'V W of the weighted equations."""
    open_share: Vector
    """Per parameter, the share of its unit vector that lies in directions the motion does not excite."""
    memory_factor: JointVector
    """Per joint, by how much the residual's memory inflates the variance of a constant: the effective number
    of independent samples is the number of samples divided by it."""

    @property
    def bread(self) -> SquareMatrix:
        """Give the inverse of W'W within the excited directions."""
        return inverse_information(self.information)

    @property
    def covariance(self) -> SquareMatrix:
        """Give the covariance of the base parameters within the excited directions."""
        return _sandwich(self.bread, self.meat)

    @property
    def standard_deviation(self) -> Vector:
        """Give one standard deviation per base parameter.

        Infinite where the motion leaves the parameter open, or so nearly that rounding hides its variance.
        """
        variance = np.diag(self.covariance)
        known = (self.open_share <= 1e-6) & (variance > 0.0)
        return np.sqrt(np.where(known, variance, np.inf))

    @property
    def root(self) -> Matrix:
        """Give rows that turn an error of the base parameters into independent ones of unit variance.

        Directions that the motion does not excite have none.
        """
        scale, values, vectors = _excited(self.information)
        own, turned = np.linalg.eigh(vectors.T @ (self.meat / np.outer(scale, scale)) @ vectors)
        sure = np.maximum(own, _RANK_TOLERANCE**2 * max(float(own.max(initial=0.0)), 1e-300))
        rows = (turned / np.sqrt(sure)).T * values @ vectors.T * scale
        return np.asarray(np.linalg.qr(rows, mode="r"))


def infer(
    system: System,
    memory: tuple[Memory, ...],
    columns_of: tuple[Indices, ...],
    base: BaseParameters,
    *,
    prior: GaussianPrior | None = None,
) -> Inference:
    """Judge the base parameters of a fit.

    Parameters
    ----------
    system
        The weighted equations.
    memory
        Per joint, the lagged products of the fitted rows.
    base
        The parameters whose residual tells the noise.
    prior
        Normal prior that the system holds beside the log's equations.
    """
    information = system.triangle.T @ system.triangle
    size = len(information)
    resolved, factors = inverse_information(information, _RESOLVED), np.ones(len(memory))
    taken, meat = np.zeros((size, size)), np.zeros((size, size))
    for _ in range(_ROUNDS):
        meat = np.zeros((size, size))
        for joint, (products, columns, noise) in enumerate(
            zip(memory, columns_of, system.noise, strict=True)
        ):
            index = np.ix_(columns, columns)
            autocovariance = _true_autocovariance(products, base[columns], taken[index])
            meat[index] += _own_spread(products, autocovariance) / noise**4
            factors[joint] = _memory_factor(autocovariance)
        if system.carried is not None:
            meat = system.carried @ meat @ system.carried.T
        if prior is not None:
            known = prior.rows.shape[1]
            meat[:known, :known] += prior.rows.T @ prior.rows
        meat = _no_negative(meat, column_scale(system.triangle))
        taken = _sandwich(resolved, meat)
    return Inference(information, meat, _open_share(system.triangle), factors)


def _no_negative(meat: SquareMatrix, scale: Vector) -> SquareMatrix:
    """Take negative variances out, which an estimated autocovariance leaves where columns nearly vanish."""
    values, vectors = np.linalg.eigh(meat / np.outer(scale, scale))
    if values[0] >= 0.0:
        return meat
    rows = scale[:, None] * vectors * np.sqrt(np.maximum(values, 0.0))
    return np.asarray(rows @ rows.T)


def _own_spread(products: Memory, autocovariance: Vector) -> SquareMatrix:
    """Give Z'V Z where there are instruments, and W'V W where there are none."""
    spread = products.spread(autocovariance)
    return spread[: products.instruments, : products.instruments] if products.instruments else spread


def _true_autocovariance(products: Memory, values: BaseParameters, covariance: SquareMatrix) -> Vector:
    """Estimate the noise's autocovariance from the residual's, which the fit has made smaller.

    The covariance leaves out directions that rounding may have made: what they take would be their inverse.

    A fit takes sum_t w(t)' C w(t + l) out of lag l, C being the covariance of what was fitted; for
    independent samples and lag 0 that is the n - d of the textbooks.
    """
    taken = np.einsum("lij,ij->l", products.of_regressor, covariance)
    return np.asarray((products.autocovariance(values) + taken) / max(products.rows, 1))


def _memory_factor(autocovariance: Vector) -> float:
    if autocovariance[0] <= 0.0:
        return 1.0
    taper = 1.0 - np.arange(1, len(autocovariance)) / len(autocovariance)
    return float(max(1.0 + 2.0 * taper @ autocovariance[1:] / autocovariance[0], 1e-3))


def relative_deviation_percent(base: BaseParameters, deviation: Vector) -> Vector:
    """Give %P = 100 deviation / |value|; infinite for a value of zero.

    Examples
    --------
    >>> relative_deviation_percent(np.array([2.0, -4.0]), np.array([0.1, 0.1]))
    array([5. , 2.5])
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(base == 0.0, np.inf, 100.0 * deviation / np.abs(base))


def subset(precision: Inference, chosen: Indices, triangle: Matrix) -> Inference:
    """Give the inference of a model reduced to the chosen base parameters.

    What the motion could not distinguish, it may, once others are gone; so their `open_share` is found anew.
    """
    square = np.ix_(chosen, chosen)
    was_open = precision.open_share[chosen]
    return Inference(
        precision.information[square],
        precision.meat[square],
        _open_share(triangle[:, chosen]) if was_open.any() else was_open,
        precision.memory_factor,
    )


def inverse_information(information: SquareMatrix, least: float = _RANK_TOLERANCE**2) -> SquareMatrix:
    """Give the inverse within the directions in which the matrix is not zero.

    Parameters
    ----------
    least
        Eigenvalue over the largest, columns of unit size, from which on a direction counts.
    """
    scale, values, vectors = _excited(information, least)
    return np.asarray(vectors / values @ vectors.T / np.outer(scale, scale))


def _sandwich(bread: SquareMatrix, meat: SquareMatrix) -> SquareMatrix:
    return np.asarray(bread @ meat @ bread)


def _excited(information: SquareMatrix, least: float = _RANK_TOLERANCE**2) -> tuple[Weights, Weights, Matrix]:
    """Give the columns' sizes, and eigenvalues and -vectors of what remains, without those that are zero.

    Where all rows of a column were taken out again, rounding may leave less than nothing.
    """
    size = np.sqrt(np.maximum(np.diag(information), 0.0))
    scale = np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    excited = values > least * values[-1]
    return scale, values[excited], vectors[:, excited]


def _open_share(triangle: Matrix) -> Vector:
    scale = column_scale(triangle)
    _, values, directions = np.linalg.svd(triangle / scale)
    open_directions = directions[values < _RANK_TOLERANCE * max(values[0], 1e-300)]
    unexcited = np.linalg.norm(triangle, axis=0) == 0.0
    return np.where(unexcited, 1.0, np.linalg.norm(open_directions, axis=0))
