"""Take one step of an arm with friction of its own, compiled: Coulomb friction as a set, or presliding.

A step turns mass matrix and bias, which pinocchio computes, into the acceleration. Velocities stand half a
step beside positions (Verlet's scheme). Coulomb friction takes what stops a joint, up to its level: projected
Gauss-Seidel on Moreau's time-stepping. Presliding friction is LuGre's bristle with Stribeck's curve. Sources:
Moreau, Unilateral Contact and Dry Friction (1988); Canudas de Wit, Olsson, Astrom & Lischinsky, IEEE TAC
40(3), 1995.
"""

# ruff: noqa: ANN001, ANN202, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def, untyped-decorator"

import numpy as np
from numba import njit

SWEEPS = 100
EXACT = 1e-13
"""Sweeps end when friction changes by less than this share of its level."""
PRESLIDING = 1e-3
"""Displacement before a joint slides, rad."""
STRIBECK_SPEED, STATIC = 0.05, 1.3
"""Speed of Stribeck's curve (rad/s), as BIRDy's; static friction over Coulomb's."""
BRISTLE_DAMPING = 0.6
"""Damping of the bristle over sqrt(stiffness x rotor inertia)."""


@njit(cache=True)
def _answer(mass, inertia, viscous, step):  # pragma: no cover  (compiled)
    """Invert M + IA + h/2 FV, which is small and positive definite, in place by Gauss and Jordan."""
    joints = len(inertia)
    whole = np.empty((joints, joints))
    for i in range(joints):
        for j in range(joints):
            whole[i, j] = mass[min(i, j), max(i, j)]
        whole[i, i] += inertia[i] + 0.5 * step * viscous[i]
    for k in range(joints):
        pivot = 1.0 / whole[k, k]
        whole[k, k] = 1.0
        for j in range(joints):
            whole[k, j] *= pivot
        for i in range(joints):
            if i != k:
                factor = whole[i, k]
                whole[i, k] = 0.0
                for j in range(joints):
                    whole[i, j] -= factor * whole[k, j]
    return whole


@njit(cache=True)
def _advance(answer, torque, step, out, velocity):  # pragma: no cover  (compiled)
    """Write the acceleration of a torque, and add it to the velocity."""
    for i in range(len(out)):
        out[i] = 0.0
        for j in range(len(out)):
            out[i] += answer[i, j] * torque[j]
    for i in range(len(out)):
        velocity[i] += step * out[i]


@njit(cache=True)
def coulomb_step(
    mass, bias, inertia, viscous, velocity, push, level, held, step, out
) -> None:  # pragma: no cover  (compiled)
    """Advance the velocity in place; write the acceleration to `out`, and what friction takes to `held`."""
    answer, before = _answer(mass, inertia, viscous, step), velocity.copy()
    _advance(answer, push - bias - viscous * velocity - held, step, out, velocity)
    for _ in range(SWEEPS):
        moved = 0.0
        for i in range(len(held)):
            wanted = held[i] + velocity[i] / (step * answer[i, i])
            wanted = min(max(wanted, -level[i]), level[i])
            change = wanted - held[i]
            if change != 0.0:
                for j in range(len(held)):
                    velocity[j] -= step * answer[j, i] * change
                held[i] = wanted
                moved = max(moved, abs(change) / level[i])
        if moved < EXACT:
            break
    for i in range(len(held)):
        out[i] = (velocity[i] - before[i]) / step


@njit(cache=True)
def presliding_step(
    mass, bias, inertia, viscous, velocity, push, level, held, step, out, bristle
) -> None:  # pragma: no cover  (compiled)
    """Do the same with bristles (rad), which bend in place."""
    for i in range(len(held)):
        stiffness = level[i] / PRESLIDING
        damping = BRISTLE_DAMPING * np.sqrt(stiffness * inertia[i])
        most = level[i] * (1.0 + (STATIC - 1.0) * np.exp(-((velocity[i] / STRIBECK_SPEED) ** 2)))
        speed = abs(velocity[i])
        bent = (bristle[i] + step * velocity[i]) / (1.0 + step * speed * stiffness / most)
        held[i] = stiffness * bent + damping * (bent - bristle[i]) / step
        bristle[i] = bent
    torque = push - bias - viscous * velocity - held
    _advance(_answer(mass, inertia, viscous, step), torque, step, out, velocity)
