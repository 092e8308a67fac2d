"""Bound what least squares can do with a set-up by products of the columns that joints share.

A column of one joint alone, such as its friction, is first projected out of the rows of that joint. This
leaves the optimum as it is, whatever the weights (Frisch & Waugh 1933, Lovell 1963). Arrays may have an axis
more for several set-ups: what they share is taken once, and their small equations are solved together.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from ..arrays import SquareMatrix, Vector
from .thresholds import TRIAL

RIDGE = 1e-11
"""Added to the diagonal of scaled products, so that they can be solved with."""
_REWEIGHTINGS = 2
"""Rounds in which the noise of the joints is estimated anew."""


@dataclass(frozen=True, eq=False)
class Reduced:
    """Hold products of what is left of columns and torques, per joint."""

    products: np.ndarray
    """W'W: joints x columns x columns."""
    moments: np.ndarray
    """W'y: joints x columns."""
    squares: np.ndarray
    """y'y per joint."""
    torques: np.ndarray
    """The same of the whole torques."""
    rows: np.ndarray
    """Number of rows per joint."""

    @property
    def noise(self) -> np.ndarray:
        """Weigh the joints by what least squares leaves of them, in two rounds; see `bound`.

        Each round makes the mean logarithm of the errors smaller, towards one of several minima. So it begins
        from equal weights and from equal shares of the torques, and ends with what leaves less. The
        noise of a torque that was not measured is infinite.
        """
        return self._weighed[0]

    @property
    def bound(self) -> np.ndarray:
        """Give the mean logarithm of the errors that least squares leaves: no constraint makes it less.

        That of a joint without torque is one: nothing of it is predicted.
        """
        return self._weighed[1]

    @cached_property
    def _weighed(self) -> tuple[np.ndarray, np.ndarray]:
        measured = self.torques > 0.0
        whole = np.where(measured, self.torques, np.inf)
        noise = np.stack([np.where(measured, 1.0, np.inf), np.sqrt(np.maximum(whole, 1e-24) / self.rows)])
        for _ in range(_REWEIGHTINGS):
            left = np.where(measured, self._left(noise), np.inf)
            noise = np.sqrt(np.maximum(left, np.maximum(1e-12 * self.torques, 1e-24)) / self.rows)
        errors = np.where(measured, np.sqrt(self._left(noise) / np.where(measured, self.torques, 1.0)), 1.0)
        bounds = mean_log(errors)
        best = bounds[1] < bounds[0]
        return np.where(best[..., None], noise[1], noise[0]), np.where(best, bounds[1], bounds[0])

    def with_factors(self, joint: int, factors: Vector) -> "Reduced":
        """Multiply the torque of a joint (from 0), by each of several factors."""
        scale = np.ones((len(factors), len(self.rows)))
        scale[:, joint] = factors
        return replace(
            self,
            moments=scale[..., None] * self.moments,
            squares=scale**2 * self.squares,
            torques=scale**2 * self.torques,
        )

    def linear_factor(self, joint: int) -> float | None:
        """Give the factor of a joint's (from 0) torque at which least squares leaves least of all equations.

        The parameters that other joints share decide it, and the noise of the torque makes it too small. None
        where there are none, or it is not positive.
        """
        weights = 1.0 / self.noise**2
        product, moment = self._weighted(weights)
        own = weights[joint] * self.moments[joint]
        parameters = _solved(product, own)
        rest = weights[joint] * self.squares[joint] - own @ parameters
        towards_others = (moment - own) @ parameters
        return float(towards_others / rest) if towards_others > 0.0 and rest > 0.0 else None

    def _left(self, noise: np.ndarray) -> np.ndarray:
        """Give the squared residuals per joint of the optimum with these weights."""
        base = _solved(*self._weighted(1.0 / noise**2))[..., None, :]
        fitted = ((self.products @ base[..., None])[..., 0] - 2.0 * self.moments) * base
        return np.asarray(np.maximum(self.squares + fitted.sum(axis=-1), 1e-14 * self.torques))

    def _weighted(self, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Add up products and moments over the joints."""
        *leading, joints, columns, _ = self.products.shape
        flat = self.products.reshape(*leading, joints, columns * columns)
        product = (weights[..., None, :] @ flat).reshape(*weights.shape[:-1], columns, columns)
        return product, (weights[..., None, :] @ self.moments)[..., 0, :]


def stacked(several: Sequence[Reduced]) -> Reduced:
    """Put set-ups of one motion side by side, which share its products."""
    return replace(
        several[0],
        moments=np.stack([own.moments for own in several]),
        squares=np.stack([own.squares for own in several]),
        torques=np.stack([own.torques for own in several]),
    )


def mean_log(errors: np.ndarray) -> np.ndarray:
    """Give the mean logarithm of errors, each raised to `TRIAL.least_error` at least."""
    return np.asarray(np.mean(np.log(np.maximum(errors, TRIAL.least_error)), axis=-1))


@cache
def ridge(size: int) -> SquareMatrix:
    """Give what is added to scaled products."""
    added = RIDGE * np.eye(size)
    added.setflags(write=False)
    return added


def _solved(product: np.ndarray, moment: np.ndarray) -> np.ndarray:
    norms = np.sqrt(np.maximum(np.diagonal(product, axis1=-2, axis2=-1), 0.0))
    scale = np.where(norms > 0.0, norms, 1.0)
    scaled = product / (scale[..., :, None] * scale[..., None, :]) + ridge(product.shape[-1])
    return np.asarray(np.linalg.solve(scaled, (moment / scale)[..., None])[..., 0] / scale)
