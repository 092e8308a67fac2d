"""Compute accelerations from torques, compiled, for many states at once, with joints that stick.

The mass matrix is factorised by Cholesky, in blocks of states like everything else; a state with something at
rest is then finished by itself: friction takes whatever torque keeps it at rest, up to its level. That is the
convex problem min 1/2 x' G x - x' b over |x| <= level, solved by projected Gauss-Seidel. Sources: Featherstone
2008, ch. 6; Acary & Brogliato 2008, ch. 12 and 13.
"""

# Types stand in the signatures; numbers and tables are handed on one by one, which is what compiles well.
# ruff: noqa: ANN001, ANN201, ANN202, PLR0913, PLR0917, PLR0914
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from core.simulation.kernel import BLOCK, OPTIONS, ROBOT, mass_of_block, move_block, scratch, torque_of_block

SWEEPS = 2_000
CLOSE = 1e-13
"""Gauss-Seidel stops when a sweep changes no friction torque by more than this share of its level."""

_TABLE = "float64[:,::1]"


@njit(inline="always")
def _take(block, table, begin, count):
    for row in range(len(table)):
        for s in range(count):
            block[row, s] = table[row, begin + s]


@njit(inline="always")
def _less(out, row, table, other, factor, count):
    """Subtract a multiple of a row of another table."""
    for s in range(count):
        out[row, s] -= factor * table[other, s]


@njit(inline="always")
def _less_product(out, row, one, left, other, right, count):
    """Subtract the product of two rows."""
    for s in range(count):
        out[row, s] -= one[left, s] * other[right, s]


@njit(inline="always")
def _raise(out, row, value, count):
    """Add a number to a row."""
    for s in range(count):
        out[row, s] += value


@njit(inline="always")
def _raise_by(out, row, times, factor, begin, count):
    """Add a multiple of a time per state."""
    for s in range(count):
        out[row, s] += times[begin + s] * factor


@njit(inline="always")
def _slide(out, row, direction, level, weight, begin, count):
    """Subtract the friction of what slides."""
    for s in range(count):
        out[row, s] -= weight * (direction[begin + s] * level[begin + s])


@njit(inline="always")
def _apply_mass(out, mass, vector, joints, count):
    """Subtract the mass matrix times a vector."""
    for i in range(joints):
        for j in range(joints):
            row = max(i, j) * joints + min(i, j)
            _less_product(out, np.uintp(i), mass, np.uintp(row), vector, np.uintp(j), count)


@njit(inline="always")
def _factorise(mass, scale, joints, count):
    """Turn the lower triangle into its Cholesky factor; `scale` gets one over its diagonal."""
    for j in range(joints):
        for i in range(j, joints):
            own = np.uintp(i * joints + j)
            for k in range(j):
                _less_product(mass, own, mass, np.uintp(i * joints + k), mass, np.uintp(j * joints + k), count)
        own = np.uintp(j * joints + j)
        for s in range(count):
            scale[np.uintp(j), s] = 1.0 / np.sqrt(mass[own, s])
        for i in range(j + 1, joints):
            own = np.uintp(i * joints + j)
            for s in range(count):
                mass[own, s] *= scale[np.uintp(j), s]


@njit(inline="always")
def _substitute(vector, factor, scale, joints, count):
    """Solve with the Cholesky factor in place."""
    for i in range(joints):
        for k in range(i):
            _less_product(vector, np.uintp(i), factor, np.uintp(i * joints + k), vector, np.uintp(k), count)
        for s in range(count):
            vector[np.uintp(i), s] *= scale[np.uintp(i), s]
    for i in range(joints - 1, -1, -1):
        for k in range(i + 1, joints):
            _less_product(vector, np.uintp(i), factor, np.uintp(k * joints + i), vector, np.uintp(k), count)
        for s in range(count):
            vector[np.uintp(i), s] *= scale[np.uintp(i), s]


@njit
def _solve_one(vector, factor, scale, s, joints):
    """Solve one state's equations in place."""
    for i in range(joints):
        for k in range(i):
            vector[i] -= factor[i * joints + k, s] * vector[k]
        vector[i] *= scale[i, s]
    for i in range(joints - 1, -1, -1):
        for k in range(i + 1, joints):
            vector[i] -= factor[k * joints + i, s] * vector[k]
        vector[i] *= scale[i, s]


@njit
def _settle(coupled, push, level, held):
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
def _something_rests(direction, level, s):
    for e in range(len(level)):
        if direction[e, s] == 0.0 and level[e, s] > 0.0:
            return True
    return False


@njit
def _hold(rate, factor, scale, s, weights, direction, level, held, joints):
    """Keep at rest what friction can keep at rest in one state: changes its accelerations, fills `held`."""
    resting = np.flatnonzero((direction == 0.0) & (level > 0.0))
    answer = np.empty((len(resting), joints))
    coupled = np.empty((len(resting), len(resting)))
    push = np.empty(len(resting))
    found = np.zeros(len(resting))
    for e in range(len(resting)):
        answer[e] = weights[resting[e]]
        _solve_one(answer[e], factor, scale, s, joints)
        push[e] = 0.0
        for j in range(joints):
            push[e] += weights[resting[e], j] * rate[j, s]
        for f in range(e + 1):
            coupled[e, f] = 0.0
            for j in range(joints):
                coupled[e, f] += answer[e, j] * weights[resting[f], j]
            coupled[f, e] = coupled[e, f]
    _settle(coupled, push, level[resting], found)
    for e in range(len(resting)):
        held[resting[e]] = found[e]
        for j in range(joints):
            rate[j, s] -= found[e] * answer[e, j]
    for e in resting:
        if abs(held[e]) < level[e] and np.count_nonzero(weights[e]) == 1:
            rate[np.flatnonzero(weights[e])[0], s] = 0.0


