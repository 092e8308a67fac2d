"""Run a linear system of few states through a series of inputs, compiled: each state needs the one before."""

# ruff: noqa: ANN001  # numba reads types from its own signatures
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

from numba import njit

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}


@njit("void(float64[:,::1], float64[::1], float64[::1], float64[::1], float64[:,::1])", **_EXACT)
def run_states(transition, last, next_, inputs, states) -> None:  # pragma: no cover  (compiled)
    """Write the states x[k] = F x[k-1] + g0 u[k-1] + g1 u[k]; the first row of `states` is where they begin.

    Parameters
    ----------
    transition
        F, states x states.
    last, next_
        g0 and g1: what the input at the last sample and at this one adds.
    inputs
        One value per sample.
    states
        Samples x states.
    """
    size = len(transition)
    for k in range(1, len(inputs)):
        for i in range(size):
            total = last[i] * inputs[k - 1] + next_[i] * inputs[k]
            for j in range(size):
                total += transition[i, j] * states[k - 1, j]
            states[k, i] = total
