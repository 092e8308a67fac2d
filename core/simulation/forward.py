"""Compute accelerations from torques, compiled, for many states at once, with joints that stick.

States are taken in blocks: mass matrix and bias from the moving masses, drives added, one Cholesky
factorisation, and friction where something is at rest. Source: Featherstone 2008, ch. 6.
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from .factor import INLINE, factorise, less_mass_times, sub, substitute
from .hold import hold_block
from .kernel import BLOCK, OPTIONS, ROBOT, mass_of_block, move_block, scratch, torque_of_block

_TABLE = "float64[:,::1]"
_NONE = np.empty((0, 0))
Bodies = tuple[np.ndarray, ...]
"""What the kernels need of a robot, in the order of `kernel.ROBOT`."""


@njit(**INLINE)
def _read_block(block, table, begin, count) -> None:
    for row in range(len(table)):
        for s in range(count):
            block[row, s] = table[row, begin + s]


@njit(**INLINE)
def _add(out, row, value, count) -> None:
    """Add a number to a row."""
    for s in range(count):
        out[row, s] += value


@njit(**INLINE)
def _raise_by(out, row, times, factor, begin, count) -> None:
    """Add a multiple of a time per state."""
    for s in range(count):
        out[row, s] += times[begin + s] * factor


@njit(**INLINE)
def _slide(out, row, direction, level, weight, begin, count) -> None:
    """Subtract the friction of what slides."""
    for s in range(count):
        out[row, s] -= weight * (direction[begin + s] * level[begin + s])


@njit(**INLINE)
def _write_block(table, block, begin, count) -> None:
    """Copy a block's rows to where they belong."""
    for row in range(len(table)):
        for s in range(count):
            table[row, begin + s] = block[row, s]


@njit(**INLINE)
def _add_drives(out, mass, velocity, inertia, damping, count) -> None:
    """Add rotors to the mass matrix, and take viscous friction from the torque."""
    joints = len(inertia)
    for i in range(joints):
        for j in range(joints):
            if damping[i, j] != 0.0:
                sub(out, np.uintp(i), velocity, np.uintp(j), damping[i, j], count)
            if j <= i and inertia[i, j] != 0.0:
                _add(mass, np.uintp(i * joints + j), inertia[i, j], count)


@njit(**INLINE)
def _add_implicit(mass, implicit, damping, begin, count) -> None:
    """Add to the mass matrix what the damping becomes within the implicit time."""
    joints = len(damping)
    for i in range(joints):
        for j in range(i + 1):
            if damping[i, j] != 0.0:
                _raise_by(mass, np.uintp(i * joints + j), implicit, damping[i, j], begin, count)


@njit(f"void({ROBOT}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE})", **OPTIONS)
def _move_masses(  # pragma: no cover  (compiled)
    robot, position, velocity, acceleration, torque, mass
) -> None:
    """Write torque and the mass matrix's lower triangle (row i * joints + j) of every state.

    All tables are (rows, states); an empty one is not written.
    """
    joints, states = position.shape
    tables = scratch(len(robot[1]))
    q, v, a = np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK))
    out, matrix = np.zeros((joints, BLOCK)), np.empty((joints * joints, BLOCK))
    for begin in range(0, states, BLOCK):
        start, many = np.uintp(begin), min(BLOCK, states - begin)
        _read_block(q, position, start, np.uintp(many))
        _read_block(v, velocity, start, np.uintp(many))
        _read_block(a, acceleration, start, np.uintp(many))
        move_block(robot, tables, q, v, a, many)
        if len(torque):
            torque_of_block(robot, tables, out, many)
            _write_block(torque, out, start, np.uintp(many))
        if len(mass):
            mass_of_block(robot, tables, matrix, joints, many)
            _write_block(mass, matrix, start, np.uintp(many))


