"""Factorise and solve many small symmetric systems at once, compiled, with the state's index innermost.

The lower triangle of a state's matrix lies in rows i * joints + j of a table; its Cholesky factor takes its
place. A matrix that is not positive definite leaves nan behind. Source: Golub & Van Loan, ch. 4.2.
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit


@njit(inline="always")
def _sub_product(out, row, table, left, other, right, count) -> None:
    """Subtract the product of two rows."""
    for s in range(count):
        out[row, s] -= table[left, s] * other[right, s]


@njit(inline="always")
def less_mass_times(out, mass, vector, joints, begin, count) -> None:
    """Subtract the mass matrix times a vector."""
    for i in range(joints):
        for j in range(joints):
            row = np.uintp(max(i, j) * joints + min(i, j))
            for s in range(count):
                out[np.uintp(i), s] -= mass[row, s] * vector[np.uintp(j), begin + s]


@njit(inline="always")
def factorise(mass, scale, joints, count) -> None:
    """Turn the lower triangle into its Cholesky factor; `scale` gets one over its diagonal."""
    for j in range(joints):
        for i in range(j, joints):
            own = np.uintp(i * joints + j)
            for k in range(j):
                _sub_product(mass, own, mass, np.uintp(i * joints + k), mass, np.uintp(j * joints + k), count)
        own = np.uintp(j * joints + j)
        for s in range(count):
            scale[np.uintp(j), s] = 1.0 / np.sqrt(mass[own, s])
        for i in range(j + 1, joints):
            own = np.uintp(i * joints + j)
            for s in range(count):
                mass[own, s] *= scale[np.uintp(j), s]


@njit(inline="always")
def substitute(vector, factor, scale, joints, count) -> None:
    """Solve with the Cholesky factor in place."""
    for i in range(joints):
        for k in range(i):
            _sub_product(vector, np.uintp(i), factor, np.uintp(i * joints + k), vector, np.uintp(k), count)
        for s in range(count):
            vector[np.uintp(i), s] *= scale[np.uintp(i), s]
    for i in range(joints - 1, -1, -1):
        for k in range(i + 1, joints):
            _sub_product(vector, np.uintp(i), factor, np.uintp(k * joints + i), vector, np.uintp(k), count)
        for s in range(count):
            vector[np.uintp(i), s] *= scale[np.uintp(i), s]


@njit(inline="always")
def solve_one(vector, factor, scale, s, joints) -> None:
    """Solve one state's equations in place."""
    for i in range(joints):
        for k in range(i):
            vector[i] -= factor[i * joints + k, s] * vector[k]
        vector[i] *= scale[i, s]
    for i in range(joints - 1, -1, -1):
        for k in range(i + 1, joints):
            vector[i] -= factor[k * joints + i, s] * vector[k]
        vector[i] *= scale[i, s]
