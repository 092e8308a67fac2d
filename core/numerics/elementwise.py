"""Run chains of operations element by element, compiled: one pass in place of one per operation."""

# ruff: noqa: ANN001  # numba reads types from its own signatures, or infers them
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

from numba import njit, types

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
_SERIES = types.Array(types.float64, 1, "C", readonly=True)
_TABLE = types.Array(types.float64, 2, "C", readonly=True)
_OUT = types.Array(types.float64, 2, "C")


@njit(types.void(types.UniTuple(_TABLE, 3), types.UniTuple(_SERIES, 3), _OUT), **_EXACT)
def add_products(tables, series, out) -> None:  # pragma: no cover  (compiled)
    """Write the sum of three tables, joints x samples, times a series each."""
    (first, second, third), (one, two, three) = tables, series
    for joint in range(out.shape[0]):
        for sample in range(out.shape[1]):
            total = first[joint, sample] * one[sample]
            total += second[joint, sample] * two[sample]
            out[joint, sample] = total + third[joint, sample] * three[sample]
