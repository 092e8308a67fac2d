"""Hide effects of the encoders: a zero error, a once-per-turn error, a coarse step.

They act on the log only; the controller tracks the true angle.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from tests.plant.controller import Steering
from tests.plant.effects.effect import Effect, Signals
from tests.plant.effects.friction import any_joint
from tests.plant.robots import Arm


@dataclass(frozen=True)
class EncoderOffset(Effect):
    """Log the angle of one joint plus `offset`."""

    offset: float
    cause = "encoder_offset"
    draw_order = 21
    parameters = ("offset",)
    units: ClassVar = {"offset": "rad"}
    sizes = ("offset",)
    largest = 0.3

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint and a sign."""
        return cls(any_joint(rng, arm), float(rng.choice([-0.03, 0.03])))

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Shift the angle."""
        position = signals.position.copy()
        position[:, self.own] += self.offset
        return replace(signals, position=position)


@dataclass(frozen=True)
class EncoderEccentricity(Effect):
    """Log the angle of one joint plus amplitude sin(q + phase)."""

    amplitude: float
    phase: float
    cause = "encoder_eccentricity"
    draw_order = 22
    parameters = ("amplitude", "phase")
    units: ClassVar = {"amplitude": "rad", "phase": "rad"}
    sizes = ("amplitude",)
    largest = 0.3

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint and a phase."""
        return cls(any_joint(rng, arm), 0.02, rng.uniform(-np.pi, np.pi))

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Add the wave, and let the derivatives follow it."""
        position, velocity, acceleration = (
            one.copy() for one in (signals.position, signals.velocity, signals.acceleration)
        )
        q, dq, ddq = position[:, self.own], velocity[:, self.own], acceleration[:, self.own]
        sine, cosine = self.amplitude * np.sin(q + self.phase), self.amplitude * np.cos(q + self.phase)
        acceleration[:, self.own] = ddq * (1.0 + cosine) - sine * dq**2
        velocity[:, self.own] = dq * (1.0 + cosine)
        position[:, self.own] = q + sine
        return replace(signals, position=position, velocity=velocity, acceleration=acceleration)


@dataclass(frozen=True)
class EncoderQuantization(Effect):
    """Give one encoder a step of `lsb` at the joint."""

    lsb: float
    cause = "encoder_quantization"
    draw_order = 23
    parameters = ("lsb",)
    units: ClassVar = {"lsb": "rad"}
    sizes = ("lsb",)
    largest = 0.05
    raw = True

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Start from half a milliradian."""
        return cls(any_joint(rng, arm), 5e-4)

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Coarsen the step; the recorder rounds to it."""
        step = signals.encoder_step.copy()
        step[self.own] = max(self.lsb, step[self.own])
        return replace(signals, encoder_step=step)