@njit(
    f"void({_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, float64[::1],"
    f" {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE})",
    **OPTIONS,
)
def _accelerate(  # pragma: no cover  (compiled)
    matrices,
    biases,
    inertia,
    damping,
    weights,
    velocity,
    torque,
    known,
    implicit,
    direction,
    level,
    rate,
    held,
) -> None:
    """Solve for the accelerations of every state, whose masses and bias `_move_masses` wrote."""
    joints, states = velocity.shape
    v, bias, other = np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK)), np.zeros((joints, BLOCK))
    out, scale = np.zeros((joints, BLOCK)), np.empty((joints, BLOCK))
    mass = np.empty((joints * joints, BLOCK))
    for begin in range(0, states, BLOCK):
        start, many = np.uintp(begin), min(BLOCK, states - begin)
        count = np.uintp(many)
        _read_block(v, velocity, start, count)
        _read_block(out, torque, start, count)
        _read_block(bias, biases, start, count)
        _read_block(mass, matrices, start, count)
        _add_drives(out, mass, v, inertia, damping, count)
        for i in range(joints):
            sub(out, np.uintp(i), bias, np.uintp(i), 1.0, count)
            for e in range(len(weights)):
                _slide(out, np.uintp(i), direction[e], level[e], weights[e, i], start, count)
        if len(known):
            _read_block(other, known, start, count)
            less_mass_times(out, mass, other, joints, count)
        _add_implicit(mass, implicit, damping, start, count)
        factorise(mass, scale, joints, count)
        substitute(out, mass, scale, joints, count)
        hold_block(out, mass, scale, weights, direction, level, held, begin, many)
        _write_block(rate, out, start, count)


def accelerations(robot: Bodies, *tables: np.ndarray) -> None:
    """Solve (M + implicit D) rate = torque - D v - friction - bias - M known for every state.

    Tables are inertia, damping, weights, position, velocity, torque, known, implicit, direction, level, and
    two to write to: rate, held. All are (rows, states), but the first three and the times `implicit`.
    `weights` has one row per friction element: the speed on which it acts is `weights @ velocity`.
    `direction` says which way it slides; 0 is at rest, held up to its `level`, and what holds it goes to
    `held`. An empty `known` is zero. A mass matrix that is not positive definite leaves nan behind.
    """
    position, velocity = tables[3:5]
    joints, states = position.shape
    mass, bias = np.empty((joints * joints, states)), np.empty((joints, states))
    _move_masses(robot, position, velocity, np.zeros((joints, states)), bias, mass)
    _accelerate(mass, bias, *tables[:3], *tables[4:])


def torques(robot: Bodies, *tables: np.ndarray) -> None:
    """Write the torque that moves the masses, for every state.

    Tables are position, velocity, acceleration, and the torque to write; all are (joints, states).
    """
    _move_masses(robot, *tables, _NONE)


def mass_matrices(robot: Bodies, position: np.ndarray, matrices: np.ndarray) -> None:
    """Write the whole mass matrix of every state (states, joints, joints); positions are (joints, states)."""
    joints, states = position.shape
    still, mass = np.zeros((joints, states)), np.empty((joints * joints, states))
    _move_masses(robot, position, still, still, _NONE, mass)
    lower, upper = np.tril_indices(joints)
    matrices[:, lower, upper] = matrices[:, upper, lower] = mass[lower * joints + upper].T


@njit(f"void({_TABLE}, {_TABLE}, {_TABLE}, float64[::1], {_TABLE}, {_TABLE})", **OPTIONS)
def predict(position, velocity, rate, time, ahead, speed) -> None:  # pragma: no cover  (compiled)
    """Write position and velocity a time later at a constant rate of the velocity."""
    for row in range(len(position)):
        for s in range(len(time)):
            ahead[row, s] = position[row, s] + time[s] * velocity[row, s]
            speed[row, s] = velocity[row, s] + time[s] * rate[row, s]


@njit(f"void({_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, {_TABLE}, float64[::1], {_TABLE}, {_TABLE})", **OPTIONS)
def correct(  # pragma: no cover  (compiled)
    position, velocity, first, predicted, second, time, ahead, speed
) -> None:
    """Write position and velocity a time later from the scheme's two rates; `second` becomes the last one."""
    for row in range(len(position)):
        for s in range(len(time)):
            ahead[row, s] = position[row, s] + 0.5 * time[s] * (velocity[row, s] + predicted[row, s])
            speed[row, s] = velocity[row, s] + time[s] * (1.5 * first[row, s] + 0.5 * second[row, s])
            second[row, s] += 2.0 * first[row, s]
