"""Carry decaying sums from block to block of many series, compiled: each needs those of the one beside it."""

# ruff: noqa: ANN001  # numba reads types from its own signatures
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

from numba import njit


@njit(
    "void(float64[:,:,::1], int64, complex128[::1], float64[:,:,::1])",
    nogil=True,
    cache=True,
    no_cfunc_wrapper=True,
    error_model="numpy",
)
def carry_decays(added, first, decays, carried) -> None:  # pragma: no cover  (compiled)
    """Write the decaying sums of what blocks add, before each block, and of what those behind it add.

    Parameters
    ----------
    added
        Series x blocks x (others, then real and imaginary parts of what goes forwards, then back).
    first
        How many others there are.
    decays
        What is left of each sum after a block.
    carried
        Series x blocks x (real and imaginary parts of both sums).
    """
    series, blocks, _ = added.shape
    many = len(decays)
    for row in range(series):
        for mode in range(many):
            cosine, sine = decays[mode].real, decays[mode].imag
            real, imaginary = 0.0, 0.0
            for block in range(blocks):
                carried[row, block, mode], carried[row, block, many + mode] = real, imaginary
                one, other = added[row, block, first + mode], added[row, block, first + many + mode]
                real, imaginary = (
                    cosine * real - sine * imaginary + one,
                    sine * real + cosine * imaginary + other,
                )
            real, imaginary = 0.0, 0.0
            behind = first + 2 * many + mode
            for back in range(blocks):
                block = blocks - 1 - back
                carried[row, block, 2 * many + mode], carried[row, block, 3 * many + mode] = real, imaginary
                one, other = added[row, block, behind], added[row, block, behind + many]
                real, imaginary = (
                    cosine * real - sine * imaginary + one,
                    sine * real + cosine * imaginary + other,
                )
