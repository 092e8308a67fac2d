"""Move an arm under a sampled controller: pinocchio's bodies in steps of 0.1 ms, and friction of our own.

Noise of the encoders goes round the robot's own loop. The torque is held between two instants of the
controller, and a log's torque is the mean of what was held over one of its cycles about the stamp: a sensor
that showed the new torque alone would be half a cycle early in every log.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
import pinocchio as pin

from benchmarks.estimators.friction import coulomb_step, presliding_step
from benchmarks.estimators.loops import Loop
from benchmarks.estimators.motions import Reference
from tests.plant.robots import Arm
from tests.tools import pinocchio_model
from veritorque.core.signals.state import MotionState

STEP: Final = 1e-4
"""Seconds of a step."""
LOG_STEP: Final = 1e-3
WARM_UP: Final = 0.5
"""Seconds before the log, in which the loop settles."""
FASTEST: Final = 1e3
"""rad/s; a joint that is faster has run away."""


class RunawayError(Exception):
    """Say that a loop is not stable with this noise."""


@dataclass(frozen=True, eq=False)
class Run:
    """Hold one simulated log, samples x joints in SI.

    Attributes
    ----------
    seen
        Positions as the encoders show them.
    state
        The true motion, with the shares of friction; accelerations and shares are means over a cycle of the
        controller about the stamp, as the torque is.
    torque
        Without noise of its sensors.
    command, feed_forward
        What the controller asked for at the stamp, and the part of it that it knew beforehand.
    position_ref, velocity_ref
        What the controller was given.
    """

    time: np.ndarray
    seen: np.ndarray
    state: MotionState
    torque: np.ndarray
    command: np.ndarray
    feed_forward: np.ndarray
    position_ref: np.ndarray
    velocity_ref: np.ndarray


@dataclass(frozen=True, eq=False)
class Plant:
    """Hold an arm with its friction and its controller.

    `presliding` makes the friction of a truth that no Coulomb model has.
    """

    arm: Arm
    loop: Loop
    presliding: bool = False

    def run(self, reference: Reference, seconds: float, noise_rad: float = 0.0, seed: int = 0) -> Run:
        """Follow a reference for some seconds, with white noise of the encoders.

        Raises
        ------
        RunawayError
            If a joint runs away.
        """
        return _Simulation(self, reference, seconds, noise_rad, seed).run()

    def changed(self, standard: np.ndarray, names: tuple[str, ...]) -> "Plant":
        """Give the plant of other standard parameters, in the order of these names."""
        return replace(self, arm=arm_of(self.arm, standard, names))


_DRIVES: Final = {"IA": "rotor_inertia", "FV": "viscous", "FC": "coulomb", "OFF": "offset"}


def standard_of(arm: Arm, names: tuple[str, ...]) -> np.ndarray:
    """Give the arm's standard parameters of those names: bodies in the order of the links, drives by name."""
    drives = {
        f"{symbol}{joint + 1}": float(getattr(arm, part)[joint])
        for symbol, part in _DRIVES.items()
        for joint in range(arm.joints)
    }
    bodies = iter(arm.bodies.ravel())
    return np.array([drives[name] if name in drives else float(next(bodies)) for name in names])


def arm_of(arm: Arm, standard: np.ndarray, names: tuple[str, ...]) -> Arm:
    """Give the arm that has these standard parameters."""
    values = dict(zip(names, standard, strict=True))
    drives = {
        part: np.array([values.pop(f"{symbol}{joint + 1}") for joint in range(arm.joints)])
        for symbol, part in _DRIVES.items()
    }
    return replace(arm, bodies=np.array(list(values.values())).reshape(arm.bodies.shape), **drives)


