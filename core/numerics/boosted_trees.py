"""Predict a number from many coordinates by boosted regression trees, compiled.

Every tree splits at quantiles of a coordinate, the leaf that gains most first, and predicts a share of what
the trees before it leave. The arithmetic is that of scikit-learn's histogram gradient boosting, down to the
last bit; but a fit to some thousand rows costs a quarter of it.
Sources: Friedman, Ann. Stat. 29(5), 2001 (boosting); Ke et al., NeurIPS 2017 (histograms, best leaf first).
"""

# ruff: noqa: ANN001  # numba reads types from its own signatures, or infers them
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

from dataclasses import dataclass

import numpy as np
from numba import njit

from ..arrays import Matrix, Vector

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
_PART = {**_EXACT, "cache": False, "no_cpython_wrapper": True}


@dataclass(frozen=True)
class TreeShape:
    """State how many trees are grown, and how large."""

    trees: int
    leaves: int
    leaf_rows: int
    """Rows of a leaf at least."""
    rate: float
    """Factor on what every tree adds."""
    quantiles: int
    """Parts of equal counts that a coordinate is cut into, 127 at most: trees split between them."""


def predict_by_trees(known: Matrix, target: Vector, asked: Matrix, shape: TreeShape) -> Vector:
    """Learn a target from known rows, and predict it at others.

    Parameters
    ----------
    known, asked
        Rows x coordinates, all finite.

    Examples
    --------
    >>> known = np.arange(100.0)[:, None]
    >>> shape = TreeShape(trees=40, leaves=2, leaf_rows=20, rate=0.5, quantiles=63)
    >>> step = np.where(known[:, 0] < 50.0, -1.0, 3.0)
    >>> predict_by_trees(known, step, np.array([[10.0], [90.0]]), shape).round(6)
    array([-1.,  3.])
    """
    edges = _edges(known, shape.quantiles)
    features, mean = np.ascontiguousarray(np.vstack([known, asked]).T), float(target.mean())
    guess = np.full(len(known) + len(asked), mean)
    sizes = np.array([shape.trees, shape.leaves, shape.leaf_rows, shape.quantiles + 1])
    _boost(_places(features, edges), np.ascontiguousarray(target), sizes, shape.rate, guess)
    return guess[len(known) :]


def _edges(known: Matrix, quantiles: int) -> Matrix:
    """Give, per coordinate, the values between its parts in rising order, and infinity for those it lacks."""
    ordered = np.sort(known, axis=0)
    edges = np.full((known.shape[1], quantiles - 1), np.inf)
    shares = np.linspace(0, 100, num=quantiles + 1)[1:-1]
    inner = np.percentile(ordered, shares, axis=0, method="averaged_inverted_cdf").T
    for own, values, between in zip(edges, ordered.T, inner, strict=True):
        different = values[np.append(True, values[1:] > values[:-1])]
        few = len(different) <= quantiles
        cuts = 0.5 * (different[1:] + different[:-1]) if few else np.unique(between)
        own[: len(cuts)] = cuts
    return edges


@njit("uint8[:,::1](float64[:,::1], float64[:,::1])", **_EXACT)
def _places(features, edges) -> np.ndarray:  # pragma: no cover  (compiled)
    """Give, per coordinate and row, how many edges lie below the value."""
    places = np.empty(features.shape, dtype=np.uint8)
    for feature in range(len(features)):
        for row in range(features.shape[1]):
            low, high = 0, edges.shape[1]
            while low < high:
                middle = (low + high) // 2
                if features[feature, row] <= edges[feature, middle]:
                    high = middle
                else:
                    low = middle + 1
            places[feature, row] = low
    return places


@njit(**_PART)
def _add_up(places, slopes, leaf, wanted, sums, counts) -> None:
    """Write the sums of a leaf's slopes in every part of every coordinate, and how many rows it has."""
    rows = np.flatnonzero(leaf[: len(slopes)] == wanted)
    for feature in range(len(places)):
        for place in range(sums.shape[1]):
            sums[feature, place] = 0.0
            counts[feature, place] = 0.0
        for row in rows:
            place = places[feature, row]
            sums[feature, place] += slopes[row]
            counts[feature, place] += 1.0


