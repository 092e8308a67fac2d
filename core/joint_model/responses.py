"""Filter sampled series by transfer functions in continuous time, exactly for what holds between samples.

All powers of s over one denominator come from one pass: they are the states of its controllable companion
form. A torque is held from one sample to the next (zero-order hold), as a digital controller does; a position
runs straight between two (first-order hold). Source: Franklin, Powell & Workman 1998, Digital Control of
Dynamic Systems, ch. 4 and 6.
"""

from functools import lru_cache
from typing import Final, Literal

import numpy as np
from scipy.linalg import expm

from ..arrays import Matrix, Samples, SquareMatrix, Vector
from ..numerics.state_recursion import run_states

Hold = Literal["zero", "first"]
_UNSTABLE = 1e-9
"""Real part of a pole, as a share of its size, above which it does not decay."""
_SLOWEST = 1e-6
"""Decay that a pole without any is given, per unit of time."""
_KEPT: Final = 64
"""Filters that are kept sampled: a step of an estimation asks for few, and for each many times."""


def companion(denominator: Vector) -> SquareMatrix:
    """Give the matrix whose states are 1, s, s^2 ... over a monic polynomial, highest power first.

    Examples
    --------
    >>> companion(np.array([1.0, 3.0, 2.0]))
    array([[ 0.,  1.],
           [-2., -3.]])
    """
    order = len(denominator) - 1
    matrix = np.eye(order, k=1)
    matrix[-1] = -denominator[:0:-1]
    return matrix


def sampled(system: SquareMatrix, inputs: Matrix, step: float) -> tuple[SquareMatrix, Matrix, Matrix]:
    """Give the transition over a step, and what inputs add: held ones, and those that rise by one.

    Parameters
    ----------
    inputs
        States x inputs.
    """
    states, count = inputs.shape
    whole = np.zeros((states + 2 * count, states + 2 * count))
    whole[:states, :states], whole[:states, states : states + count] = step * system, step * inputs
    whole[states : states + count, states + count :] = np.eye(count)
    power = expm(whole)
    return (
        np.ascontiguousarray(power[:states, :states]),
        power[:states, states : states + count],
        power[:states, states + count :],
    )


def powers(denominator: Vector, series: Samples, step: float, hold: Hold) -> Matrix:
    """Give s^i / A times a series, i from 0 to the order of A, as columns; all begin at rest.

    Parameters
    ----------
    denominator
        A, monic, highest power first.
    step
        Time between samples.
    """
    states = lower_powers(denominator, series, step, hold)
    return np.column_stack([states, series - states @ denominator[:0:-1]])


def lower_powers(denominator: Vector, series: Samples, step: float, hold: Hold) -> Matrix:
    """Give the same without the highest power, which takes a pass of its own."""
    transition, held, rising = _sampled_filter(tuple(denominator.tolist()), step)
    last, new = (held - rising, rising) if hold == "first" else (held, np.zeros_like(held))
    states = np.zeros((len(series), len(held)))
    run_states(transition, last, new, np.ascontiguousarray(series, dtype=float), states)
    return states


def feedthrough(numerator: Vector, denominator: Vector, step: float) -> float:
    """Give by how much a sample enters B / A times its own series under first-order hold, at once.

    B is as long as A, and monic as well.
    """
    _, _, rising = _sampled_filter(tuple(denominator.tolist()), step)
    return float(1.0 + rising @ (numerator - denominator)[:0:-1])


@lru_cache(maxsize=_KEPT)
def _sampled_filter(denominator: tuple[float, ...], step: float) -> tuple[SquareMatrix, Vector, Vector]:
    """Give transition, held and rising input of a companion form; `expm` takes longer than a whole pass."""
    system = companion(np.array(denominator))
    transition, held, rising = sampled(system, np.eye(len(system))[:, -1:], step)
    return transition, np.ascontiguousarray(held[:, 0]), np.ascontiguousarray(rising[:, 0])


def filtered(numerator: Vector, denominator: Vector, series: Samples, step: float, hold: Hold) -> Samples:
    """Give B / A times a series that begins at rest; highest powers first, A monic.

    Examples
    --------
    A held input of one through 1 / (s + 1) rises as 1 - exp(-t):

    >>> filtered(np.array([1.0]), np.array([1.0, 1.0]), np.ones(3), 1.0, "zero").round(4)
    array([0.    , 0.6321, 0.8647])
    """
    needed = powers if len(numerator) == len(denominator) else lower_powers
    return np.asarray(needed(denominator, series, step, hold)[:, : len(numerator)] @ numerator[::-1])


def transients(denominator: Vector, samples: int, step: float) -> Matrix:
    """Give what any beginning leaves behind in series that 1 / A filtered: as many columns as poles."""
    transition, _, _ = _sampled_filter(tuple(denominator.tolist()), step)
    still, columns = np.zeros(len(transition)), []
    for begin in np.eye(len(transition)):
        states = np.zeros((samples, len(transition)))
        states[0] = begin
        run_states(transition, still, still, np.zeros(samples), states)
        columns.append(states[:, 0])
    return np.column_stack(columns)


def stabilised(polynomial: Vector) -> Vector:
    """Mirror the roots of a monic polynomial that do not decay at the imaginary axis.

    Examples
    --------
    >>> stabilised(np.array([1.0, -2.0])).round(6)
    array([1., 2.])
    """
    roots = np.roots(polynomial)
    roots = np.where(roots.real > 0.0, -roots.conj(), roots)
    return np.real(np.poly(_decaying(roots)))


def spectral_factor(denominator: Vector, numerator: Vector, ratio: float) -> Vector:
    """Give the stable monic C with C(s) C(-s) = A(s) A(-s) + ratio^2 B(s) B(-s).

    It whitens noise that is white in the output and, `ratio` times as large, white in the input. Source:
    Anderson & Moore 1979, Optimal Filtering, ch. 9.
    """
    total = _even(denominator)
    added = ratio**2 * _even(numerator)
    total[len(total) - len(added) :] += added
    roots = np.roots(total)
    left = roots[np.argsort(roots.real)][: len(denominator) - 1]
    return np.real(np.poly(_decaying(left)))


def _even(polynomial: Vector) -> Vector:
    """Give P(s) P(-s)."""
    signs = (-1.0) ** np.arange(len(polynomial) - 1, -1, -1)
    return np.asarray(np.convolve(polynomial, signs * polynomial))


def _decaying(roots: np.ndarray) -> np.ndarray:
    return np.where(roots.real > -_UNSTABLE * np.abs(roots), roots - _SLOWEST, roots)
