"""Score candidates by Rao's score test: the rise of the likelihood, given all that is already fitted.

A candidate's columns are prewhitened like the residual and projected on the complement of the fitted columns.
All of it works on small Gram matrices, so that thousands of candidates cost as much as a few fits. Sources:
Rao 1948 (score test); Janot, Vandanjon & Gautier, Control Eng. Pract. 48, 2016 (augmented regressor).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dtrtrs

from ...arrays import EquationRows, Indices, Matrix, Weights
from ...numerics.recursions import sum_from_onsets
from ..thresholds.regression import COLUMNS
from .gls import Fit
from .rows import Columns, JointRows


@dataclass(frozen=True, eq=False)
class Score:
    """Hold the score test of one candidate."""

    statistic: float
    """Score statistic at this noise model: the predicted likelihood ratio statistic."""
    freedom: int
    """Number of directions of its linear parameters that the rows determine."""
    values: Weights
    covariance: EquationRows
    """What its linear parameters would be, and their covariance."""
    clear_share: float
    """The largest share of a column's square that neither fitted nor free columns span."""


class Panel:
    """Score the same candidates on top of several fits, with their columns stacked once.

    Parameters
    ----------
    joints
        The rows that are fitted.
    candidates
        The candidates' columns, over all rows of the data set.
    """

    def __init__(self, joints: tuple[JointRows, ...], candidates: Sequence[Columns]) -> None:
        groups: dict[object, list[int]] = {}
        for index, columns in enumerate(candidates):
            width = next(iter(columns.values())).shape[1]
            groups.setdefault((width, *sorted(columns)), []).append(index)
        self._groups = [
            (alike, _Alike(joints, [candidates[index] for index in alike])) for alike in groups.values()
        ]

    def scores(self, found: Fit) -> list[Score]:
        """Score the candidates on top of a fit."""
        out = {
            index: score
            for indices, alike in self._groups
            for index, score in zip(indices, alike.scores(found), strict=True)
        }
        return [out[index] for index in range(len(out))]


class _Alike:
    """Score candidates of the same number of columns that act on the same joints."""

    def __init__(self, joints: tuple[JointRows, ...], candidates: Sequence[Columns]) -> None:
        self._width = next(iter(candidates[0].values())).shape[1]
        self._columns = {
            joint: np.concatenate([columns[joint] for columns in candidates], axis=1)[joints[joint].rows]
            for joint in candidates[0]
        }

    def scores(self, found: Fit) -> list[Score]:
        size, width = len(found.values), self._width
        count = next(iter(self._columns.values())).shape[1] // width
        cross, right = np.zeros((size, count * width)), np.zeros(count * width)
        squares, grams = np.zeros((count, width)), np.zeros((count, width, width))
        for joint, columns in self._columns.items():
            own = found.joints[joint]
            white = own.white(columns)
            inside = own.nuisance.in_span(white)
            right += found.left[joint] @ white
            cross[own.acting] += own.columns.T @ white - own.inside.T @ inside
            whole = _grams(white, width)
            squares += np.diagonal(whole, axis1=1, axis2=2)
            grams += whole - _grams(inside, width)
        reduced, _ = dtrtrs(found.factor, cross / found.scale[:, None], lower=1)
        return _test_scores(grams - _grams(reduced, width), right.reshape(count, width), squares)


def score(found: Fit, joints: tuple[JointRows, ...], candidates: Sequence[Columns]) -> list[Score]:
    """Score candidates given as columns over all rows of the data set."""
    return Panel(joints, candidates).scores(found)


def score_onsets(found: Fit, joints: tuple[JointRows, ...], columns: Columns, starts: Indices) -> list[Score]:
    """Score columns that act from one row of the data set on, for each of many such rows.

    White columns from a row on equal those of all rows, except for as many first rows as the noise has
    memory. Rows from which on the same fitted ones follow have the same score.
    """
    begins = [np.searchsorted(joints[joint].rows, starts) for joint in columns]
    different, alike = np.unique(begins, axis=1, return_inverse=True)
    scores = _scores_from(found, joints, columns, tuple(different))
    return [scores[number] for number in alike.ravel()]


def _scores_from(
    found: Fit, joints: tuple[JointRows, ...], columns: Columns, begins: Sequence[Indices]
) -> list[Score]:
    """Score columns that act from some fitted row on: per joint (rows) and trial (columns), which one."""
    count, size = len(begins[0]), len(found.values)
    width = next(iter(columns.values())).shape[1]
    cross = np.zeros((count, size, width))
    right, squares = np.zeros((count, width)), np.zeros((count, width))
    grams = np.zeros((count, width, width))
    for (joint, series), first in zip(columns.items(), begins, strict=True):
        rows, own = joints[joint], found.joints[joint]
        loose, acting = own.nuisance.columns, len(own.acting)
        shapes = (width,), (width,), (width, width), (acting, width)
        sums = tuple(np.empty((count, *shape)) for shape in shapes)
        equations = (series[rows.rows], rows.run_index, own.noise.weights, found.left[joint])
        fitted, inside, factor = (
            np.ascontiguousarray(table) for table in (own.columns, own.inside, own.nuisance.factor.T)
        )
        free = (loose.values, loose.places, loose.begins)
        sum_from_onsets((*equations, fitted, *free), factor, inside, np.ascontiguousarray(first), sums)
        right += sums[0]
        squares += sums[1]
        grams += sums[2]
        cross[:, own.acting] += sums[3]
    flat = np.moveaxis(cross, 0, 1).reshape(size, -1)
    reduced, _ = dtrtrs(found.factor, flat / found.scale[:, None], lower=1)
    return _test_scores(grams - _grams(reduced, width), right, squares)


def _grams(columns: Matrix, width: int) -> np.ndarray:
    """Give the Gram matrix of every so many columns."""
    parts = np.moveaxis(columns.reshape(len(columns), columns.shape[1] // width, width), 1, 0)
    return np.asarray(np.swapaxes(parts, 1, 2) @ parts)


def _test_scores(grams: np.ndarray, right: Matrix, squares: Matrix) -> list[Score]:
    """Test candidates by their projected Gram matrices and their products with the residual."""
    size = np.sqrt(np.maximum(squares, 1e-300))
    left = grams / (size[:, :, None] * size[:, None, :])
    clear = np.clip(np.diagonal(left, axis1=1, axis2=2), 0.0, 1.0).max(axis=1)
    tested = np.isfinite(left).all(axis=(1, 2)) & (clear >= COLUMNS.least_clear)
    out = [Score(0.0, 1, np.zeros(right.shape[1]), np.eye(right.shape[1]), 0.0)] * len(right)
    values, vectors = np.linalg.eigh(left[tested])
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=values > COLUMNS.least_clear)
    spread = vectors / size[tested][:, :, None]
    projected = np.einsum("nij,ni->nj", spread, right[tested])
    covariance = np.einsum("nij,nj,nkj->nik", spread, inverse, spread)
    found = np.einsum("nij,nj->ni", spread, projected * inverse)
    statistics = np.sum(projected**2 * inverse, axis=1).tolist()
    freedoms = np.count_nonzero(inverse, axis=1).tolist()
    shares = clear[tested].tolist()
    for index, *tests in zip(
        np.flatnonzero(tested).tolist(), statistics, freedoms, found, covariance, shares, strict=True
    ):
        out[index] = Score(*tests)
    return out
