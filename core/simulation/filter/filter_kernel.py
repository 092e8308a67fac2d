"""Follow a robot's state and its parameters through samples of a log, compiled: two Kalman filters in one.

The state is (chi, q, v): parameters that do not move by themselves, positions at a sample, and velocities
half a step before it. Its covariance S S' is held by the triangle S alone, parameters first, so that the
factor of the parameters' own covariance stands in its corner. The scheme moves the state along every column
of S: differences to one side make the extended filter, those to both sides the unscented one, whose
covariance in terms of first and second differences needs no downdate. Positions are taken in one by one.
Sources: van der Merwe & Wan, ICASSP 2001 (square-root form); Norgaard, Poulsen & Ravn, Automatica 36, 2000
(differences).
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from ..closed_loop.lane import lane_mass, lane_place, lane_torque
from ..closed_loop.loop_kernel import kick, tables_of
from ..factor import solve_one
from ..integrate import FASTEST
from ..kernel import OPTIONS, ROBOT, TABLE, scratch_of
from .square_root import INNER, make_triangular, take_in

ACCELERATION, TORQUE, NOISE = range(3)
"""Rows of what is remembered from a sample to the next: last acceleration, torque and its deviation."""
MEMORY_ROWS = 3
LEAST_LEVEL = 1e-9
"""Friction below this level, N m, is simulated with it."""
SHORTEST = 1e-3
"""Parameters that are no robot even when they differ by less than this share of their deviations."""


@njit(inline="always")
def _views(robot, table, joints, frictions) -> tuple[object, ...]:
    """Give the robot, its drives, offsets and friction levels, all of which lie in one table."""
    links, square = len(robot[1]), joints * joints
    ends = np.cumsum(np.array([10 * links, links, square, square, joints, frictions]))
    bodies, masses = table[: ends[0]].reshape(links, 10), table[ends[0] : ends[1]]
    inertia = table[ends[1] : ends[2]].reshape(joints, joints)
    damping = table[ends[2] : ends[3]].reshape(joints, joints)
    prismatic, antecedent, joint, ratio, zero, rotation, translation, gravity, _, _ = robot
    whole = (prismatic, antecedent, joint, ratio, zero, rotation, translation, gravity, bodies, masses)
    return whole, inertia, damping, table[ends[3] : ends[4]], table[ends[4] : ends[5]]


@njit(**INNER)
def _moved(plant, state, rate, held, last, torque, clock) -> bool:
    """Carry position and velocity from a sample to the next; tells whether the motion is one of a robot."""
    (robot, inertia, damping, offset, levels), weights, scratch, work = plant
    out, place, ahead, before, after, still, bodies, scale, mass, kept = work
    (step, substeps), joints, implicit = clock, len(offset), np.zeros(len(offset))
    for e in range(len(levels)):
        levels[e] = max(levels[e], LEAST_LEVEL)
        held[e] = min(max(held[e], -levels[e]), levels[e])
    for number in range(substeps):
        for j in range(joints):
            place[j, 0], before[j, 0] = state[j], state[joints + j]
            ahead[j, 0] = before[j, 0] + 0.5 * step * rate[j]
            out[j, 0] = last[j] + (torque[j] - last[j]) * number / substeps
        lane_place(robot, scratch, kept, place)
        lane_torque(robot, scratch, kept, ahead, still, bodies)
        lane_mass(robot, scratch, kept, mass, joints)
        drives = (inertia, damping, weights)
        kick(out, implicit, mass, scale, drives, offset, bodies, levels, held, before, after, step)
        for j in range(joints):
            if not abs(after[j, 0]) <= FASTEST:
                return False
            rate[j], state[joints + j] = out[j, 0], after[j, 0]
            state[j] += step * after[j, 0]
    return True


@njit(inline="always")
def _change(table, tangent, column, size) -> None:
    """Add to a robot's numbers what parameters change that differ by a column times a size."""
    place, parameter, slope = tangent
    for t in range(len(place)):
        table[place[t]] += slope[t] * size * column[parameter[t]]


@njit(inline="always")
def _sides(plant, tables, tangent, column, mean, memory, held, torque, clock, length, moved, own) -> bool:
    """Move the state along a column of the factor by a length, and against it."""
    (centre, table), width = tables, moved.shape[1]
    base, fine, (rate, hold) = len(mean) - width, True, own
    for side in range(len(moved)):
        way = -length if side else length
        rate[:], hold[:], table[:] = memory[ACCELERATION], held, centre
        for c in range(width):
            moved[side, c] = mean[base + c] + way * column[base + c]
        _change(table, tangent, column, way)
        fine = fine and _moved(plant, moved[side], rate, hold, memory[TORQUE], torque, clock)
    return fine


@njit(inline="always")
def _add_noise(rows, work, noise, clock) -> None:
    """Write what the torque's noise does within a sample: one row per joint."""
    (step, substeps), joints = clock, len(noise)
    whole = step * substeps
    for j in range(joints):
        answer = np.zeros(joints)
        answer[j] = noise[j]
        solve_one(answer, work[8], work[7], 0, joints)
        for i in range(joints):
            rows[j, joints + i] = whole * answer[i]
            rows[j, i] = 0.5 * whole * whole * (1.0 + 1.0 / substeps) * answer[i]


