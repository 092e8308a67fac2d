"""Hide effects of friction: most change the level of the set-valued friction at the true state.

A level of L means a drive torque of +L where the joint moves forwards, -L backwards, and anything between
where it sticks.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from tests.plant.controller import Steering
from tests.plant.effects.effect import Effect, Hidden, Signals, State
from tests.plant.robots import Arm

STUCK = 3e-5
"""Path in rad within which a joint counts as sticking."""
SHORTEST = 3e-4
"""A presliding distance below this (rad) is over before the next row of the log."""


def any_joint(rng: np.random.Generator, arm: Arm) -> tuple[int]:
    """Draw a joint, counted from 1."""
    return (int(rng.integers(1, arm.joints + 1)),)


@dataclass(frozen=True)
class Stribeck(Effect):
    """Raise the level near standstill: level + excess_torque exp(-(v / stribeck_velocity)^2)."""

    excess_torque: float
    stribeck_velocity: float
    cause = "friction_stribeck"
    draw_order = 1
    parameters = ("excess_torque", "stribeck_velocity")
    units: ClassVar = {"excess_torque": "N m", "stribeck_velocity": "rad/s"}
    sizes = ("excess_torque",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint and a scale."""
        joints = any_joint(rng, arm)
        speed = rng.uniform(0.04, 0.15) * arm.speed[joints[0] - 1]
        return cls(joints, 0.3 * arm.coulomb[joints[0] - 1], speed)

    def friction(self, state: State, level: np.ndarray) -> None:
        """Add the bump."""
        ratio = state.velocity[self.own] / self.stribeck_velocity
        level[self.own] += self.excess_torque * np.exp(-ratio * ratio)


