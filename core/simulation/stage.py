"""Give the accelerations of many states at once: torques of every kind in, rates and what friction holds out.

Terms without a compiled form are evaluated for all states together. A jump that such a term makes where its
joint's velocity changes sign is friction: its half height adds to the level that can hold the joint.
"""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ..arrays import JointSeries, Samples
from ..signals.state import MotionState
from . import forward
from .inverse import columns
from .mechanism import Mechanism

CREEP = 1e-9
"""Speed (rad/s or m/s) at which a term's torque just beside standstill is evaluated."""
SLIGHTLY = 1e-3
"""Step in speed (rad/s or m/s) over which the damping of a term is evaluated."""


@dataclass(frozen=True, eq=False)
class States:
    """Hold states side by side; tables are (joints, states), `direction` (frictions, states)."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    """The last one known, for terms that depend on it."""
    direction: np.ndarray
    """Way in which each friction slides, 1 or -1; 0 at rest."""
    time: np.ndarray
    """Of every state, s."""
    temperature: np.ndarray | None = None
    """Of every joint, degC; None where none was logged."""
    log: np.ndarray | None = None
    """Number of the log that each is of."""

    @classmethod
    def starting(cls, mechanism: Mechanism, state: MotionState) -> Self:
        """Take over a measured state; what has no speed at all is at rest."""
        velocity = columns(state.velocity)
        return cls(
            position=columns(state.position),
            velocity=velocity,
            acceleration=columns(state.acceleration),
            direction=np.sign(mechanism.weights @ velocity),
            time=np.zeros(len(state.position)) if state.time is None else state.time,
            temperature=None if state.temperature is None else columns(state.temperature),
            log=state.log,
        )

    def chosen(self, which: np.ndarray) -> Self:
        """Pick some of the states, by their numbers."""
        temperature = None if self.temperature is None else np.take(self.temperature, which, axis=1)
        tables = (self.position, self.velocity, self.acceleration, self.direction)
        position, velocity, acceleration, direction = (np.take(table, which, axis=1) for table in tables)
        return replace(
            self,
            position=position,
            velocity=velocity,
            acceleration=acceleration,
            direction=direction,
            time=self.time[which],
            temperature=temperature,
            log=None if self.log is None else self.log[which],
        )

    def later(self, time: np.ndarray) -> Self:
        """Give room for the states a time (s) later: position and velocity are still to be written."""
        position, velocity = np.empty_like(self.position), np.empty_like(self.velocity)
        return replace(self, position=position, velocity=velocity, time=self.time + time)

    def put(self, which: np.ndarray, other: Self) -> None:
        """Overwrite some of the states in place."""
        self.position[:, which] = other.position
        self.velocity[:, which] = other.velocity
        self.acceleration[:, which] = other.acceleration
        self.direction[:, which] = other.direction
        self.time[which] = other.time


@dataclass(frozen=True, eq=False)
class Rates:
    """Hold accelerations (per s2), the directions after friction has decided, and what is held at rest."""

    acceleration: np.ndarray
    direction: np.ndarray
    held: np.ndarray


def rates(
    mechanism: Mechanism,
    states: States,
    torque: np.ndarray,
    *,
    known: np.ndarray | None = None,
    implicit: np.ndarray | None = None,
    damping: np.ndarray | None = None,
) -> Rates:
    """Solve (M + implicit D) a = torque - all other torques - M known.

    Parameters
    ----------
    torque
        The drives' torque, N m or N, (joints, states).
    known, implicit
        A known part of the rate (zero by default), and a time per state, s (zero by default).
    damping
        The mechanism's own by default; a controller adds to it.
    """
    _, count = torque.shape
    applied = torque - mechanism.offset[:, None]
    level = np.repeat(mechanism.levels[:, None], count, axis=1)
    if mechanism.others.names:
        smooth, jump = _other_torques(mechanism, states)
        applied -= smooth
        level = _with_jumps(mechanism, level, jump)
    answer, held = _moved_bodies(
        mechanism,
        mechanism.damping if damping is None else damping,
        states.time,
        (
            states.position,
            states.velocity,
            applied,
            np.zeros((0, count)) if known is None else known,
            np.zeros(count) if implicit is None else implicit,
            states.direction,
            level,
        ),
    )
    if not len(level):
        return Rates(answer, states.direction, np.zeros(level.shape, dtype=bool))
    resting = states.direction == 0.0
    stuck = resting & (np.abs(held) < level)
    # what yields without a level to overcome goes where it is accelerated to
    way = np.where(held != 0.0, np.sign(held), np.sign(mechanism.weights @ answer))
    return Rates(answer, np.where(resting & ~stuck, way, states.direction), stuck)


def accelerations(mechanism: Mechanism, state: MotionState, torque: JointSeries) -> JointSeries:
    """Give the acceleration (per s2) that a torque (N m or N) causes at every state.

    A joint that stands still stays so where friction can hold it. The state's own acceleration is only shown
    to terms that depend on it. What depends on the motion before the instant, or is a fault of the torque
    channel, has to be taken out of the torque first (`core.simulation.along`).
    """
    found = rates(mechanism, States.starting(mechanism, state), columns(torque))
    return np.asarray(found.acceleration.T)


def _moved_bodies(
    mechanism: Mechanism, damping: np.ndarray, time: Samples, tables: tuple[np.ndarray, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Give accelerations and what holds, each state with the bodies of its time; tables as the kernel's."""
    drives = (mechanism.inertia, damping, mechanism.weights)
    bodies, phase = mechanism.phases.bodies, mechanism.phases.at(time)
    answer, held = np.empty_like(tables[2]), np.zeros_like(tables[-1])
    if len(bodies) == 1:
        forward.accelerations(bodies[0], *drives, *tables, answer, held)
        return answer, held
    for number in np.unique(phase):
        lanes = np.flatnonzero(phase == number)
        part = [np.take(table, lanes, axis=-1) for table in tables]
        rate, kept = np.empty_like(part[2]), np.zeros_like(part[-1])
        forward.accelerations(bodies[number], *drives, *part, rate, kept)
        answer[:, lanes], held[:, lanes] = rate, kept
    return answer, held


