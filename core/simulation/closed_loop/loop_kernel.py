"""Step a controlled robot through the samples of a log, compiled: one lane, all of a step in one loop.

Velocities stand half a step beside positions (Verlet's scheme), and each step gives them one kick:
(M + h/2 D) a = u - c - D v - W' l with D the damping of joints and controller, where c is the bias at the
velocity that the last acceleration foresees, and l what friction takes of its level to keep W (v + h a) at
rest: Moreau's time-stepping. Sources: Featherstone 2008, ch. 5 and 6; Hairer, Lubich & Wanner, Acta Numerica
12, 2003; Acary & Brogliato 2008, ch. 10.
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from ..control.control_law import (
    DERIVATIVE,
    INTEGRAL_PLACE,
    INTEGRAL_RATE,
    LAST,
    LAST_BUT_ONE,
    LIMIT,
    NOW,
    POLE,
    PROPORTIONAL,
)
from ..factor import factorise, substitute
from ..forward import add_drives
from ..hold import couple, settle, stop
from ..integrate import FASTEST
from ..kernel import OPTIONS, ROBOT, TABLE, scratch_of
from .lane import FIRST, ONE, lane_mass, lane_place, lane_springs, lane_torque

POSITION, SPEED, ACCELERATION, EARLIER, BEFORE, FILTERED, INTEGRAL, HELD, FORWARD, PLACE, RATE = range(11)
"""Rows of the state: position at the next sample less the way there, speed half a step after the last one,
last acceleration; the controller's memory: two earlier positions, filtered speed, integral, torque, and last
inputs."""
STATE_ROWS = 11


@njit(inline="always")
def _drive(out, implicit, law, state, forward, place, rate, k, step, back) -> None:
    """Write the torque of a joint controller that acts at every step.

    Between samples the torque is linear, and the way is the cubic that has the positions and speeds of both:
    on a chord a stiff controller would pull every curve towards its inner side. `back` is the share of a
    sample to go to the sample `k`. The damping comes apart, to be taken implicitly.
    """
    on = 1.0 - back
    for j in range(len(implicit)):
        feed = forward[k, j] - back * (forward[k, j] - state[FORWARD, j])
        way = place[k, j] - state[PLACE, j]
        bends = step * state[RATE, j] - way, step * rate[k, j] - way
        wanted = state[PLACE, j] + on * way + on * back * (back * bends[0] - on * bends[1])
        turn = (back - 2.0 * on) * back * bends[0] + (on - 2.0 * back) * on * bends[1]
        speed = (way + turn) / step
        implicit[j] = law[DERIVATIVE, j]
        error = wanted - state[POSITION, j]
        out[j, 0] = feed + law[PROPORTIONAL, j] * error + law[DERIVATIVE, j] * speed


@njit(inline="always")
def command(out, implicit, law, state, ahead, forward, place, rate, k, step) -> None:
    """Write the torque that a sampled controller asks for at the sample `k`, and renew its memory."""
    for j in range(len(implicit)):
        q = state[POSITION, j]
        seen = law[NOW, j] * q + law[LAST, j] * state[EARLIER, j] + law[LAST_BUT_ONE, j] * state[BEFORE, j]
        seen += law[POLE, j] * state[FILTERED, j]
        direct = law[NOW, j] == 0.0
        speed = ahead[j, 0] if direct else seen
        error, slip = place[k, j] - q, rate[k, j] - speed
        state[INTEGRAL, j] += step * (law[INTEGRAL_PLACE, j] * error + law[INTEGRAL_RATE, j] * slip)
        torque = forward[k, j] + law[PROPORTIONAL, j] * error + state[INTEGRAL, j]
        implicit[j] = 0.0
        if abs(torque + law[DERIVATIVE, j] * slip) > law[LIMIT, j]:
            torque = np.copysign(law[LIMIT, j], torque + law[DERIVATIVE, j] * slip)
        elif direct:
            torque += law[DERIVATIVE, j] * rate[k, j]
            implicit[j] = law[DERIVATIVE, j]
        else:
            torque += law[DERIVATIVE, j] * slip
        out[j, 0] = torque
        state[BEFORE, j], state[EARLIER, j], state[FILTERED, j] = state[EARLIER, j], q, speed


@njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, error_model="numpy")
def _rub(rate, factor, scale, weights, levels, held, before, after, step) -> None:
    """Find what friction takes: changes the acceleration, `held`, and the speeds after the step.

    It starts from what is held already, which the acceleration contains.
    """
    frictions, joints = weights.shape
    answer, coupled = np.empty((frictions, joints)), np.empty((frictions, frictions))
    push, old, every = np.zeros(frictions), held.copy(), np.arange(frictions)
    couple(answer, coupled, factor, scale, 0, weights, every)
    for e in range(frictions):
        for j in range(joints):
            push[e] += weights[e, j] * after[j, 0] / step
        for f in range(frictions):
            push[e] += coupled[e, f] * old[f]
    settle(coupled, push, levels, held)
    for e in range(frictions):
        for j in range(joints):
            after[j, 0] -= step * answer[e, j] * (held[e] - old[e])
    stop(after, 0, weights, every, held, levels)
    for j in range(joints):
        rate[j, 0] = (after[j, 0] - before[j, 0]) / step


@njit(inline="always")
def _slides_on(weights, levels, held, after) -> bool:
    """Tell whether every friction slides the way it is held against, at its level."""
    for e in range(len(levels)):
        speed = 0.0
        for j in range(len(after)):
            speed += weights[e, j] * after[j, 0]
        if abs(held[e]) != levels[e] or speed * held[e] <= 0.0:
            return False
    return True


@njit(inline="always")
def kick(out, implicit, mass, scale, drives, offset, bias, levels, held, before, after, step) -> None:
    """Turn the drive's torque into the acceleration, and give the speeds after the step."""
    inertia, damping, weights = drives
    joints = len(implicit)
    for j in range(joints):
        out[j, 0] -= offset[j] + bias[j, 0] + implicit[j] * before[j, 0]
        for e in range(len(levels)):
            out[j, 0] -= weights[e, j] * held[e]
    add_drives(out, mass, before, inertia, damping, FIRST, ONE)
    for i in range(joints):
        for j in range(i + 1):
            mass[i * joints + j, 0] += 0.5 * step * damping[i, j]
        mass[i * joints + i, 0] += 0.5 * step * implicit[i]
    factorise(mass, scale, joints, ONE)
    substitute(out, mass, scale, joints, ONE)
    for j in range(joints):
        after[j, 0] = before[j, 0] + step * out[j, 0]
    if not _slides_on(weights, levels, held, after):
        _rub(out, mass, scale, weights, levels, held, before, after, step)