@njit(**_PART)
def _separate(sums, counts, old, new, small) -> None:
    """Take the sums of one part of a leaf, which stand in the new one's place, from those of the whole."""
    for feature in range(sums.shape[1]):
        for place in range(sums.shape[2]):
            part, rows = sums[new, feature, place], counts[new, feature, place]
            rest, others = sums[old, feature, place] - part, counts[old, feature, place] - rows
            sums[small, feature, place], counts[small, feature, place] = part, rows
            sums[old + new - small, feature, place], counts[old + new - small, feature, place] = rest, others


@njit(**_PART)
def _find_split(sums, counts, node, least, split) -> None:
    """Write where a leaf is best split: the gain, coordinate, last part below, and what lies below.

    `node` holds the leaf's slope, rows and value.
    """
    slope, rows, value = node[0], node[1], node[2]
    split[0] = 0.0
    for feature in range(len(sums)):
        below, many = 0.0, 0.0
        for place in range(sums.shape[1]):
            below += sums[feature, place]
            many += counts[feature, place]
            if many < least:
                continue
            if rows - many < least:
                break
            above = slope - below
            gain = slope * value - below * (-below / many) - above * (-above / (rows - many))
            if gain > split[0]:
                split[0], split[1], split[2], split[3], split[4] = gain, feature, place, below, many


@njit(**_PART)
def _describe(node, slope, rows) -> None:
    node[0], node[1], node[2] = slope, rows, -slope / rows


@njit(**_PART)
def _sum_by_eight(values) -> float:
    """Sum values in the order in which numpy sums up to 128 of them: eight sums, then these by pairs."""
    lanes, even = np.zeros(8), len(values) - len(values) % 8
    for place in range(even):
        lanes[place % 8] += values[place]
    total = ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]))
    for place in range(even, len(values)):
        total += values[place]
    return float(total)


@njit(**_PART)
def _grow(places, slopes, leaf, least, nodes, tables) -> None:
    """Grow a tree, the leaf that gains most first: write each row's leaf, and each leaf's node."""
    sums, counts, splits = tables
    leaf[:] = 0
    _add_up(places, slopes, leaf, 0, sums[0], counts[0])
    _describe(nodes[0], _sum_by_eight(sums[0, 0]), float(len(slopes)))
    nodes[0, 2] = 0.0
    for new in range(1, len(nodes)):
        splits[new, 0] = 0.0
    _find_split(sums[0], counts[0], nodes[0], least, splits[0])
    for new in range(1, len(nodes)):
        old = np.argmax(splits[:, 0])
        if splits[old, 0] <= 0.0:
            break
        feature, below, many = int(splits[old, 1]), splits[old, 3], splits[old, 4]
        for row in range(len(leaf)):
            if leaf[row] == old and places[feature, row] > splits[old, 2]:
                leaf[row] = new
        _describe(nodes[new], nodes[old, 0] - below, nodes[old, 1] - many)
        _describe(nodes[old], below, many)
        if new < len(nodes) - 1:
            small = old if many < nodes[new, 1] else new
            _add_up(places, slopes, leaf, small, sums[new], counts[new])
            _separate(sums, counts, old, new, small)
            for child in (old, new):
                _find_split(sums[child], counts[child], nodes[child], least, splits[child])


@njit("void(uint8[:,::1], float64[::1], int64[::1], float64, float64[::1])", **_EXACT)
def _boost(places, target, sizes, rate, guess) -> None:  # pragma: no cover  (compiled)
    """Add to the guess of all rows what trees predict that are grown on the first ones, which have a target.

    `sizes` are the numbers of trees, of leaves, of a leaf's rows at least, and of a coordinate's parts.
    """
    trees, leaves, least, parts = sizes
    shape = (leaves, len(places), parts)
    tables = np.zeros(shape), np.zeros(shape), np.zeros((leaves, 5))
    slopes, leaf = np.empty(len(target), np.float32), np.empty(len(guess), np.int64)
    nodes = np.zeros((leaves, 3))
    for _ in range(trees):
        for row in range(len(target)):
            slopes[row] = np.float32(guess[row] - target[row])
        _grow(places, slopes, leaf, least, nodes, tables)
        for row in range(len(guess)):
            guess[row] += nodes[leaf[row], 2] * rate