def _other_torques(mechanism: Mechanism, states: States) -> tuple[np.ndarray, np.ndarray]:
    """Give the torque of the other terms, and half of their jump for joints at rest, (joints, states)."""
    way = np.zeros_like(states.velocity)
    for row, weights in enumerate(mechanism.weights[: mechanism.joints]):
        way[np.argmax(weights)] = states.direction[row]
    against = way * states.velocity < 0.0
    velocity = np.where(against | (way != 0.0) & (states.velocity == 0.0), CREEP * way, states.velocity)
    resting = way == 0.0
    if not resting.any():
        return _evaluate(mechanism, states, velocity), np.zeros_like(velocity)
    ahead, behind = (np.where(resting, sign * CREEP, velocity) for sign in (1.0, -1.0))
    # Either side in one go: what a term costs hardly depends on how many states there are.
    count, rests = velocity.shape[1], np.flatnonzero(resting.any(axis=0))
    both = states.chosen(np.concatenate([np.arange(count), rests]))
    torque = _evaluate(mechanism, both, np.hstack([ahead, behind[:, rests]]))
    smooth, other = torque[:, :count], torque[:, count:]
    jump = np.zeros_like(velocity)
    jump[:, rests] = np.where(resting[:, rests], 0.5 * (smooth[:, rests] - other), 0.0)
    smooth[:, rests] = 0.5 * (smooth[:, rests] + other)
    return smooth, jump


def drag_of(mechanism: Mechanism, states: States) -> np.ndarray:
    """Give how strongly the other terms damp each joint at most, N m s/rad, as they start.

    Slopes are taken between two speeds above the present one, where no friction jumps.
    """
    if not mechanism.others.names:
        return np.zeros(mechanism.joints)
    step = SLIGHTLY * np.where(states.velocity < 0.0, -1.0, 1.0)
    slower, faster = (_evaluate(mechanism, states, states.velocity + count * step) for count in (1.0, 2.0))
    return np.asarray(np.maximum((faster - slower) / step, 0.0).max(axis=1, initial=0.0))


def _evaluate(mechanism: Mechanism, states: States, velocity: np.ndarray) -> np.ndarray:
    temperature = None if states.temperature is None else states.temperature.T
    motion = states.position.T, velocity.T, states.acceleration.T
    state = MotionState(*motion, states.time, temperature, states.log)
    return np.asarray(mechanism.others.torque(state).T)


def _with_jumps(mechanism: Mechanism, level: np.ndarray, jump: np.ndarray) -> np.ndarray:
    """Add the jumps to the levels of the joints' own frictions; a level is never negative."""
    raised = level.copy()
    raised[: mechanism.joints] += jump
    return np.asarray(np.maximum(raised, 0.0))