@njit(inline="always")
def _write(motion, share, k, drives, stiffness, offset, levels, held, state, rate, velocity, bodies) -> None:
    """Write the sample's row: what the joints do, and the torque that this takes."""
    position, speed, acceleration, torque = motion
    inertia, damping, weights = drives
    for i in range(len(offset)):
        position[k, i], speed[k, i], acceleration[k, i] = state[POSITION, i], velocity[i, 0], rate[i, 0]
        total = bodies[i, 0] + offset[i]
        for j in range(len(offset)):
            total += inertia[i, j] * rate[j, 0] + damping[i, j] * velocity[j, 0]
        for e in range(len(levels)):
            total += weights[e, i] * held[e]
        for j in range(len(stiffness)):
            total += stiffness[i, j] * state[POSITION, j]
        torque[k, i] = total
    for e in range(len(levels)):
        share[k, e] = held[e] / levels[e]


@njit(inline="always")
def _drift(state, place, before, ahead, out, implicit, step, way) -> None:
    """Move the positions on for the time `way`, and foresee the velocities that will belong to them."""
    for j in range(len(implicit)):
        before[j, 0] = state[SPEED, j]
        state[POSITION, j] += way * before[j, 0]
        place[j, 0] = state[POSITION, j]
        ahead[j, 0] = before[j, 0] + 0.5 * step * state[ACCELERATION, j]
        out[j, 0], implicit[j] = state[HELD, j], 0.0


@njit(inline="always")
def _keep(state, implicit, before, after, rate, velocity, step, asked) -> bool:
    """Keep what the next step needs; tells whether a joint is faster than any robot's, or its speed nan.

    `asked` is the share of the controller's new torque in this step: the damping in what it holds is whole.
    """
    failed = False
    for j in range(len(implicit)):
        velocity[j, 0] = before[j, 0] + 0.5 * step * rate[j, 0]
        state[SPEED, j], state[ACCELERATION, j] = after[j, 0], rate[j, 0]
        state[HELD, j] -= implicit[j] / asked * velocity[j, 0]
        failed |= not abs(after[j, 0]) <= FASTEST
    return failed