@dataclass(frozen=True)
class ViscousNonlinear(Effect):
    """Add to the level coefficient |v|^exponent."""

    coefficient: float
    exponent: float
    cause = "friction_viscous_nonlinear"
    draw_order = 2
    parameters = ("coefficient", "exponent")
    units: ClassVar = {"coefficient": "N m (s/rad)^p", "exponent": "1"}
    sizes = ("coefficient",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw an exponent well away from one, where it would be viscous friction."""
        joints = any_joint(rng, arm)
        exponent = float(rng.choice([0.4, 0.5, 0.6, 1.7, 2.0, 2.5]))
        typical = 0.5 * arm.speed[joints[0] - 1]
        return cls(joints, 0.3 * arm.coulomb[joints[0] - 1] / typical**exponent, exponent)

    def friction(self, state: State, level: np.ndarray) -> None:
        """Add the power."""
        level[self.own] += self.coefficient * abs(state.velocity[self.own]) ** self.exponent


@dataclass(frozen=True)
class Asymmetric(Effect):
    """Demand delta_viscous |v| in both directions: half the difference of forward and backward viscosity.

    `mean_viscous` is what it is half the difference around: more would be friction that drives.
    """

    delta_viscous: float
    mean_viscous: float
    cause = "friction_asymmetric"
    draw_order = 3
    parameters = ("delta_viscous",)
    units: ClassVar = {"delta_viscous": "N m s/rad"}
    sizes = ("delta_viscous",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a share of the viscous friction, of either sign."""
        joints = any_joint(rng, arm)
        mean = float(arm.viscous[joints[0] - 1])
        return cls(joints, float(rng.choice([-0.3, 0.3])) * mean, mean)

    def plausible(self) -> bool:
        """Tell whether friction brakes in both directions."""
        return abs(self.delta_viscous) <= self.mean_viscous

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Brake more forwards and less backwards, or the other way round."""
        torque[self.own] -= self.delta_viscous * abs(state.velocity[self.own])


@dataclass(frozen=True)
class LoadDependent(Effect):
    """Add load_coefficient |load| to the level: a share of what the gear transmits to the link."""

    load_coefficient: float
    cause = "friction_load_dependent"
    draw_order = 4
    parameters = ("load_coefficient",)
    units: ClassVar = {"load_coefficient": "1"}
    sizes = ("load_coefficient",)
    largest = 0.5

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint."""
        return cls(any_joint(rng, arm), 0.05)

    def friction(self, state: State, level: np.ndarray) -> None:
        """Add the share of the load."""
        level[self.own] += self.load_coefficient * abs(state.load[self.own])


@dataclass(frozen=True)
class Temperature(Effect):
    """Let the level follow the warmth: level + (coulomb_slope + viscous_slope |v|) warmth.

    With a sensor (`logged`) the warmth is the rise of the logged temperature in K above its first value,
    without one it is 1 - exp(-t / time_constant), so that the slopes are the change over the whole warm-up,
    in N m and N m s/rad. Friction may fade to nothing, and no further: the `level` that there is bounds it.
    """

    coulomb_slope: float
    viscous_slope: float
    time_constant: float
    logged: bool
    level: float
    cause = "friction_temperature"
    draw_order = 5
    parameters = ("coulomb_slope", "viscous_slope", "time_constant")
    units: ClassVar = {"coulomb_slope": "N m", "viscous_slope": "N m s/rad", "time_constant": "s"}
    sizes = ("coulomb_slope", "viscous_slope")
    rise = 15.0

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a loss of friction, with or without a sensor."""
        joints = any_joint(rng, arm)
        own, logged = joints[0] - 1, bool(rng.integers(2))
        share = -0.25 / (cls.rise if logged else 1.0)
        slopes = share * arm.coulomb[own], share * arm.viscous[own] * rng.uniform(0.5, 1.0)
        return cls(joints, *slopes, rng.uniform(5.0, 20.0), logged, float(arm.coulomb[own]))

    def plausible(self) -> bool:
        """Tell whether friction brakes however warm it is."""
        return abs(self.coulomb_slope) * self._warmth(np.inf) <= self.level

    def truth(self) -> tuple[Hidden, ...]:
        """Give the slopes per kelvin where there is a sensor."""
        listed = super().truth()
        if not self.logged:
            return listed
        return tuple(replace(one, unit=one.unit + "/K") for one in listed[:2])

    def friction(self, state: State, level: np.ndarray) -> None:
        """Change the level by the warmth."""
        level[self.own] += self.coulomb_slope * self._warmth(state.time)

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Change viscous friction by the warmth."""
        torque[self.own] -= self.viscous_slope * state.velocity[self.own] * self._warmth(state.time)

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Log the temperatures of all joints, with a resolution of 0.05 K, where there is a sensor."""
        if not self.logged:
            return signals
        temperature = np.full_like(signals.position, 25.0)
        temperature[:, self.own] += self.rise * (1.0 - np.exp(-signals.time / self.time_constant))
        noisy = temperature + rng.normal(scale=0.05, size=temperature.shape)
        return replace(signals, temperature=0.05 * np.round(noisy / 0.05))

    def _warmth(self, time: float) -> float:
        return (1.0 - float(np.exp(-time / self.time_constant))) * (self.rise if self.logged else 1.0)


@dataclass(frozen=True)
class PositionDependent(Effect):
    """Add to the level amplitude cos(harmonic q + phase); the wave is not deeper than the `level` itself."""

    amplitude: float
    harmonic: float
    phase: float
    level: float
    cause = "friction_position_dependent"
    draw_order = 6
    parameters = ("amplitude", "harmonic", "phase")
    units: ClassVar = {"amplitude": "N m", "harmonic": "1", "phase": "rad"}
    sizes = ("amplitude",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a low harmonic."""
        joints = any_joint(rng, arm)
        harmonic, phase = float(rng.integers(1, 7)), rng.uniform(-np.pi, np.pi)
        level = float(arm.coulomb[joints[0] - 1])
        return cls(joints, 0.3 * level, harmonic, phase, level)

    def plausible(self) -> bool:
        """Tell whether friction brakes everywhere."""
        return abs(self.amplitude) <= self.level

    def friction(self, state: State, level: np.ndarray) -> None:
        """Add the wave."""
        level[self.own] += self.amplitude * np.cos(self.harmonic * state.position[self.own] + self.phase)


@dataclass(frozen=True)
class Presliding(Effect):
    """Let the friction build up over presliding_distance after each reversal (Dahl's model).

    The state z follows dz = (sign(v) - z) |v| dt / presliding_distance, and the drive feels level times z.
    """

    presliding_distance: float
    cause = "friction_presliding"
    draw_order = 7
    parameters = ("presliding_distance",)
    units: ClassVar = {"presliding_distance": "rad"}
    sizes = ("presliding_distance",)
    largest = 0.3
    last = True

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint."""
        return cls(any_joint(rng, arm), 0.003)

    def plausible(self) -> bool:
        """Keep the distance within what a log can show and a gear can have."""
        return SHORTEST <= self.presliding_distance <= self.largest

    def friction(self, state: State, level: np.ndarray) -> None:
        """Take the set-valued friction away and keep its level for Dahl's."""
        state.memory[f"level {self.own}"] = max(float(level[self.own]), 0.0)
        level[self.own] = 0.0

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Advance the state exactly over the step's path and resist.

        Beside it a state of one encoder count's distance says which direction plain friction would have.
        """
        velocity = float(state.velocity[self.own])
        path = abs(velocity) * state.step
        for name, distance in (("bristle", max(self.presliding_distance, STUCK)), ("direction", STUCK)):
            key = f"{name} {self.own}"
            goal = 1.0 if velocity > 0.0 else -1.0
            state.memory[key] = goal + (state.memory.get(key, 0.0) - goal) * np.exp(-path / distance)
        torque[self.own] -= state.memory[f"level {self.own}"] * state.memory[f"bristle {self.own}"]