@njit(
    f"void({ROBOT}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, float64[::1],"
    f" {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE})",
    **OPTIONS,
)
def accelerations(  # pragma: no cover  (compiled)
    robot,
    inertia,
    damping,
    weights,
    position,
    velocity,
    torque,
    known,
    implicit,
    direction,
    level,
    rate,
    held,
):
    """Solve (M + implicit D) rate = torque - D v - friction - bias - M known for every state.

    All tables are (rows, states). `weights` has one row per friction element: the speed on which it acts is
    `weights @ velocity`. `direction` says which way it slides; 0 is at rest, held up to its `level`, and what
    holds it goes to `held`. An empty `known` is zero. A mass matrix that is not positive definite leaves nan behind.
    """
    joints, states = position.shape
    tables = scratch(len(robot[1]))
    q, v, still = np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK))
    other = np.zeros((joints, BLOCK))
    bias, out, scale = np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK)), np.empty((joints, BLOCK))
    mass = np.empty((joints * joints, BLOCK))
    for begin in range(0, states, BLOCK):
        start, many = np.uintp(begin), min(BLOCK, states - begin)
        count = np.uintp(many)
        _take(q, position, start, count)
        _take(v, velocity, start, count)
        if len(known):
            _take(other, known, start, count)
        _take(out, torque, start, count)
        move_block(robot, tables, q, v, still, many)
        torque_of_block(robot, tables, bias, many)
        mass_of_block(robot, tables, mass, joints, many)
        for i in range(joints):
            _less(out, np.uintp(i), bias, np.uintp(i), 1.0, count)
            for j in range(joints):
                if damping[i, j] != 0.0:
                    _less(out, np.uintp(i), v, np.uintp(j), damping[i, j], count)
                if j <= i and inertia[i, j] != 0.0:
                    _raise(mass, np.uintp(i * joints + j), inertia[i, j], count)
            for e in range(len(weights)):
                if weights[e, i] != 0.0:
                    _slide(out, np.uintp(i), direction[e], level[e], weights[e, i], start, count)
        if len(known):
            _apply_mass(out, mass, other, joints, count)
        for i in range(joints):
            for j in range(i + 1):
                if damping[i, j] != 0.0:
                    _raise_by(mass, np.uintp(i * joints + j), implicit, damping[i, j], start, count)
        _factorise(mass, scale, joints, count)
        _substitute(out, mass, scale, joints, count)
        for s in range(many):
            if _something_rests(direction, level, begin + s):
                _hold(
                    out,
                    mass,
                    scale,
                    s,
                    weights,
                    direction[:, begin + s],
                    level[:, begin + s],
                    held[:, begin + s],
                    joints,
                )
        for row in range(joints):
            for s in range(count):
                rate[row, start + s] = out[row, s]


@njit(f"void({_TABLE}, {_TABLE}, {_TABLE}, float64[::1], {_TABLE}, {_TABLE})", **OPTIONS)
def predict(position, velocity, rate, time, ahead, speed):  # pragma: no cover  (compiled)
    """Write position and velocity a time later at a constant rate of the velocity."""
    for row in range(len(position)):
        for s in range(len(time)):
            ahead[row, s] = position[row, s] + time[s] * velocity[row, s]
            speed[row, s] = velocity[row, s] + time[s] * rate[row, s]


@njit(
    f"void({_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, float64[::1], {_TABLE}, {_TABLE})", **OPTIONS
)
def correct(  # pragma: no cover  (compiled)
    position, velocity, first, predicted, second, time, ahead, speed
):
    """Write position and velocity a time later from the scheme's two rates; `second` becomes the last one."""
    for row in range(len(position)):
        for s in range(len(time)):
            ahead[row, s] = position[row, s] + 0.5 * time[s] * (velocity[row, s] + predicted[row, s])
            speed[row, s] = velocity[row, s] + time[s] * (1.5 * first[row, s] + 0.5 * second[row, s])
            second[row, s] += 2.0 * first[row, s]


@njit(f"void({ROBOT}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE})", **OPTIONS)
def torques(robot, position, velocity, acceleration, torque):  # pragma: no cover  (compiled)
    """Write the torque that moves the masses, for every state; all tables are (joints, states)."""
    joints, states = position.shape
    tables = scratch(len(robot[1]))
    q, v, a = np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK))
    out = np.zeros((joints, BLOCK))
    for begin in range(0, states, BLOCK):
        start, many = np.uintp(begin), min(BLOCK, states - begin)
        _take(q, position, start, np.uintp(many))
        _take(v, velocity, start, np.uintp(many))
        _take(a, acceleration, start, np.uintp(many))
        move_block(robot, tables, q, v, a, many)
        torque_of_block(robot, tables, out, many)
        for row in range(joints):
            for s in range(np.uintp(many)):
                torque[row, start + s] = out[row, s]


@njit(f"void({ROBOT}, {_TABLE}, float64[:,:,::1])", **OPTIONS)
def mass_matrices(robot, position, matrices):  # pragma: no cover  (compiled)
    """Write the whole mass matrix of every state (states, joints, joints); positions are (joints, states)."""
    joints, states = position.shape
    tables = scratch(len(robot[1]))
    q, still, mass = np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK)), np.empty((joints * joints, BLOCK))
    for begin in range(0, states, BLOCK):
        many = min(BLOCK, states - begin)
        _take(q, position, np.uintp(begin), np.uintp(many))
        move_block(robot, tables, q, still, still, many)
        mass_of_block(robot, tables, mass, joints, many)
        for i in range(joints):
            for j in range(joints):
                for s in range(many):
                    matrices[begin + s, i, j] = mass[max(i, j) * joints + min(i, j), s]
