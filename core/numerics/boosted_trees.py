"""Grow boosted regression trees on binned columns, compiled: many small ensembles, without a layer between.

Every tree is fitted to what those before it leave. The leaf whose split takes most from the squares is split
first, between two bins of one column. Sources: Friedman, Ann. Stat. 29(5), 2001; Ke et al., NeurIPS 30, 2017
(sums per bin; those of the larger part of a leaf from those of the leaf and of the smaller part).
"""

# ruff: noqa: ANN001  # numba reads types from its own signatures, or infers them
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
_PART = {**_EXACT, "cache": False, "no_cpython_wrapper": True}


@njit(**_PART)
def _borders(ascending, quantiles, borders) -> int:  # pragma: no cover  (compiled)
    """Write the borders of bins, and give their number: halfway between few values, else at quantiles."""
    count, different = len(ascending), 1
    for place in range(1, count):
        if ascending[place] != ascending[place - 1]:
            if different <= len(quantiles):
                borders[different - 1] = (ascending[place - 1] + ascending[place]) / 2.0
            different += 1
    if different <= len(quantiles) + 1:
        return different - 1
    for number in range(len(quantiles)):
        rank = count * quantiles[number] - 1.0
        below = int(np.floor(rank))
        low, high = ascending[below], ascending[below + 1]
        borders[number] = high - (high - low) * 0.5 if rank == below else high
    return len(quantiles)


@njit("void(float64[:,::1], int64[:,::1], bool[::1], float64[::1], uint8[:,::1])", **_EXACT)
def sort_into_bins(columns, order, seen, quantiles, bins) -> None:  # pragma: no cover  (compiled)
    """Write the bin of every row and column; borders are quantiles of the rows that are seen.

    Parameters
    ----------
    columns
        Columns x rows, without NaN.
    order
        Per column, its rows by ascending value.
    seen
        Rows that decide where the borders are.
    quantiles
        Shares of these rows, ascending within 0 and 1; at least one row has to lie below each.
    bins
        Rows x columns.
    """
    ascending, borders = np.empty(len(seen)), np.empty(len(quantiles))
    for column in range(len(columns)):
        values, many = columns[column], 0
        for row in order[column]:
            if seen[row]:
                ascending[many] = values[row]
                many += 1
        last, number = _borders(ascending[:many], quantiles, borders), 0
        for row in order[column]:
            while number < last and values[row] > borders[number]:
                number += 1
            bins[row, column] = number


@njit(**_PART)
def _add_up(bins, left, leaf_of, leaf, sums) -> None:  # pragma: no cover  (compiled)
    """Write, per column and bin, the sum of what is left of a leaf's rows, and how many they are."""
    sums[:] = 0.0
    for row in range(len(left)):
        if leaf_of[row] == leaf:
            for column in range(bins.shape[1]):
                cell = sums[column, bins[row, column]]
                cell[0] += left[row]
                cell[1] += 1.0


@njit(**_PART)
def _find_split(sums, least, leaf) -> None:  # pragma: no cover  (compiled)
    """Write a leaf's best split: what it saves (0: none), its column, bin, and the sum and rows below."""
    total, count = leaf[0], leaf[1]
    leaf[2] = 0.0
    if count < 2 * least:
        return
    for column in range(sums.shape[0]):
        below, rows = 0.0, 0.0
        for number in range(sums.shape[1]):
            below += sums[column, number, 0]
            rows += sums[column, number, 1]
            if count - rows < least:
                break
            if rows >= least:
                above = total - below
                gain = below / rows * below - total / count * total + above / (count - rows) * above
                if gain > leaf[2]:
                    leaf[2], leaf[3], leaf[4], leaf[5], leaf[6] = gain, column, number, below, rows


@njit(**_PART)
def _move(bins, split, leaf_of, new) -> None:  # pragma: no cover  (compiled)
    """Move rows of a leaf into a new one: those up to a bin of a column, or those beyond it."""
    leaf, column, last, lower = int(split[0]), int(split[1]), split[2], split[3] > 0.0
    for row in range(len(leaf_of)):
        if leaf_of[row] == leaf and (bins[row, column] <= last) == lower:
            leaf_of[row] = new


@njit(**_PART)
def _grow(bins, left, leaf_of, least, sums, splits) -> np.ndarray:  # pragma: no cover  (compiled)
    """Grow one tree of at most as many splits as there is room for, and give what its leaves are.

    The smaller part of a leaf that is split becomes a new one, whose number is that of the split, from 1.
    """
    leaves = len(splits) + 1
    kept = np.zeros((leaves, 7))  # sum, rows, and the best split
    splits[:, 0] = -1.0  # no leaf
    leaf_of[:] = 0
    _add_up(bins, left, leaf_of, 0, sums[0])
    kept[0, 0], kept[0, 1] = sums[0, 0, :, 0].sum(), len(left)
    _find_split(sums[0], least, kept[0])
    for new in range(1, leaves):
        leaf = int(np.argmax(kept[:new, 2]))
        total, count, gain, column, last, below, rows = kept[leaf]
        if gain <= 0.0:
            break
        lower = 2.0 * rows < count
        split = splits[new - 1]
        split[0], split[1], split[2], split[3] = leaf, column, last, lower
        _move(bins, split, leaf_of, new)
        part, rest = (new, leaf) if lower else (leaf, new)
        kept[part, 0], kept[part, 1] = below, rows
        kept[rest, 0], kept[rest, 1] = total - below, count - rows
        if new < leaves - 1:
            _add_up(bins, left, leaf_of, new, sums[new])
            sums[leaf] -= sums[new]
            _find_split(sums[leaf], least, kept[leaf])
            _find_split(sums[new], least, kept[new])
    return kept


@njit("void(uint8[:,::1], float64[::1], UniTuple(int64, 4), float64, uint8[:,::1], float64[::1])", **_EXACT)
def boost(bins, target, sizes, rate, asked, predicted) -> None:  # pragma: no cover  (compiled)
    """Fit boosted trees to some rows, and write what they predict of others.

    Parameters
    ----------
    bins
        Rows x columns: the bin of each.
    sizes
        The numbers of trees, of leaves per tree, of rows per leaf at least, and of bins.
    rate
        Factor on what every tree adds.
    asked
        The other rows' bins.
    """
    trees, leaves, least, many = sizes
    sums, splits = np.empty((leaves, bins.shape[1], many, 2)), np.empty((leaves - 1, 4))
    leaf_of, own = np.zeros(len(bins), np.uint8), np.zeros(len(asked), np.uint8)
    reached, left = np.full(len(bins), target.mean()), np.empty(len(bins), np.float32)
    predicted[:] = target.mean()
    for _ in range(trees):
        for row in range(len(left)):
            left[row] = target[row] - reached[row]
        kept = _grow(bins, left, leaf_of, least, sums, splits)
        values = rate * (kept[:, 0] / np.maximum(kept[:, 1], 1.0))
        for row in range(len(left)):
            reached[row] += values[leaf_of[row]]
        own[:] = 0
        for number in range(len(splits)):
            _move(asked, splits[number], own, number + 1)
        for row in range(len(own)):
            predicted[row] += values[own[row]]
