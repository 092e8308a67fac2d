"""Run recursions along series, compiled: each value needs those before it, which no array operation gives.

Sources: Burg 1975 (reflections); Golub & Van Loan, Matrix Computations, ch. 4.3 (banded factors).
"""

# ruff: noqa: ANN001  # numba reads types from its own signatures, or infers them
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
_SUMS = {**_EXACT, "fastmath": {"contract", "nsz", "arcp", "reassoc"}}
_PART = {**_SUMS, "cache": False, "no_cpython_wrapper": True}


@njit("int64(float64[::1], int64[::1], float64, int64, float64[:,::1], float64[::1])", **_SUMS)
def reflect(residual, past, forgotten, fewest, predictors, variances) -> int:  # pragma: no cover  (compiled)
    """Write the best predictors of a series from 0, 1, ... past values, and their innovations' variances.

    Parameters
    ----------
    past
        Per value, how many values of its run precede it.
    forgotten
        Share by which correlations with the past are taken for smaller.
    fewest
        Values per order that have as many before them, or the order is left out, and those above it.
    predictors
        Orders x past values, latest first; row n has n values. As many rows as `variances`.

    Returns
    -------
    int
        The highest order.
    """
    ahead, back = residual.copy(), residual.copy()
    square = 0.0
    for row in range(len(residual)):
        square += residual[row] * residual[row]
    variances[0] = max(square / max(len(residual), 1), 1e-300)
    for order in range(1, len(variances)):
        both, cross, count = 0.0, 0.0, 0
        for row in range(order, len(residual)):
            inside = 1.0 if past[row] >= order else 0.0
            both += inside * (ahead[row] * ahead[row] + back[row - 1] * back[row - 1])
            cross += inside * ahead[row] * back[row - 1]
            count += past[row] >= order
        if both <= 0.0 or count < fewest * order:
            return order - 1
        reflection = 2.0 * cross / (both * (1.0 + forgotten))
        for lag in range(order - 1):
            before = predictors[order - 1]
            predictors[order, lag] = before[lag] - reflection * before[order - 2 - lag]
        predictors[order, order - 1] = reflection
        variances[order] = variances[order - 1] * (1.0 - reflection * reflection)
        # From behind, because what is written of one row is read for the next.
        for row in range(len(residual) - 1, order - 1, -1):
            later, earlier = ahead[row], back[row - 1]
            ahead[row] = later - reflection * earlier
            back[row] = earlier - reflection * later
    return len(variances) - 1


@njit("void(float64[::1], int64[::1], float64[:,::1], float64[::1])", **_SUMS)
def innovate(residual, past, weights, innovations) -> None:  # pragma: no cover  (compiled)
    """Write what is new in a series: its values and those before them by the weights for as many as known.

    Parameters
    ----------
    past
        Per value, how many values of its run precede it.
    weights
        Known values x lags: the last row is for as many as it has lags, and for more.
    """
    most = len(weights) - 1
    for row in range(len(residual)):
        known = min(past[row], most)
        total = 0.0
        for lag in range(known + 1):
            total += weights[known, lag] * residual[row - lag]
        innovations[row] = total


@njit(inline="always")
def _innovate_row(row, known, columns, weights) -> np.ndarray:
    """Give what is new in one row of columns, of which so many rows before it are not zero."""
    new = np.zeros(columns.shape[1])
    for lag in range(known + 1):
        for column in range(len(new)):
            new[column] += weights[lag] * columns[row - lag, column]
    return new


@njit(**_PART)
def _add_row(row, known, rows, sums, products) -> None:
    """Add the products of one row of columns, of which so many rows before it are not zero."""
    columns, past, weights, left, fitted, sizes, loose, begins = rows
    right, squares, grams, cross = sums
    white = _innovate_row(row, known, columns, weights[min(past[row], len(weights) - 1)])
    width = len(white)
    for tested in range(width):
        right[tested] += left[row] * white[tested]
        squares[tested] += white[tested] * white[tested]
        for other in range(width):
            grams[tested, other] += white[tested] * white[other]
    for column in range(fitted.shape[1]):
        for tested in range(width):
            cross[column, tested] += fitted[row, column] * white[tested]
    for at in range(begins[row], begins[row + 1]):
        for tested in range(width):
            products[loose[at], tested] += sizes[at] * white[tested]


@njit(**_PART)
def _solve(products, factor, low, high) -> None:
    """Turn products with some loose columns into products with orthonormal ones that span the same."""
    width = products.shape[1]
    for column in range(low, high):
        for tested in range(width):
            products[column, tested] /= factor[column, 0]
        for beyond in range(1, min(factor.shape[1], high - column)):
            for tested in range(width):
                products[column + beyond, tested] -= factor[column, beyond] * products[column, tested]


