"""Hold columns that are zero on all but a few rows, and prewhiten and multiply them, compiled.

For products of some thousand numbers the general routines for sparse matrices mostly check and allocate.
"""

# ruff: noqa: ANN001  # numba reads types from its own signatures, or infers them
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from scipy.sparse import csr_array

from ..arrays import EquationRows, Indices, Matrix, SquareMatrix, Vector, Weights

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
_SUMS = {**_EXACT, "fastmath": {"contract", "nsz", "arcp", "reassoc"}}


_Short = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class ShortColumns:
    """Hold columns as compressed rows."""

    values: Vector
    places: np.ndarray
    """Values other than zero row after row, and which columns they belong to."""
    begins: np.ndarray
    """Where each row begins among them, and the end of the last."""
    count: int

    def norms(self) -> Weights:
        """Give the columns' Euclidean norms."""
        return np.sqrt(np.bincount(self.places, self.values**2, minlength=self.count))

    def over(self, sizes: Weights) -> "ShortColumns":
        """Divide columns by sizes."""
        return replace(self, values=self.values / sizes[self.places])

    def prewhitened(self, past: Indices, weights: SquareMatrix) -> "ShortColumns":
        """Give what `prewhitened` makes of the columns."""
        values, places, begins = _prewhiten_short(
            self.values, self.places, self.begins, self.count, past, weights
        )
        return ShortColumns(values, places, begins, self.count)

    def combined(self, coefficients: Matrix) -> EquationRows:
        """Give combinations of the columns, a column of coefficients each."""
        found = _combine(self.values, self.places, self.begins, np.ascontiguousarray(coefficients))
        return np.asarray(found)

    def products(self, rows: Matrix) -> EquationRows:
        """Give the products with columns over the same rows: own columns x others."""
        found = _multiply(self.values, self.places, self.begins, self.count, np.ascontiguousarray(rows))
        return np.asarray(found)

    def banded_gram(self) -> Matrix:
        """Give the products with each other and with the columns behind: band x columns."""
        return np.asarray(_banded_gram(self.values, self.places, self.begins, self.count))


def short_columns(columns: csr_array) -> ShortColumns:
    """Take columns from a sparse array."""
    places, begins = (part.astype(np.int32) for part in (columns.indices, columns.indptr))
    return ShortColumns(columns.data, places, begins, int(columns.shape[1]))


def prewhitened(rows: Matrix, past: Indices, weights: SquareMatrix) -> Matrix:
    """Combine each row of columns with those before it, by the weights for as many as are known.

    Parameters
    ----------
    past
        Per row, how many rows of its run precede it.
    weights
        Known rows x lags: the last row is for as many as it has lags, and for more.
    """
    return np.asarray(_prewhiten(np.ascontiguousarray(rows), past, weights))


@njit(inline="always")
def _add(total, factor, row) -> None:
    for place in range(len(total)):
        total[place] += factor * row[place]


@njit(inline="always")
def _add_four(total, factors, rows) -> None:
    """Add the last of four rows first: the sums are those of one after the other, and stored once."""
    first, second, third, fourth = rows[3], rows[2], rows[1], rows[0]
    for place in range(len(total)):
        once = total[place] + factors[0] * first[place]
        twice = once + factors[1] * second[place]
        thrice = twice + factors[2] * third[place]
        total[place] = thrice + factors[3] * fourth[place]


@njit("float64[:,::1](float64[:,::1], int64[::1], float64[:,::1])", **_EXACT)
def _prewhiten(rows, past, weights) -> np.ndarray:  # pragma: no cover  (compiled)
    most = len(weights) - 1
    white = np.zeros(rows.shape)
    for row in range(len(rows)):
        known = min(past[row], most)
        if rows.shape[1] == 1:
            total = 0.0
            for lag in range(known + 1):
                total += weights[known, lag] * rows[row - lag, 0]
            white[row, 0] = total
            continue
        last = known + 1 - (known + 1) % 4
        for lag in range(0, last, 4):
            _add_four(white[row], weights[known, lag : lag + 4], rows[row - lag - 3 : row - lag + 1])
        for lag in range(last, known + 1):
            _add(white[row], weights[known, lag], rows[row - lag])
    return white


@njit(
    "Tuple((float64[::1], int32[::1], int32[::1]))"
    "(float64[::1], int32[::1], int32[::1], int64, int64[::1], float64[:,::1])",
    **_EXACT,
)
def _prewhiten_short(values, places, begins, many, past, weights) -> _Short:  # pragma: no cover  (compiled)
    """Write in each row first what columns were met last, in the rows before."""
    most, room = len(weights) - 1, 0
    for row in range(len(past)):
        room += begins[row + 1] - begins[row - min(past[row], most)]
    white, columns, starts = np.empty(room), np.empty(room, np.int32), np.zeros(len(begins), np.int32)
    totals, is_met, met = np.zeros(many), np.zeros(many, np.bool_), np.empty(many, np.int32)
    for row in range(len(past)):
        known, count = min(past[row], most), 0
        for lag in range(known + 1):
            for at in range(begins[row - lag], begins[row - lag + 1]):
                column = places[at]
                if not is_met[column]:
                    is_met[column], met[count] = True, column
                    count += 1
                totals[column] += weights[known, lag] * values[at]
        starts[row + 1] = starts[row] + count
        for place in range(count):
            column = met[count - 1 - place]
            white[starts[row] + place], columns[starts[row] + place] = totals[column], column
            totals[column], is_met[column] = 0.0, False
    return white[: starts[-1]].copy(), columns[: starts[-1]].copy(), starts


@njit("float64[:,::1](float64[::1], int32[::1], int32[::1], float64[:,::1])", **_EXACT)
def _combine(values, places, begins, coefficients) -> np.ndarray:  # pragma: no cover  (compiled)
    out = np.zeros((len(begins) - 1, coefficients.shape[1]))
    for row in range(len(out)):
        if coefficients.shape[1] == 1:
            total = 0.0
            for at in range(begins[row], begins[row + 1]):
                total += values[at] * coefficients[places[at], 0]
            out[row, 0] = total
            continue
        for at in range(begins[row], begins[row + 1]):
            _add(out[row], values[at], coefficients[places[at]])
    return out


@njit("float64[:,::1](float64[::1], int32[::1], int32[::1], int64, float64[:,::1])", **_EXACT)
def _multiply(values, places, begins, many, rows) -> np.ndarray:  # pragma: no cover  (compiled)
    out = np.zeros((many, rows.shape[1]))
    for row in range(len(rows)):
        if rows.shape[1] == 1:
            for at in range(begins[row], begins[row + 1]):
                out[places[at], 0] += values[at] * rows[row, 0]
            continue
        for at in range(begins[row], begins[row + 1]):
            _add(out[places[at]], values[at], rows[row])
    return out


@njit("float64[:,::1](float64[::1], int32[::1], int32[::1], int64)", **_SUMS)
def _banded_gram(values, places, begins, many) -> np.ndarray:  # pragma: no cover  (compiled)
    band = 1
    for row in range(len(begins) - 1):
        first, last = many, 0
        for at in range(begins[row], begins[row + 1]):
            first, last = min(first, places[at]), max(last, places[at])
        band = max(band, 1 + last - first)
    products = np.zeros((band, many))
    for row in range(len(begins) - 1):
        for at in range(begins[row], begins[row + 1]):
            for other in range(begins[row], begins[row + 1]):
                if places[other] >= places[at]:
                    products[places[other] - places[at], places[at]] += values[at] * values[other]
    return products