class _Simulation:
    """Carry one simulation: its state, and what every step left."""

    def __init__(
        self, plant: Plant, reference: Reference, seconds: float, noise_rad: float, seed: int
    ) -> None:
        self.plant, self.arm, self.loop = plant, plant.arm, plant.loop
        self.model = pinocchio_model(self.arm.robot, self.arm.bodies)
        self.data = self.model.createData()
        self.per_cycle, self.per_row = round(self.loop.cycle / STEP), round(LOG_STEP / STEP)
        self.before = round(WARM_UP / STEP)
        cycles = (self.before + round(seconds / STEP)) // self.per_cycle + 2
        time = np.arange(cycles) * self.loop.cycle - WARM_UP
        self.position_ref, self.velocity_ref = reference.at(time)
        rng = np.random.default_rng(seed)
        self.noise = noise_rad * rng.normal(size=self.position_ref.shape)
        self.rows = round(seconds / LOG_STEP)
        steps = cycles * self.per_cycle
        self.position, self.velocity, self.acceleration, self.held, self.torque = np.empty(
            (5, steps, self.arm.joints)
        )

    @cached_property
    def feed_forward(self) -> np.ndarray:
        return self.loop.feed_forward(self.velocity_ref)

    def run(self) -> Run:
        memory = self.loop.start(self.position_ref[0], self.velocity_ref[0])
        self.q, self.half = self.position_ref[0].copy(), self.velocity_ref[0].copy()
        self.friction, self.bristle = np.zeros((2, self.arm.joints))
        self.last = np.zeros(self.arm.joints)
        self.commands, self.seen = np.empty_like(self.noise), np.empty_like(self.noise)
        for cycle, (wanted, rate, forward) in enumerate(
            zip(self.position_ref, self.velocity_ref, self.feed_forward, strict=True)
        ):
            self.seen[cycle] = self.q + self.noise[cycle]
            self.commands[cycle] = forward + self.loop.command(memory, wanted, rate, self.seen[cycle])
            first, last = cycle * self.per_cycle, max(cycle - 1, 0)
            # a step lies half before and half after its positions, at which the command changes
            self._advance(first, 0.5 * (self.commands[last] + self.commands[cycle]))
            for step in range(first + 1, first + self.per_cycle):
                self._advance(step, self.commands[cycle])
            if not np.abs(self.half).max() < FASTEST:
                raise RunawayError(f"a joint of {self.arm.name} runs away after {cycle} cycles")
        return self._log()

    def _advance(self, step: int, command: np.ndarray) -> None:
        """Take one step from the position that is reached."""
        arm, ahead = self.arm, self.half + 0.5 * STEP * self.last
        mass = pin.crba(self.model, self.data, self.q)
        bias = pin.nonLinearEffects(self.model, self.data, self.q, ahead)
        self.position[step], self.velocity[step] = self.q, self.half
        self.torque[step], self.last = command, self.acceleration[step]
        given = (mass, bias, arm.rotor_inertia, arm.viscous, self.half, command - arm.offset)
        if self.plant.presliding:
            presliding_step(*given, arm.coulomb, self.friction, STEP, self.last, self.bristle)
        else:
            coulomb_step(*given, arm.coulomb, self.friction, STEP, self.last)
        self.held[step] = self.friction
        self.velocity[step] = 0.5 * (self.velocity[step] + self.half)
        self.q = self.q + STEP * self.half

    def _log(self) -> Run:
        """Take the rows of the log, and the true motion at their stamps."""
        rows = self.before + self.per_row * np.arange(self.rows)
        cycles = rows // self.per_cycle
        state = MotionState(
            self.position[rows],
            self.velocity[rows],
            self._mean(self.acceleration, rows),
            np.arange(self.rows) * LOG_STEP,
            friction_share=self._mean(self.held, rows) / self.arm.coulomb,
        )
        return Run(
            time=np.arange(self.rows) * LOG_STEP,
            seen=self.seen[cycles],
            state=state,
            torque=self._mean(self.torque, rows),
            command=self.commands[cycles],
            feed_forward=self.feed_forward[cycles],
            position_ref=self.position_ref[cycles],
            velocity_ref=self.velocity_ref[cycles],
        )

    def _mean(self, series: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Average over one cycle of the controller about the rows, by the trapezoid of steps."""
        half = self.per_cycle // 2
        inner = sum(series[rows + shift] for shift in range(1 - half, half))
        return np.asarray((inner + 0.5 * (series[rows - half] + series[rows + half])) / self.per_cycle)
