"""Hold at rest what friction can hold, compiled: the one place where friction is a set.

Friction takes whatever torque x keeps its speed at rest, up to its level: the convex problem
min 1/2 x' G x - x' b over |x| <= level, with G = J inv(M) J' and b the accelerations without it, solved by
projected Gauss-Seidel. Sources: Acary & Brogliato 2008, ch. 12 and 13.
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from .factor import solve_one

SWEEPS = 2_000
CLOSE = 1e-13
"""Gauss-Seidel stops when a sweep changes no friction torque by more than this share of its level."""


@njit(inline="always")
def settle(coupled, push, level, held) -> None:
    """Find friction torques within their levels that leave as little of the push as they can."""
    for _ in range(SWEEPS):
        change = 0.0
        for e in range(len(push)):
            left = push[e]
            for f in range(len(push)):
                left -= coupled[e, f] * held[f]
            wanted = min(max(held[e] + left / coupled[e, e], -level[e]), level[e])
            change = max(change, abs(wanted - held[e]) / level[e])
            held[e] = wanted
        if change <= CLOSE:
            break


@njit(inline="always")
def couple(answer, coupled, factor, scale, s, weights, chosen) -> None:
    """Write the joints' answer to each of the chosen frictions, and the frictions' to each other."""
    for e in range(len(chosen)):
        for j in range(weights.shape[1]):
            answer[e, j] = weights[chosen[e], j]
        solve_one(answer[e], factor, scale, s, weights.shape[1])
        for f in range(e + 1):
            coupled[e, f] = 0.0
            for j in range(weights.shape[1]):
                coupled[e, f] += answer[e, j] * weights[chosen[f], j]
            coupled[f, e] = coupled[e, f]


@njit(inline="always")
def stop(rate, s, weights, resting, held, level) -> None:
    """Take from joints that are held what rounding left of their acceleration or speed."""
    for e in range(len(resting)):
        count, only = 0, 0
        for j in range(weights.shape[1]):
            if weights[resting[e], j] != 0.0:
                count, only = count + 1, j
        if abs(held[e]) < level[e] and count == 1:
            rate[only, s] = 0.0


@njit(inline="always")
def _resting(direction, level, at) -> np.ndarray:
    """List the frictions that are at rest and can hold."""
    count = 0
    resting = np.empty(len(level), np.int64)
    for e in range(len(level)):
        if direction[e, at] == 0.0 and level[e, at] > 0.0:
            resting[count] = e
            count += 1
    return resting[:count]


@njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, error_model="numpy")
def _hold(rate, factor, scale, s, weights, direction, level, held, at) -> None:
    """Keep at rest what friction can keep at rest in one state: changes its accelerations, fills `held`.

    The state is number `s` of the block, `at` of all.
    """
    joints = len(rate)
    resting = _resting(direction, level, at)
    answer = np.empty((len(resting), joints))
    coupled = np.empty((len(resting), len(resting)))
    push, limit = np.empty(len(resting)), np.empty(len(resting))
    found = np.zeros(len(resting))
    couple(answer, coupled, factor, scale, s, weights, resting)
    for e in range(len(resting)):
        push[e], limit[e] = 0.0, level[resting[e], at]
        for j in range(joints):
            push[e] += weights[resting[e], j] * rate[j, s]
    settle(coupled, push, limit, found)
    for e in range(len(resting)):
        held[resting[e], at] = found[e]
        for j in range(joints):
            rate[j, s] -= found[e] * answer[e, j]
    stop(rate, s, weights, resting, found, limit)


@njit(inline="always")
def _rests(direction, level, s) -> bool:
    found = False
    for e in range(len(level)):
        found |= direction[e, s] == 0.0 and level[e, s] > 0.0
    return found


@njit(inline="always")
def hold_block(rate, factor, scale, weights, direction, level, held, begin, many) -> None:
    """Hold in every state of a block what is at rest and can be held."""
    for s in range(many):
        if _rests(direction, level, begin + s):
            _hold(rate, factor, scale, s, weights, direction, level, held, begin + s)
