"""Score candidates: by how much each would raise the likelihood, given everything that is already explained.

A candidate's columns are whitened like the residual, projected on the complement of the fitted columns, and
regressed on; all of it on small Gram matrices, so that thousands of candidates cost as much as a few fits.
Sources: Rao 1948 (score test); Janot, Vandanjon & Gautier, Control Eng. Pract. 48, 2016 (augmented
regressor).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import solve_triangular

from core.arrays import EquationRows, Matrix, SquareMatrix, Vector, Weights
from core.diagnosis.equations import Columns, Fit, JointRows

OPEN_SHARE = 1e-6
"""A column of which the model already spans all but this share is no evidence for anything."""


@dataclass(frozen=True, eq=False)
class Score:
    """Judge one candidate.

    Attributes
    ----------
    statistic
        Rise of twice the log-likelihood at this noise model.
    values, covariance
        What its linear parameters would be.
    clear_share
        The largest share of a column's square that neither fitted nor free columns span.
    """

    statistic: float
    values: Weights
    covariance: EquationRows
    clear_share: float


def score(found: Fit, joints: tuple[JointRows, ...], candidates: Sequence[Columns]) -> list[Score]:
    """Score candidates given as columns over all rows of the look."""
    widths = [next(iter(one.values())).shape[1] for one in candidates]
    starts = np.concatenate([[0], np.cumsum(widths)]).astype(int)
    size, total = len(found.values), int(starts[-1])
    cross, right, squares = np.zeros((size, total)), np.zeros(total), np.zeros(total)
    grams = [np.zeros((width, width)) for width in widths]
    for joint, rows in enumerate(joints):
        present = [index for index, one in enumerate(candidates) if joint in one]
        if not present:
            continue
        raw = np.hstack([candidates[index][joint][rows.rows] for index in present])
        white = found.joints[joint].whitening @ raw
        places = np.concatenate([np.arange(starts[index], starts[index + 1]) for index in present])
        squares[places] += np.sum(white**2, axis=0)
        white = found.joints[joint].free.cleared(white)
        cross[:, places] += found.joints[joint].columns.T @ white
        right[places] += white.T @ found.left[joint]
        begin = 0
        for index in present:
            part = white[:, begin : begin + widths[index]]
            grams[index] += part.T @ part
            begin += widths[index]
    reduced = solve_triangular(found.factor[0], cross / found.scale[:, None], lower=True)
    own = [slice(start, stop) for start, stop in pairwise(starts)]
    return [
        _judged(gram, reduced[:, one], right[one], squares[one]) for gram, one in zip(grams, own, strict=True)
    ]


def _judged(gram: SquareMatrix, reduced: Matrix, right: Vector, squares: Vector) -> Score:
    size = np.sqrt(np.maximum(squares, 1e-300))
    left = (gram - reduced.T @ reduced) / np.outer(size, size)
    clear = np.clip(np.diag(left), 0.0, 1.0)
    if not np.isfinite(left).all() or clear.max() < OPEN_SHARE:
        return Score(0.0, np.zeros(len(right)), np.eye(len(right)), 0.0)
    values, vectors = np.linalg.eigh(left)
    kept = values > OPEN_SHARE
    turned = vectors[:, kept].T @ (right / size)
    spread = vectors[:, kept] / size[:, None]
    covariance = (spread / values[kept]) @ spread.T
    found = spread @ (turned / values[kept])
    return Score(float(np.sum(turned**2 / values[kept])), found, covariance, float(clear.max()))