@njit(**_PART)
def _subtract_spanned(sums, products, inside, low, high) -> None:
    """Take out what some orthonormal columns span, of which the products with them are given."""
    _, _, grams, cross = sums
    width = products.shape[1]
    for column in range(low, high):
        for tested in range(width):
            for other in range(width):
                grams[tested, other] -= products[column, tested] * products[column, other]
        for fitted in range(inside.shape[1]):
            for tested in range(width):
                cross[fitted, tested] -= inside[column, fitted] * products[column, tested]


@njit(inline="always")
def _copy_sums(sums, own) -> None:
    """Write sums over rows into a table's rows for them; numba compiles loops sooner than slices."""
    for tested in range(len(sums[0])):
        own[0][tested], own[1][tested] = sums[0][tested], sums[1][tested]
        for other in range(len(sums[0])):
            own[2][tested, other] = sums[2][tested, other]
        for fitted in range(len(sums[3])):
            own[3][fitted, tested] = sums[3][fitted, tested]


_ROWS = (
    "Tuple((float64[:,::1], int64[::1], float64[:,::1], float64[::1], float64[:,::1], float64[::1],"
    " int32[::1], int32[::1]))"
)
_RANGES = "Tuple((int64[::1], int64[::1], boolean[::1]))"
_PRODUCTS = "Tuple((float64[:,::1], float64[:,::1], float64[:,:,::1], float64[:,:,::1]))"


@njit(f"void({_ROWS}, {_RANGES}, float64[:,::1], float64[:,::1], int64[::1], {_PRODUCTS})", **_SUMS)
def _sum_with_ranges(rows, ranges, factor, inside, first, products) -> None:  # pragma: no cover  (compiled)
    """Write what `sum_from_onsets` does, with the ranges of loose columns."""
    columns, fitted, most = rows[0], rows[4], len(rows[2]) - 1
    (count, width), many = columns.shape, len(factor)
    lowest, above, group = ranges
    sums = (np.zeros(width), np.zeros(width), np.zeros((width, width)), np.zeros((fitted.shape[1], width)))
    seen, parts = np.zeros((many, width)), np.zeros((many, width))
    summed, known = count, many
    for number in range(len(first) - 1, -1, -1):
        begin = first[number]
        while summed > min(begin + most, count):
            summed -= 1
            _add_row(summed, min(rows[1][summed], most), rows, sums, seen)
        low, high = lowest[begin], max(above[summed], lowest[begin])
        while not group[high]:
            high += 1
        _solve(seen, factor, high, known)
        _subtract_spanned(sums, seen, inside, high, known)
        known = min(known, high)
        own = (products[0][number], products[1][number], products[2][number], products[3][number])
        _copy_sums(sums, own)
        for column in range(low, high):
            for tested in range(width):
                parts[column, tested] = seen[column, tested]
        for row in range(begin, summed):
            _add_row(row, min(rows[1][row], most, row - begin), rows, own, parts)
        _solve(parts, factor, low, high)
        _subtract_spanned(own, parts, inside, low, high)


def sum_from_onsets(
    rows: tuple[np.ndarray, ...],
    factor: np.ndarray,
    inside: np.ndarray,
    first: np.ndarray,
    products: tuple[np.ndarray, ...],
) -> None:
    """Write the products of columns that are zero before some row, made white, for many such rows.

    Beyond the order of the noise model, prewhitened rows do not depend on where the columns begin: those
    rows are summed from the last one back. Loose columns come in groups that share no rows, and only the
    span of the group in which the columns begin differs.

    Parameters
    ----------
    rows
        Columns (rows x columns); how many rows of its run precede each; what makes columns white (see
        `innovate`); white rows that these are multiplied by, one column and many; and white loose columns,
        which stand for anything, in the order of time: as compressed rows, sizes, columns and begins.
    factor
        The banded factor of the loose columns' products (columns x band, the diagonal first).
    inside
        What these span of the many, along orthonormal axes.
    first
        The rows, in rising order.
    products
        Products with the one column, of each column with itself, of all with each other, and with the many;
        of the last two only what the loose columns do not span.
    """
    _sum_with_ranges(rows, _ranges(rows[6], rows[7], factor), factor, inside, first, products)


def _ranges(loose: np.ndarray, begins: np.ndarray, factor: np.ndarray) -> tuple[np.ndarray, ...]:
    """Give the lowest loose column that acts from each row on, one above the highest before it; and groups.

    A group begins at a column before which none is tied to it, or to one behind it.
    """
    many, band = factor.shape
    lowest = np.append(np.minimum.accumulate(loose[::-1])[::-1], many)[begins]
    above = np.append(0, np.maximum.accumulate(loose) + 1)[begins]
    tied = np.arange(many) + (np.arange(band) * (factor != 0.0)).max(axis=1)
    return lowest, above, np.append(True, np.maximum.accumulate(tied) < np.arange(1, many + 1))
