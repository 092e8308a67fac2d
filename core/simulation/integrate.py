"""Carry many states forward in time with friction that is a set: one scheme of order two.

The scheme is Heun's with the linear damping taken implicitly (Verwer's ROS2, a W-method: order two whatever
is taken implicitly, and stable for any damping). Friction keeps its direction within a step; where a speed
would change sign, the step is cut there, and at that instant friction decides afresh whether it holds. So the
order survives reversals. Terms that depend on acceleration are shown the last one known: order one in them.
Sources: Verwer, Spee, Blom & Hundsdorfer, SIAM J. Sci. Comput. 20(4), 1999; Acary & Brogliato 2008, ch. 8.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..errors import SolverError
from . import forward as kernel
from .drive import Drive
from .mechanism import Mechanism
from .stage import States, rates

LONGEST_STEP = 1e-3
"""The integrator's longest step, s."""
FASTEST = 1e4
"""A joint faster than this (rad/s or m/s) has left what any robot can do."""
GAMMA = 1.0 - np.sqrt(0.5)
_CUTS = 12
"""After so many cuts within a step, what changes its direction is put to rest instead."""


def steps_between(step: float, asked: int | None = None) -> int:
    """Count the steps of a simulation between two samples (s): those asked for, or none above the longest."""
    return asked or max(1, int(np.ceil(step / LONGEST_STEP - 1e-9)))


@dataclass(frozen=True, eq=False)
class Stride:
    """Say where in a drive's step states are: number, shares passed and to go, and who (None: all)."""

    number: int
    passed: np.ndarray
    to_go: np.ndarray
    lanes: np.ndarray | None


@dataclass(frozen=True, eq=False)
class Integrator:
    """Integrate a driven mechanism, with steps no longer than `longest_step` (s)."""

    mechanism: Mechanism
    drive: Drive
    drag: np.ndarray
    """Damping per joint, N m s/rad, that is taken implicitly and given back as it stands: where terms without
    a compiled form damp so strongly, the scheme stays stable, and its order whatever they do."""
    longest_step: float = LONGEST_STEP

    @np.errstate(over="ignore", invalid="ignore")
    def advance(self, states: States, number: int) -> States:
        """Go from the drive's instant `number` to the next one.

        Raises
        ------
        SolverError
            If the motion diverges, or the mass matrix is not positive definite.
        """
        parts = max(1, int(np.ceil(self.drive.step / self.longest_step - 1e-9)))
        for part in range(parts):
            count = len(states.time)
            passed, to_go = np.full(count, part / parts), np.full(count, 1.0 / parts)
            states = self._part(states, Stride(number, passed, to_go, None))
        _check(states)  # also what overflowed
        return states

    @cached_property
    def damping(self) -> np.ndarray:
        """Give the mechanism's damping with the controller's and the drag, N m s/rad."""
        back = self.drive.feedback
        return self.mechanism.damping + np.diag(self.drag + (0.0 if back is None else back.damping))

    def _drive_torque(self, stride: Stride, share: np.ndarray, states: States) -> np.ndarray:
        """Give the drives' torque after a share of a step, and the drag back."""
        torque = self.drive.at(stride.number, share, stride.lanes, states)
        return np.asarray(torque + self.drag[:, None] * states.velocity)

    def _part(self, states: States, stride: Stride) -> States:
        """Take one step, in as many pieces as there are reversals in it."""
        trial, slope = self._heun(states, stride)
        share = self._first_reversal(states, trial, slope, stride)
        if share is None:
            return trial
        lanes: np.ndarray = np.flatnonzero(share < 1.0)
        before = states.chosen(lanes)
        left = replace(stride, passed=stride.passed[lanes], to_go=stride.to_go[lanes], lanes=lanes)
        share = share[lanes]
        for cuts in range(_CUTS, 0, -1):
            before = self._cut(before, left, share)
            left = replace(left, passed=left.passed + share * left.to_go, to_go=(1.0 - share) * left.to_go)
            after, slope = self._heun(before, left)
            found = self._first_reversal(before, after, slope, left)
            if found is None or cuts == 1:
                trial.put(lanes, after if found is None else self._stop_reversed(before, after))
                break
            done, again = np.flatnonzero(found == 1.0), np.flatnonzero(found < 1.0)
            trial.put(lanes[done], after.chosen(done))
            before, share = before.chosen(again), found[again]
            lanes = lanes[again]
            left = Stride(left.number, left.passed[again], left.to_go[again], lanes)
        return trial

    def _heun(self, states: States, stride: Stride) -> tuple[States, np.ndarray]:
        """Take one step without looking at reversals; also gives the acceleration it began with."""
        time = self.drive.step * stride.to_go
        damping, implicit = self.damping, GAMMA * time
        torque = self._drive_torque(stride, stride.passed, states)
        first = rates(self.mechanism, states, torque, implicit=implicit, damping=damping)
        ahead = replace(states.later(time), acceleration=first.acceleration, direction=first.direction)
        kernel.predict(
            states.position, states.velocity, first.acceleration, time, ahead.position, ahead.velocity
        )
        torque = self._drive_torque(stride, stride.passed + stride.to_go, ahead)
        known = 2.0 * first.acceleration
        second = rates(self.mechanism, ahead, torque, known=known, implicit=implicit, damping=damping)
        after = replace(states.later(time), acceleration=second.acceleration, direction=second.direction)
        kernel.correct(
            states.position,
            states.velocity,
            first.acceleration,
            ahead.velocity,
            second.acceleration,
            time,
            after.position,
            after.velocity,
        )
        return self._undo_release(states, after), first.acceleration

    def _undo_release(self, before: States, after: States) -> States:
        """Put back to rest what left it against the way it was let go."""
        left = (before.direction == 0.0) & (after.direction != 0.0)
        if not left.any():
            return after
        against = left & (after.direction * (self.mechanism.weights @ after.velocity) <= 0.0)
        return _stop(self.mechanism, after, against)

    def _first_reversal(
        self, before: States, after: States, slope: np.ndarray, stride: Stride
    ) -> np.ndarray | None:
        """Give the share of the step after which the first sliding speed changes sign, if one does."""
        weights = self.mechanism.weights
        if not len(weights):
            return None
        end = weights @ after.velocity
        reversed_ = before.direction * end < 0.0
        if not reversed_.any():
            return None
        begin = weights @ before.velocity
        rate = (weights @ slope) * (self.drive.step * stride.to_go)
        return np.asarray(np.where(reversed_, _root(begin, rate, end), 1.0).min(axis=0))

    def _cut(self, before: States, stride: Stride, share: np.ndarray) -> States:
        """Step up to the first reversal and put what reverses there to rest."""
        at, slope = self._heun(before, replace(stride, to_go=share * stride.to_go))
        begin, end = (np.abs(self.mechanism.weights @ state.velocity) for state in (before, at))
        moving = before.direction != 0.0
        scale = begin + np.abs(self.mechanism.weights @ slope) * (self.drive.step * stride.to_go)
        nearest = np.where(moving, end / np.maximum(scale, np.finfo(float).tiny), np.inf)
        return _stop(self.mechanism, at, nearest == nearest.min(axis=0))

    def _stop_reversed(self, before: States, after: States) -> States:
        """Put to rest whatever changed its direction."""
        end = self.mechanism.weights @ after.velocity
        return _stop(self.mechanism, after, before.direction * end < 0.0)


