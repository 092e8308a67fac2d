"""Tell how well the motion excites the parameters: the condition of W, and each column's own share.

The condition number depends on units, so it is given as it is and with columns scaled to unit length. A
column's own share is what is left of it once all other columns have explained what they can; a parameter with
a small share is known through it alone. Source: Gautier & Khalil 1992; Belsley, Kuh & Welsch 1980.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Matrix, Vector

_COLLINEAR = 1e-12
"""Singular values below this share of the largest are rounding."""


@dataclass(frozen=True, eq=False)
class ExcitationScore:
    """Hold the condition numbers and every column's own share (0..1).

    Infinite condition where a column is not excited.
    """

    condition_number: float
    condition_number_scaled: float
    own_share: Vector


def excitation(triangle: Matrix) -> ExcitationScore:
    """Judge the triangular factor of the (weighted) observation matrix.

    Examples
    --------
    >>> excitation(np.diag([1.0, 10.0])).condition_number
    10.0
    """
    norms = np.linalg.norm(triangle, axis=0)
    scaled = triangle / np.where(norms > 0.0, norms, 1.0)
    return ExcitationScore(_condition(triangle), _condition(scaled), _own_share(scaled))


def _condition(matrix: Matrix) -> float:
    values = np.linalg.svd(matrix, compute_uv=False)
    return float(values[0] / values[-1]) if values[-1] > 1e-14 * values[0] else float("inf")


def _own_share(scaled: Matrix) -> Vector:
    """Give each unit column's distance from the span of the others: one over the root of diag (W'W)^-1."""
    _, values, directions = np.linalg.svd(scaled)
    floored = np.maximum(values, _COLLINEAR * values[0]) if values[0] > 0.0 else np.ones_like(values)
    shares = 1.0 / np.sqrt((directions.T / floored) ** 2 @ np.ones(len(floored)))
    return np.where(np.linalg.norm(scaled, axis=0) > 0.0, np.minimum(shares, 1.0), 0.0)
