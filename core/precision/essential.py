"""Keep the parameters that matter: the weakest leave one by one while the error does not grow much.

At each step the parameter with the smallest |value| / deviation leaves and the others are fitted again;
taking it out raises the weighted squared error by the square of that ratio, so the search stops when the
ratio exceeds the 95 % point. Deviations carry the residual's memory, else far too many parameters would
count. Sources: Khalil & Dombre (2002), ch. 12; Pham & Gautier 1991.
"""

from dataclasses import dataclass

import numpy as np

from core.arrays import Indices
from core.estimate.system import System
from core.precision.covariance import INTERVAL_95, Precision, subset


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


def essential_parameters(system: System, precision: Precision) -> Essential:
    """Eliminate base parameters from the weakest on."""
    kept = np.arange(system.triangle.shape[1])
    path: list[Elimination] = []
    while len(kept) > 1:
        values, cost = _refitted(system, kept)
        deviation = subset(precision, kept, system.triangle).standard_deviation
        ratios = np.where(np.isfinite(deviation), np.abs(values) / np.maximum(deviation, 1e-300), 0.0)
        weakest = int(np.flatnonzero(ratios == ratios.min())[-1])  # of equals, the farthest from the base
        if path:
            path[-1] = Elimination(path[-1].parameter, path[-1].ratio, cost)
        if ratios[weakest] > INTERVAL_95:
            break
        path.append(Elimination(int(kept[weakest]), float(ratios[weakest]), cost))
        kept = np.delete(kept, weakest)
    return Essential(kept, tuple(path))


def _refitted(system: System, kept: Indices) -> tuple[np.ndarray, float]:
    columns = system.triangle[:, kept]
    scale = np.linalg.norm(columns, axis=0)
    scale[scale == 0.0] = 1.0
    scaled, *_ = np.linalg.lstsq(columns / scale, system.target, rcond=1e-8)
    miss = system.target - columns @ (scaled / scale)
    return scaled / scale, float(miss @ miss) + system.rest
