"""Hold a set-up's normal equations joint by joint: what least squares can do follows from products alone."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular

from ..arrays import BaseParameters, Indices, JointVector, Matrix, Vector
from ..estimate.system import System
from .thresholds import TRIAL

_RIDGE = 1e-11
"""Added to the diagonal of scaled products, so that they have a Cholesky factor."""
_REWEIGHTINGS = 2
"""Rounds in which the noise of the joints is estimated anew."""


@dataclass(frozen=True, eq=False)
class Normal:
    """Hold W'W and W'y over all columns, y'y and the number of rows, per joint."""

    products: np.ndarray
    """Joints x columns x columns."""
    moments: Matrix
    squares: JointVector
    rows: JointVector

    @cached_property
    def noise(self) -> JointVector:
        """Weigh the joints by what least squares leaves of them, in two rounds; see `bound`.

        Each round makes the mean logarithm of the errors smaller, towards one of several minima. So it begins
        from equal weights and from equal shares of the torques, and ends with what leaves less.
        """
        starts = np.ones(len(self.squares)), np.sqrt(np.maximum(self.squares, 1e-24) / self.rows)
        return min(map(self._reweighted, starts), key=self._mean_log)

    def _reweighted(self, noise: JointVector) -> JointVector:
        for _ in range(_REWEIGHTINGS):
            left = self._left(_solved(*self._weighted(noise)))
            noise = np.sqrt(np.maximum(left, np.maximum(1e-12 * self.squares, 1e-24)) / self.rows)
        return noise

    def _mean_log(self, noise: JointVector) -> float:
        return mean_log(self.errors(_solved(*self._weighted(noise))))

    @cached_property
    def system(self) -> System:
        """Give the equations of all joints, weighted."""
        product, moment = self._weighted(self.noise)
        scale, upper = _cholesky(product)
        target = solve_triangular(upper, moment / scale, trans="T")
        rest = max(float(np.sum(self.squares / self.noise**2) - target @ target), 0.0)
        return System(upper * scale, target, rest, int(self.rows.sum()), self.noise)

    @cached_property
    def bound(self) -> float:
        """Give the mean logarithm of the errors that least squares leaves: no constraint makes it less."""
        return self._mean_log(self.noise)

    def errors(self, base: BaseParameters) -> JointVector:
        """Give the RMS residual over the RMS torque per joint."""
        return np.asarray(np.sqrt(self._left(base) / np.where(self.squares > 0.0, self.squares, 1.0)))

    def with_factor(self, joint: int, factor: float) -> "Normal":
        """Multiply the torque of a joint (from 0)."""
        factors = np.ones(len(self.squares))
        factors[joint] = factor
        return replace(self, moments=factors[:, None] * self.moments, squares=factors**2 * self.squares)

    def linear_factor(self, joint: int) -> float | None:
        """Give the factor of a joint's (from 0) torque at which least squares leaves least of all equations.

        The parameters that other joints share decide it, and the noise of the torque makes it too small. None
        where there are none, or it is not positive.
        """
        weights = 1.0 / self.noise**2
        product, moment = self._weighted(self.noise)
        own = weights[joint] * self.moments[joint]
        parameters = _solved(product, own)
        rest = weights[joint] * self.squares[joint] - own @ parameters
        towards_others = (moment - own) @ parameters
        return float(towards_others / rest) if towards_others > 0.0 and rest > 0.0 else None

    def _left(self, base: BaseParameters) -> JointVector:
        fitted = (self.products @ base - 2.0 * self.moments) @ base
        return np.asarray(np.maximum(self.squares + fitted, 1e-14 * self.squares))

    def _weighted(self, noise: JointVector) -> tuple[Matrix, Vector]:
        weights = 1.0 / noise**2
        return np.tensordot(weights, self.products, axes=1), weights @ self.moments


def crossed(
    first: Sequence[Matrix], second: Sequence[Matrix], of: Sequence[Indices], size: int
) -> np.ndarray:
    """Give, per joint, the products of two of its matrices' columns with each other, placed among all."""
    out = np.zeros((len(of), size, size))
    for joint, (own, other, columns) in enumerate(zip(first, second, of, strict=True)):
        out[joint][np.ix_(columns, columns)] = own.T @ other
    return out


def towards(rows: Sequence[Matrix], torque: Sequence[Vector], of: Sequence[Indices], size: int) -> Matrix:
    """Give, per joint, the products of a matrix's columns with its torque, placed among all."""
    out = np.zeros((len(of), size))
    for joint, (own, measured, columns) in enumerate(zip(rows, torque, of, strict=True)):
        out[joint, columns] = own.T @ measured
    return out


def mean_log(errors: JointVector) -> float:
    """Give the mean logarithm of errors, none of which counts as smaller than can be told."""
    return float(np.mean(np.log(np.maximum(errors, TRIAL.least_error))))


def _cholesky(product: Matrix) -> tuple[Vector, Matrix]:
    """Give the upper factor of products whose columns were divided by a scale."""
    scale = _norms(product)
    scaled = product / np.outer(scale, scale)
    scaled[np.diag_indices_from(scaled)] += _RIDGE
    return scale, cholesky(scaled)


def _norms(product: Matrix) -> Vector:
    """Give the norms of the columns that products were taken of."""
    norms = np.sqrt(np.diag(product))
    return np.where(norms > 0.0, norms, 1.0)


def _solved(product: Matrix, moment: Vector) -> BaseParameters:
    scale, upper = _cholesky(product)
    return np.asarray(cho_solve((upper, False), moment / scale) / scale)