@njit(inline="always")
def _ask(out, implicit, law, state, ahead, inputs, k, step, back, sampled, begin) -> float:
    """Write the torque of the controller: at every step, or where a sample is reached (`back` is 0).

    Gives the share of the new torque in the step. A step lies half before and half after its positions: at a
    sample, the torque held until then is the other half.
    """
    asked = 0.5 if sampled and back == 0.0 and not begin else 1.0
    if not sampled:
        _drive(out, implicit, law, state, inputs[0], inputs[1], inputs[2], k, step, back)
    elif back == 0.0:
        command(out, implicit, law, state, ahead, inputs[0], inputs[1], inputs[2], k, step)
    for j in range(len(implicit)):
        last, state[HELD, j] = state[HELD, j], out[j, 0]
        out[j, 0] = asked * out[j, 0] + (1.0 - asked) * last
        implicit[j] *= asked
        if back == 0.0:
            state[FORWARD, j], state[PLACE, j], state[RATE, j] = (
                inputs[0][k, j],
                inputs[1][k, j],
                inputs[2][k, j],
            )
    return asked


@njit(inline="always")
def tables_of(joints, links) -> tuple[np.ndarray, ...]:
    """Give the tables of one step, singly, so that the compiler knows that they are apart."""
    column = (joints, 1)
    return (
        np.zeros(column),
        np.zeros(column),
        np.zeros(column),
        np.zeros(column),
        np.zeros(column),
        np.zeros(column),
        np.zeros(column),
        np.zeros(column),
        np.zeros((joints * joints, 1)),
        np.zeros((links + 1, 9, 1)),
    )


@njit(
    f"int64({ROBOT}, UniTuple({TABLE}, 3), {TABLE}, float64[::1], float64[::1], {TABLE},"
    f" UniTuple({TABLE}, 3), {TABLE}, float64[::1], UniTuple({TABLE}, 4), {TABLE}, float64, int64, boolean,"
    " boolean)",
    **OPTIONS,
)
def play(  # pragma: no cover  (compiled)
    robot,
    drives,
    stiffness,
    offset,
    levels,
    law,
    inputs,
    state,
    held,
    motion,
    share,
    step,
    substeps,
    sampled,
    fresh,
) -> int:
    """Step through all samples of the inputs; gives the sample at which it failed, or -1.

    Parameters
    ----------
    drives
        Inertia and damping that the bodies do not have, and weights of frictions: see `Mechanism`.
    stiffness
        Of springs between coordinates, coordinates x coordinates; empty where there is none.
    law, inputs
        The controller (see `LAW_ROWS`), and per sample its feed-forward torque, position and velocity wanted.
    state, held
        What is changed in place: see `STATE_ROWS`, and the torque of every friction.
    motion, share
        What is written: position, velocity, acceleration and torque, and frictions as shares of their levels.
    step
        Time between samples, s.
    sampled
        Whether the controller acts at samples and holds its torque between them, or at every step.
    fresh
        Whether the first sample is where the state starts, so that nothing moves before it.
    """
    joints, links, part = len(offset), len(robot[1]), step / substeps
    scratch, implicit = scratch_of(links, robot[7], 1), np.zeros(joints)
    out, place, ahead, before, after, velocity, bodies, scale, mass, kept = tables_of(joints, links)
    still = np.zeros((joints, 1))
    for k in range(len(inputs[0])):
        begin = fresh and k == 0
        for number in range(substeps - 1 if begin else 0, substeps):
            _drift(state, place, before, ahead, out, implicit, part, 0.0 if begin else part)
            back = (substeps - number - 1) / substeps
            asked = _ask(out, implicit, law, state, ahead, inputs, k, step, back, sampled, begin)
            lane_springs(out, stiffness, place)
            lane_place(robot, scratch, kept, place)
            lane_torque(robot, scratch, kept, ahead, still, bodies)
            lane_mass(robot, scratch, kept, mass, joints)
            kick(out, implicit, mass, scale, drives, offset, bodies, levels, held, before, after, part)
            if _keep(state, implicit, before, after, out, velocity, part, asked):
                return k
        lane_torque(robot, scratch, kept, velocity, out, bodies)
        _write(motion, share, k, drives, stiffness, offset, levels, held, state, out, velocity, bodies)
    return -1
