"""Hide effects of the drive: a wrong or curved torque constant, a drifting offset, a clipped torque, ripple.

The first three act on the log only, saturation and ripple on the robot.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from tests.plant.controller import Steering
from tests.plant.effects.effect import Effect, Signals, State
from tests.plant.effects.friction import any_joint
from tests.plant.robots import Arm


def on_channel(signals: Signals, joint: int, change: np.ndarray) -> Signals:
    """Add a torque (N m), given at every step of the simulation, to one logged channel."""
    torque = signals.fine_torque.copy()
    torque[:, joint] += change
    return signals.with_torque(torque)


def torque_rms(steering: Steering, joint: int) -> float:
    """Give the RMS of the nominal torque, N m."""
    return float(np.sqrt(np.mean(steering.nominal[:, joint] ** 2)))


@dataclass(frozen=True)
class TorqueGain(Effect):
    """Log (1 + relative_error) times the torque on one channel."""

    relative_error: float
    cause = "torque_gain"
    draw_order = 13
    parameters = ("relative_error",)
    units: ClassVar = {"relative_error": "1"}
    sizes = ("relative_error",)
    largest = 0.6

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint and a sign."""
        return cls(any_joint(rng, arm), float(rng.choice([-0.1, 0.1])))

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Scale the channel."""
        return on_channel(signals, self.own, self.relative_error * signals.fine_torque[:, self.own])


@dataclass(frozen=True)
class TorqueGainNonlinear(Effect):
    """Log the torque plus cubic_coefficient times its cube on one channel."""

    cubic_coefficient: float
    peak: float
    cause = "torque_gain_nonlinear"
    draw_order = 14
    parameters = ("cubic_coefficient",)
    units: ClassVar = {"cubic_coefficient": "1/(N m)^2"}
    sizes = ("cubic_coefficient",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a curvature that takes a tenth off or adds it at the motion's peak torque."""
        joints = any_joint(rng, arm)
        peak = float(np.abs(steering.nominal[:, joints[0] - 1]).max())
        return cls(joints, float(rng.choice([-0.1, 0.1])) / peak**2, peak)

    def plausible(self) -> bool:
        """Keep the curve rising: at most a third is lost at the peak."""
        return abs(self.cubic_coefficient) * self.peak**2 <= 0.33

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Bend the channel."""
        return on_channel(signals, self.own, self.cubic_coefficient * signals.fine_torque[:, self.own] ** 3)


@dataclass(frozen=True)
class TorqueOffsetDrift(Effect):
    """Let the offset of one logged channel drift by total_drift from the first row to the last.

    It drifts evenly where time_constant is zero, else as 1 - exp(-t / time_constant).
    """

    total_drift: float
    time_constant: float
    cause = "torque_offset_drift"
    draw_order = 15
    parameters = ("total_drift",)
    units: ClassVar = {"total_drift": "N m"}
    sizes = ("total_drift",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a shape and a sign."""
        joints = any_joint(rng, arm)
        size = 0.1 * torque_rms(steering, joints[0] - 1)
        return cls(
            joints, float(rng.choice([-1, 1])) * size, float(rng.choice([0.0, rng.uniform(5.0, 15.0)]))
        )

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Add the drift."""
        end, course = signals.time[-1], signals.fine_time
        if self.time_constant > 0.0:
            end, course = (1.0 - np.exp(-time / self.time_constant) for time in (end, course))
        return on_channel(signals, self.own, self.total_drift * course / end)


@dataclass(frozen=True)
class TorqueSaturation(Effect):
    """Clip the applied torque at plus and minus the limit; the log keeps the command.

    Its size is how far the motion's peak torque exceeds the limit, (peak / limit - 1).
    """

    limit: float
    peak: float
    cause = "torque_saturation"
    draw_order = 16
    parameters = ("limit",)
    units: ClassVar = {"limit": "N m"}

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint whose peak torque is a fifth above the limit."""
        joints = any_joint(rng, arm)
        peak = float(np.abs(steering.nominal[:, joints[0] - 1]).max())
        return cls(joints, peak / 1.2, peak)

    def scaled(self, factor: float) -> Self:
        """Lower the limit."""
        return replace(self, limit=self.peak / (1.0 + factor * (self.peak / self.limit - 1.0)))

    def plausible(self) -> bool:
        """Leave at least half of the peak torque."""
        return self.limit >= 0.5 * self.peak

    def drive(self, command: np.ndarray) -> np.ndarray:
        """Clip."""
        applied = command.copy()
        applied[self.own] = min(max(command[self.own], -self.limit), self.limit)
        return applied


@dataclass(frozen=True)
class TorqueRipple(Effect):
    """Demand amplitude cos(harmonic q + phase) of the drive."""

    amplitude: float
    harmonic: float
    phase: float
    cause = "torque_ripple"
    draw_order = 12
    parameters = ("amplitude", "harmonic", "phase")
    units: ClassVar = {"amplitude": "N m", "harmonic": "1", "phase": "rad"}
    sizes = ("amplitude",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a harmonic which the log can resolve."""
        joints = any_joint(rng, arm)
        size = 0.05 * torque_rms(steering, joints[0] - 1)
        return cls(joints, size, float(rng.integers(4, 21)), rng.uniform(-np.pi, np.pi))

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Resist with the wave."""
        torque[self.own] -= self.amplitude * np.cos(self.harmonic * state.position[self.own] + self.phase)


@dataclass(frozen=True)
class TorqueDeadZone(Effect):
    """Log zero on one channel where the torque is below `half_width`, and elsewhere as much less."""

    half_width: float
    cause = "torque_dead_zone"
    draw_order = 31
    parameters = ("half_width",)
    units: ClassVar = {"half_width": "N m"}
    sizes = ("half_width",)
    raw = True

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Start from a twentieth of the torque."""
        (joint,) = any_joint(rng, arm)
        return cls((joint,), 0.05 * torque_rms(steering, joint - 1))

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Take the width from the torque; where nothing is left, there is no noise either."""
        torque = signals.fine_torque[:, self.own]
        taken = -np.clip(torque, -self.half_width, self.half_width)
        silent = (*signals.silent, self.own) if self.half_width > 0.0 else signals.silent
        return replace(on_channel(signals, self.own, taken), silent=silent)
