"""Refine a grid around its best point."""

from collections.abc import Sequence

import numpy as np

FINER = 9
"""Points laid between the neighbours of the best grid point, in each of two rounds."""


def neighbours(points: Sequence[float], here: float) -> tuple[float, float]:
    """Give the points on either side; beyond an end, as far as the other neighbour."""
    points = sorted({*points, here})
    index = points.index(here)
    if len(points) == 1:
        return 0.5 * here, 2.0 * here
    low = points[index - 1] if index else _mirrored(here, points[index + 1])
    high = points[index + 1] if index + 1 < len(points) else _mirrored(here, points[index - 1])
    return low, high


def _mirrored(here: float, other: float) -> float:
    if here > 0.0 and other > 0.0:
        return here * here / other
    return 2.0 * here - other


def between(low: float, high: float) -> list[float]:
    """Give points between two: in equal ratios where both are positive."""
    if low > 0.0:
        return [float(point) for point in np.geomspace(low, high, FINER + 2)[1:-1]]
    return [float(point) for point in np.linspace(low, high, FINER + 2)[1:-1]]
