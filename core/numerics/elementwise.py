"""Run chains of operations element by element, compiled: one pass in place of one per operation."""

# ruff: noqa: ANN001  # numba reads types from its own signatures, or infers them
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit, types

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
_SERIES = types.Array(types.float64, 1, "C", readonly=True)
_TABLE = types.Array(types.float64, 2, "C", readonly=True)
_OUT = types.Array(types.float64, 2, "C")
_SERIES_OUT = types.Array(types.float64, 1, "C")
_REACH = 3


@njit(types.void(types.UniTuple(_TABLE, 3), types.UniTuple(_SERIES, 3), _OUT), **_EXACT)
def add_products(tables, series, out) -> None:  # pragma: no cover  (compiled)
    """Add the sum of three tables, joints x samples, times a series each."""
    (first, second, third), (one, two, three) = tables, series
    for joint in range(out.shape[0]):
        for sample in range(out.shape[1]):
            total = first[joint, sample] * one[sample]
            total += second[joint, sample] * two[sample]
            out[joint, sample] += total + third[joint, sample] * three[sample]


@njit(types.void(_SERIES, types.float64, _SERIES_OUT), **_EXACT)
def differentiate_series(values, rate_hz, out) -> None:  # pragma: no cover  (compiled)
    """Write the derivative of a series of over three samples as `differentiate_throughout` takes it."""
    count, scale = len(values), rate_hz / 60.0
    longer = np.empty(count + 2 * _REACH)
    longer[_REACH : _REACH + count] = values
    for step in range(1, _REACH + 1):
        longer[_REACH - step] = 2.0 * values[0] - values[step]
        longer[_REACH + count - 1 + step] = 2.0 * values[count - 1] - values[count - 1 - step]
    for sample in range(count):
        one = longer[sample + 4] - longer[sample + 2]
        two = longer[sample + 5] - longer[sample + 1]
        three = longer[sample + 6] - longer[sample]
        out[sample] = (45.0 * one - 9.0 * two + three) * scale
