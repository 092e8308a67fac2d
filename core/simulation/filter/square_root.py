"""Renew the triangular factor of a covariance, compiled: after a step and after one measured number.

Sources: Carlson, AIAA J. 11(9), 1973 (triangular update by a measurement); Golub & Van Loan, ch. 5.
"""

# ruff: noqa: ANN001  # numba: types stand in signatures
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

INNER = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "error_model": "numpy"}


@njit(**INNER)
def make_triangular(rows, width) -> None:
    """Turn rows into their upper triangular factor, in place of the first of them (Householder)."""
    for c in range(width):
        norm = 0.0
        for r in range(c, len(rows)):
            norm += rows[r, c] ** 2
        norm = np.sqrt(norm)
        if norm == 0.0:
            continue
        own = -norm if rows[c, c] > 0.0 else norm
        first = rows[c, c] - own
        for d in range(c + 1, width):
            product = first * rows[c, d]
            for r in range(c + 1, len(rows)):
                product += rows[r, c] * rows[r, d]
            product /= own * first
            rows[c, d] += product * first
            for r in range(c + 1, len(rows)):
                rows[r, d] += product * rows[r, c]
        rows[c, c] = own


@njit(**INNER)
def take_in(mean, factor, position, place, variance) -> float:
    """Take in one measured number of the state; gives what was not foreseen of it, in its deviations.

    Columns of the triangle stand in the factor's rows.
    """
    size, spread = len(mean), variance
    gain = np.zeros(size)
    for i in range(place, -1, -1):
        own = factor[i, place]
        wider = spread + own * own
        keep, share = np.sqrt(spread / wider), own / np.sqrt(spread * wider)
        for c in range(i, size):
            old = factor[i, c]
            factor[i, c] = keep * old - share * gain[c]
            gain[c] += own * old
        spread = wider
    missed = position - mean[place]
    for c in range(size):
        mean[c] += gain[c] * missed / spread
    return float(missed / np.sqrt(spread))