@njit(inline="always")
def _differ(first, second, moved, state, length, spread, shift) -> None:
    """Write first and second differences along a column, and add up the shift that the second ones show."""
    for c in range(len(state)):
        if len(moved) == 1:
            first[c] = (moved[0, c] - state[c]) / length
        else:
            first[c] = (moved[0, c] - moved[1, c]) / (2.0 * length)
            curved = (moved[0, c] + moved[1, c] - 2.0 * state[c]) / (2.0 * length * length)
            second[c] = spread * curved
            shift[c] += curved


@njit(inline="always")
def _renew(mean, factor, rows, state, shift, central) -> None:
    """Write the mean and the factor of what the columns have become."""
    width = len(state)
    base = len(mean) - width
    for c in range(width):
        rows[len(rows) - 1, c] = central * shift[c]
        mean[base + c] = state[c] + shift[c]
    make_triangular(rows, width)
    for i in range(width):
        for c in range(i, width):
            factor[base + i, base + c] = rows[i, c]


@njit(inline="always")
def _foreseen(plant, tables, tangent, mean, factor, memory, held, torque, rule, clock) -> int:
    """Carry mean and factor from a sample to the next; gives how many columns had to be shortened, or -1."""
    (spread, both, central), size, joints = rule, len(mean), len(torque)
    width = 2 * joints
    base, shortened, shift = size - width, 0, np.zeros(width)
    state, rate, hold = mean[base:].copy(), memory[ACCELERATION].copy(), held.copy()
    tables[1][:] = tables[0]
    if not _moved(plant, state, rate, hold, memory[TORQUE], torque, clock):
        return -1
    rows = np.zeros((joints + width + size + 1, width))
    _add_noise(rows, plant[3], memory[NOISE], clock)
    moved, own = np.empty((2 if both else 1, width)), (np.empty(joints), np.empty(len(held)))
    for i in range(size):
        length, column = spread, factor[i]
        while not _sides(
            plant, tables, tangent, column, mean, memory, held, torque, clock, length, moved, own
        ):
            length *= 0.5
            if length < SHORTEST * spread:
                return -1
        shortened += length < spread
        first = column[base:] if i < base else rows[joints + i - base]
        _differ(first, rows[joints + width + i], moved, state, length, spread, shift)
    _renew(mean, factor, rows, state, shift, central)
    memory[ACCELERATION], held[:] = rate, hold
    return shortened


@njit(
    f"UniTuple(int64, 2)({ROBOT}, {TABLE}, Tuple((int64[::1], int64[::1], float64[::1])), float64[::1],"
    f" float64[::1], float64[::1], UniTuple({TABLE}, 3), float64[::1], {TABLE}, {TABLE}, float64[::1],"
    f" {TABLE}, Tuple((float64, boolean, float64)), Tuple((float64, int64)), boolean)",
    **OPTIONS,
)
def follow(  # pragma: no cover  (compiled)
    robot,
    weights,
    tangent,
    origin,
    reference,
    variance,
    samples,
    mean,
    factor,
    memory,
    held,
    missed,
    rule,
    clock,
    fresh,
) -> tuple[int, int]:
    """Filter samples; gives the one at which it failed, or -1, and in how many any column was shortened.

    Parameters
    ----------
    weights
        Of frictions: see `Mechanism`.
    tangent, origin, reference
        Bodies, subtree masses, drives' inertia and damping, offsets and friction levels in one table, at the
        reference parameters; and its slopes: places in it, parameters, values.
    variance
        Of the measured positions.
    samples
        Position, torque, and the torque's deviation.
    mean, factor, memory, held
        What is changed in place: state, S', see `MEMORY_ROWS`, and the torque of every friction.
    missed
        What is written: what was not foreseen of the positions, in its own deviations.
    rule
        Length of the steps along a column, whether to either side, weight of the shift that they show.
    clock
        Step of the integration, s, and how many of them make a sample.
    fresh
        Whether the state is that of the first sample.
    """
    position, torque, noise = samples
    joints, base, links = position.shape[1], len(reference), len(robot[1])
    centre, table, wide = origin.copy(), origin.copy(), 0
    scratch, work = scratch_of(links, robot[7], 1), tables_of(joints, links)
    plant = (_views(robot, table, joints, len(held)), weights, scratch, work)
    for k in range(len(position)):
        if not (fresh and k == 0):
            centre[:] = origin
            _change(centre, tangent, mean[:base] - reference, 1.0)
            tables = (centre, table)
            shortened = _foreseen(plant, tables, tangent, mean, factor, memory, held, torque[k], rule, clock)
            if shortened < 0:
                return k, wide
            wide += shortened > 0
        memory[TORQUE], memory[NOISE] = torque[k], noise[k]
        for j in range(joints):
            missed[k, j] = take_in(mean, factor, position[k, j], base + j, variance[j])
    return -1, wide
