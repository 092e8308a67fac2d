"""Keep the parameters that matter: the weakest leave one by one while the error does not grow much.

At each step the parameter with the smallest |value| / deviation leaves and the others are fitted again;
taking it out raises the weighted squared error by the square of that ratio, so the search stops when the
ratio exceeds the 95 % point. Deviations carry the residual's memory, else far too many parameters would
count. Sources: Khalil & Dombre (2002), ch. 12; Pham & Gautier 1991.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from ..arrays import Indices, SquareMatrix, Vector
from ..estimate.system import System, column_scale
from .inference import INTERVAL_95, Inference, subset


@dataclass(frozen=True)
class Elimination:
    """Record one step.

    Which base parameter left, its ratio |value| / deviation, and the weighted squared error after it.
    """

    parameter: int
    ratio: float
    cost: float


@dataclass(frozen=True, eq=False)
class Essential:
    """Hold the essential base parameters and the path that led to them."""

    kept: Indices
    path: tuple[Elimination, ...]


def essential_parameters(system: System, precision: Inference) -> Essential:
    """Eliminate base parameters from the weakest on."""
    kept, path = _without_open(system, precision)
    if not np.linalg.norm(system.triangle[:, kept]) > 0.0:
        return Essential(kept, tuple(path))
    fit = _Fit.of(system, subset(precision, kept, system.triangle), kept)
    while len(fit.kept) > 1:
        ratios = fit.ratios
        weakest = _last_smallest(ratios)
        if ratios[weakest] > INTERVAL_95:
            break
        parameter = int(fit.kept[weakest])
        fit = fit.without(weakest)
        path.append(Elimination(parameter, float(ratios[weakest]), fit.cost))
    return Essential(fit.kept, tuple(path))


def _without_open(system: System, precision: Inference) -> tuple[Indices, list[Elimination]]:
    """Let parameters that the motion leaves open go first, one by one: what is open changes as they leave."""
    kept, path = np.arange(system.triangle.shape[1]), list[Elimination]()
    while len(kept) > 1:
        deviation = subset(precision, kept, system.triangle).standard_deviation
        if np.isfinite(deviation).all():
            break
        weakest = _last_smallest(np.where(np.isfinite(deviation), 1.0, 0.0))
        parameter = int(kept[weakest])
        kept = np.delete(kept, weakest)
        path.append(Elimination(parameter, 0.0, _cost(system, kept)))
    return kept, path


def _last_smallest(ratios: Vector) -> int:
    """Find the weakest; of equals, the farthest from the base."""
    return int(np.flatnonzero(ratios == ratios.min())[-1])


@dataclass(frozen=True, eq=False)
class _Fit:
    """Hold a fit of some parameters, in units that give every column length one, so that one leaves cheaply.

    With B = (W'W)^-1, taking parameter k out moves the others by -B[:, k] value_k / B_kk and raises the
    squared error by value_k^2 / B_kk; the covariance of the rest follows by the same step on both sides.
    """

    kept: Indices
    values: Vector
    inverse: SquareMatrix
    covariance: SquareMatrix
    cost: float

    @classmethod
    def of(cls, system: System, precision: Inference, kept: Indices) -> "_Fit":
        columns = system.triangle[:, kept]
        scale = column_scale(columns)
        orthonormal, triangle = np.linalg.qr(columns / scale)
        root = solve_triangular(triangle, np.eye(len(kept)))
        inverse = root @ root.T
        covariance = inverse @ (precision.meat / np.outer(scale, scale)) @ inverse
        return cls(kept, root @ (orthonormal.T @ system.target), inverse, covariance, _cost(system, kept))

    @property
    def ratios(self) -> Vector:
        """Give |value| / deviation."""
        deviation = np.sqrt(np.maximum(np.diag(self.covariance), 0.0))
        return np.asarray(np.abs(self.values) / np.maximum(deviation, 1e-300))

    def without(self, k: int) -> "_Fit":
        step = self.inverse[:, k] / self.inverse[k, k]
        rows = self.covariance - np.outer(step, self.covariance[k])
        others = np.delete(np.arange(len(self.kept)), k)
        rest = np.ix_(others, others)
        return _Fit(
            self.kept[others],
            (self.values - step * self.values[k])[others],
            (self.inverse - np.outer(step, self.inverse[k]))[rest],
            (rows - np.outer(rows[:, k], step))[rest],
            self.cost + float(self.values[k] ** 2 / self.inverse[k, k]),
        )


def _cost(system: System, kept: Indices) -> float:
    columns = system.triangle[:, kept]
    scale = column_scale(columns)
    scaled, *_ = np.linalg.lstsq(columns / scale, system.target, rcond=1e-8)
    miss = system.target - columns @ (scaled / scale)
    return float(miss @ miss) + system.rest