def _stop(mechanism: Mechanism, states: States, stops: np.ndarray) -> States:
    """Take the speed from frictions (those of one joint exactly) and mark them at rest."""
    velocity = states.velocity.copy()
    for row, weights in enumerate(mechanism.weights):
        joints = np.flatnonzero(weights)
        if len(joints) == 1:
            velocity[joints[0], stops[row]] = 0.0
    return replace(states, velocity=velocity, direction=np.where(stops, 0.0, states.direction))


def _root(begin: np.ndarray, rate: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Give the first root in [0, 1] of the parabola through begin, with slope rate there, and end."""
    bend = end - begin - rate
    with np.errstate(invalid="ignore", divide="ignore"):
        spread = np.sqrt(np.maximum(rate * rate - 4.0 * bend * begin, 0.0))
        root = 2.0 * begin / (-rate + np.where(begin > 0.0, spread, -spread))
    return np.asarray(np.clip(np.nan_to_num(root, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0 - 1e-12))


def _check(states: States) -> None:
    speed = np.abs(states.velocity)
    if speed.max(initial=0.0) <= FASTEST:  # nan is not
        return
    joint, lane = (int(number) for number in np.argwhere(~(speed <= FASTEST))[0])
    raise failure(joint, float(speed[joint, lane]), float(states.time[lane]))


def failure(joint: int, speed: float, time: float) -> SolverError:
    """Say that a joint (from 0) cannot be simulated further: its speed is nan, or beyond any robot's."""
    return SolverError(
        "the simulated robot cannot be accelerated: its mass matrix is not positive definite"
        if np.isnan(speed)
        else "the simulated motion diverges",
        evidence={"time": time, "joint": joint + 1, "speed": speed},
        remedy="simulate parameters that the semidefinite programme has estimated, and check that the"
        " measured torque belongs to the measured motion",
    )
