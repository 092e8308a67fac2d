"""Compute accelerations from torques, compiled, for many states at once, with joints that stick.

States are taken in blocks: mass matrix and bias from the moving masses, drives added, one Cholesky
factorisation, and friction where something is at rest. Source: Featherstone 2008, ch. 6.
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from .factor import factorise, less_mass_times, substitute
from .hold import hold_block
from .inverse import Bodies
from .kernel import BLOCK, OPTIONS, TABLE, move_masses

_NONE = np.empty((0, 0))


@njit(inline="always")
def _read_block(block, table, begin, count) -> None:
    for row in range(len(table)):
        for s in range(count):
            block[row, s] = table[row, begin + s]


@njit(inline="always")
def add_drives(out, mass, velocity, inertia, damping, begin, count) -> None:
    """Add rotors to the mass matrix, and take viscous friction from the torque."""
    joints = len(inertia)
    for i in range(joints):
        for j in range(joints):
            if damping[i, j] != 0.0:
                for s in range(count):
                    out[np.uintp(i), s] -= damping[i, j] * velocity[np.uintp(j), begin + s]
            if j <= i and inertia[i, j] != 0.0:
                for s in range(count):
                    mass[np.uintp(i * joints + j), s] += inertia[i, j]


@njit(inline="always")
def add_implicit(mass, implicit, damping, begin, count) -> None:
    """Add to the mass matrix what the damping becomes within the implicit time."""
    joints = len(damping)
    for i in range(joints):
        for j in range(i + 1):
            if damping[i, j] != 0.0:
                for s in range(count):
                    mass[np.uintp(i * joints + j), s] += implicit[begin + s] * damping[i, j]


@njit(inline="always")
def _slide(out, weights, direction, level, begin, count) -> None:
    """Subtract the friction of what slides."""
    for i in range(len(out)):
        for e in range(len(weights)):
            for s in range(count):
                sliding = direction[np.uintp(e), begin + s] * level[np.uintp(e), begin + s]
                out[np.uintp(i), s] -= weights[e, i] * sliding


@njit(
    f"void({TABLE}, {TABLE}, {TABLE}, {TABLE}, {TABLE}, {TABLE}, {TABLE}, {TABLE}, float64[::1],"
    f" {TABLE}, {TABLE}, {TABLE}, {TABLE})",
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
    """Solve for the accelerations of every state, whose masses and bias `move_masses` gave."""
    joints, states = velocity.shape
    out, scale = np.empty((joints, BLOCK)), np.empty((joints, BLOCK))
    mass = np.empty((joints * joints, BLOCK))
    for begin in range(0, states, BLOCK):
        start, many = np.uintp(begin), min(BLOCK, states - begin)
        count = np.uintp(many)
        _read_block(out, torque, start, count)
        _read_block(mass, matrices, start, count)
        add_drives(out, mass, velocity, inertia, damping, start, count)
        for i in range(joints):
            for s in range(count):
                out[np.uintp(i), s] -= biases[np.uintp(i), start + s]
        _slide(out, weights, direction, level, start, count)
        if len(known):
            less_mass_times(out, mass, known, joints, start, count)
        add_implicit(mass, implicit, damping, start, count)
        factorise(mass, scale, joints, count)
        substitute(out, mass, scale, joints, count)
        hold_block(out, mass, scale, weights, direction, level, held, begin, many)
        for i in range(joints):
            for s in range(count):
                rate[np.uintp(i), start + s] = out[np.uintp(i), s]


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
    mass, bias = np.zeros((joints * joints, states)), np.zeros((joints, states))
    move_masses(robot, position, velocity, np.zeros((joints, states)), bias, mass)
    _accelerate(mass, bias, *tables[:3], *tables[4:])


def torques(robot: Bodies, *motion: np.ndarray) -> np.ndarray:
    """Give the torque that moves the masses; it, position, velocity and acceleration are (joints, states)."""
    torque = np.zeros(motion[0].shape)
    move_masses(robot, *motion, torque, _NONE)
    return torque


def mass_matrices(robot: Bodies, position: np.ndarray) -> np.ndarray:
    """Give the mass matrix of every state (states, joints, joints); positions are (joints, states)."""
    joints, states = position.shape
    matrices, still = np.empty((states, joints, joints)), np.zeros((joints, states))
    mass = np.zeros((joints * joints, states))
    move_masses(robot, position, still, still, _NONE, mass)
    lower, upper = np.tril_indices(joints)
    matrices[:, lower, upper] = matrices[:, upper, lower] = mass[lower * joints + upper].T
    return matrices


@njit(f"void({TABLE}, {TABLE}, {TABLE}, float64[::1], {TABLE}, {TABLE})", **OPTIONS)
def predict(position, velocity, rate, time, ahead, speed) -> None:  # pragma: no cover  (compiled)
    """Write position and velocity a time later at a constant rate of the velocity."""
    for row in range(len(position)):
        for s in range(len(time)):
            ahead[row, s] = position[row, s] + time[s] * velocity[row, s]
            speed[row, s] = velocity[row, s] + time[s] * rate[row, s]


@njit(f"void({TABLE}, {TABLE}, {TABLE}, {TABLE}, {TABLE}, float64[::1], {TABLE}, {TABLE})", **OPTIONS)
def correct(  # pragma: no cover  (compiled)
    position, velocity, first, predicted, second, time, ahead, speed
) -> None:
    """Write position and velocity a time later from the scheme's two rates; `second` becomes the last one."""
    for row in range(len(position)):
        for s in range(len(time)):
            ahead[row, s] = position[row, s] + 0.5 * time[s] * (velocity[row, s] + predicted[row, s])
            speed[row, s] = velocity[row, s] + time[s] * (1.5 * first[row, s] + 0.5 * second[row, s])
            second[row, s] += 2.0 * first[row, s]
