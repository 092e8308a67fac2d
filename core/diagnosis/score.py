"""Score candidates: by how much each would raise the likelihood, given everything that is already explained.

A candidate's columns are whitened like the residual, projected on the complement of the fitted columns, and
regressed on; all of it on small Gram matrices, so that thousands of candidates cost as much as a few fits.
Sources: Rao 1948 (score test); Janot, Vandanjon & Gautier, Control Eng. Pract. 48, 2016 (augmented
regressor).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dtrtrs
from scipy.sparse import csr_array

from core.arrays import EquationRows, Indices, Matrix, Weights
from core.diagnosis.equations import OPEN_SHARE, Fit
from core.diagnosis.rows import Columns, JointRows
from core.diagnosis.whitened import Whitened


@dataclass(frozen=True, eq=False)
class Score:
    """Judge one candidate.

    Attributes
    ----------
    statistic
        Rise of twice the log-likelihood at this noise model.
    freedom
        How many directions of its linear parameters the rows tell.
    values, covariance
        What its linear parameters would be.
    clear_share
        The largest share of a column's square that neither fitted nor free columns span.
    """

    statistic: float
    freedom: int
    values: Weights
    covariance: EquationRows
    clear_share: float


class Panel:
    """Score the same candidates on top of one fit after the other, their columns put side by side once.

    Parameters
    ----------
    joints
        The rows that are fitted.
    candidates
        The candidates' columns, over all rows of the look.
    """

    def __init__(self, joints: tuple[JointRows, ...], candidates: Sequence[Columns]) -> None:
        widths = [next(iter(one.values())).shape[1] for one in candidates]
        places = [[index for index, one in enumerate(widths) if one == width] for width in set(widths)]
        self._groups = [
            (alike, _Alike(joints, [candidates[index] for index in alike], widths[alike[0]]))
            for alike in places
        ]

    def scores(self, found: Fit) -> list[Score]:
        """Score the candidates on top of a fit."""
        out = {
            index: one
            for places, alike in self._groups
            for index, one in zip(places, alike.scores(found), strict=True)
        }
        return [out[index] for index in range(len(out))]


class _Alike:
    """Score candidates of the same number of columns."""

    def __init__(self, joints: tuple[JointRows, ...], candidates: Sequence[Columns], width: int) -> None:
        self._count, self._width = len(candidates), width
        self._present = [
            np.array([index for index, one in enumerate(candidates) if joint in one], dtype=int)
            for joint in range(len(joints))
        ]
        self._columns = [
            _side_by_side([candidates[index][joint] for index in present], rows.rows)
            for joint, (rows, present) in enumerate(zip(joints, self._present, strict=True))
        ]

    def scores(self, found: Fit) -> list[Score]:
        count, size, width = self._count, len(found.values), self._width
        cross = np.zeros((count, size, width))
        right, squares = np.zeros((count, width)), np.zeros((count, width))
        grams = np.zeros((count, width, width))
        for joint, present in enumerate(self._present):
            if not len(present):
                continue
            own = found.joints[joint]
            white = own.whitening @ self._columns[joint]
            inside = own.free.inside(white)
            right[present] += (found.left[joint] @ white).reshape(-1, width)
            both = own.columns.T @ white - own.inside.T @ inside
            both = both.reshape(len(own.acting), len(present), width)
            cross[present[:, None], own.acting] += np.moveaxis(both, 0, 1)
            whole = _grams(white, width)
            squares[present] += np.diagonal(whole, axis1=1, axis2=2)
            grams[present] += whole - _grams(inside, width)
        flat = np.moveaxis(cross, 0, 1).reshape(size, -1)
        reduced, _ = dtrtrs(found.factor, flat / found.scale[:, None], lower=1)
        return _judged(grams - _grams(reduced, width), right, squares)


def _side_by_side(columns: Sequence[EquationRows], rows: Indices) -> EquationRows:
    """Take some rows of columns, and put them beside each other."""
    width = columns[0].shape[1] if columns else 0
    out = np.empty((len(rows), width * len(columns)))
    for place, one in enumerate(columns):
        np.take(one, rows, axis=0, out=out[:, width * place : width * (place + 1)])
    return out


def score(found: Fit, joints: tuple[JointRows, ...], candidates: Sequence[Columns]) -> list[Score]:
    """Score candidates given as columns over all rows of the look."""
    return Panel(joints, candidates).scores(found)


def score_from(found: Fit, joints: tuple[JointRows, ...], columns: Columns, starts: Indices) -> list[Score]:
    """Score columns that act from one row of the look on, for each of many such rows.

    What is white from a row on is what is white all along, but for the first rows, as many as the noise
    remembers: there nothing comes before.
    """
    count, size, width = len(starts), len(found.values), next(iter(columns.values())).shape[1]
    cross = np.zeros((count, size, width))
    right, squares = np.zeros((count, width)), np.zeros((count, width))
    grams = np.zeros((count, width, width))
    for joint, one in columns.items():
        own = found.joints[joint]
        first = np.searchsorted(joints[joint].rows, starts)
        sums = _Begun(own, found.left[joint], first, width)
        taken = one[joints[joint].rows]
        sums.add_tails(own.whitening @ taken, own.noise.order)
        sums.add_heads(_begun(own, taken))
        inside = own.free.along(np.moveaxis(sums.free, 0, 1).reshape(own.free.count, count * width))
        right += sums.right
        squares += np.diagonal(sums.grams, axis1=1, axis2=2)
        grams += sums.grams - _grams(inside, width)
        spanned = (own.inside.T @ inside).reshape(len(own.acting), count, width)
        cross[:, own.acting] += sums.fitted - np.moveaxis(spanned, 0, 1)
    flat = np.moveaxis(cross, 0, 1).reshape(size, -1)
    reduced, _ = dtrtrs(found.factor, flat / found.scale[:, None], lower=1)
    return _judged(grams - _grams(reduced, width), right, squares)


class _Begun:
    """Sum products of one joint's columns over the rows from some first one on, for many first ones.

    Attributes
    ----------
    right, grams, fitted, free
        Products with what is left, with each other, with the fitted columns, and with the free ones.
    """

    def __init__(self, own: Whitened, left: Weights, first: Indices, width: int) -> None:
        self.own, self.left, self.first = own, left, first
        self.right = np.zeros((len(first), width))
        self.grams = np.zeros((len(first), width, width))
        self.fitted = np.zeros((len(first), len(own.acting), width))
        self.free = np.zeros((len(first), own.free.count, width))

    def add_tails(self, white: EquationRows, beyond: int) -> None:
        """Add all rows from so many beyond the first ones on."""
        after = np.minimum(self.first + beyond, len(white))
        self.right += _tails(self.left[:, None] * white)[after]
        self.grams += _tails(white[:, :, None] * white[:, None, :])[after]
        self.fitted += _tails(self.own.columns[:, :, None] * white[:, None, :])[after]
        loose = self.own.free.columns.toarray()
        self.free += _tails(loose[:, :, None] * white[:, None, :])[after]

    def add_heads(self, white: np.ndarray) -> None:
        """Add the rows just behind the first ones.

        Parameters
        ----------
        white
            The columns by how far a row is behind the first one, row, and column (see `_begun`).
        """
        behind = np.arange(len(white))
        rows = self.first[:, None] + behind
        there = rows < white.shape[1]
        rows = np.where(there, rows, 0)
        parts = white[behind, rows] * there[:, :, None]
        self.grams += np.swapaxes(parts, 1, 2) @ parts
        begins = len(white) * np.arange(len(rows) + 1)
        for axis, sizes in enumerate(np.moveaxis(parts, 2, 0)):
            heads = csr_array((sizes.ravel(), rows.ravel(), begins), shape=(len(rows), white.shape[1]))
            self.right[:, axis] += heads @ self.left
            self.fitted[:, :, axis] += heads @ self.own.columns
            self.free[:, :, axis] += (heads @ self.own.free.columns).toarray()


def _begun(own: Whitened, columns: EquationRows) -> np.ndarray:
    """Make columns white that begin some rows before: by how many before (first axis), and row."""
    out = np.zeros((own.noise.order, *columns.shape))
    for lag, white in enumerate(out):
        white[:] = out[lag - 1]
        white[lag:] += own.whitening.diagonal(-lag)[:, None] * columns[: len(columns) - lag]
    return out


def _tails(parts: np.ndarray) -> np.ndarray:
    """Sum from every row to the last one; after that nothing is left."""
    sums = np.zeros((len(parts) + 1, *parts.shape[1:]))
    np.cumsum(parts[::-1], axis=0, out=sums[-2::-1])
    return sums


def _grams(columns: Matrix, width: int) -> np.ndarray:
    """Give the Gram matrix of every so many columns."""
    parts = np.moveaxis(columns.reshape(len(columns), columns.shape[1] // width, width), 1, 0)
    return np.asarray(np.swapaxes(parts, 1, 2) @ parts)


def _judged(grams: np.ndarray, right: Matrix, squares: Matrix) -> list[Score]:
    """Judge candidates by what is left of their Gram matrices, and by their products with the residual."""
    size = np.sqrt(np.maximum(squares, 1e-300))
    left = grams / (size[:, :, None] * size[:, None, :])
    clear = np.clip(np.diagonal(left, axis1=1, axis2=2), 0.0, 1.0).max(axis=1)
    judged = np.isfinite(left).all(axis=(1, 2)) & (clear >= OPEN_SHARE)
    out = [_open(right.shape[1])] * len(right)
    values, vectors = np.linalg.eigh(left[judged])
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=values > OPEN_SHARE)
    spread = vectors / size[judged][:, :, None]
    turned = np.einsum("nij,ni->nj", spread, right[judged])
    covariance = np.einsum("nij,nj,nkj->nik", spread, inverse, spread)
    found = np.einsum("nij,nj->ni", spread, turned * inverse)
    for place, index in enumerate(np.flatnonzero(judged)):
        statistic = float(turned[place] ** 2 @ inverse[place])
        freedom = int(np.count_nonzero(inverse[place]))
        out[index] = Score(statistic, freedom, found[place], covariance[place], float(clear[index]))
    return out


def _open(width: int) -> Score:
    return Score(0.0, 1, np.zeros(width), np.eye(width), 0.0)
