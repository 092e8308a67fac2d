"""Hide what acts on the robot from outside: a load taken up, a spring, a cable, a contact."""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.plant.controller import Steering
from tests.plant.effects.drive import torque_rms
from tests.plant.effects.effect import Effect, Hidden, State
from tests.plant.effects.friction import any_joint
from tests.plant.robots import Arm


@dataclass(frozen=True)
class PayloadChange(Effect):
    """Attach a body to the last link at `time` seconds, which stays there.

    Its mass (kg) has its centre at com_x, com_y, com_z (m) in the last link's frame and a radius of gyration
    of 3 cm.
    """

    mass: float
    com_x: float
    com_y: float
    com_z: float
    time: float
    cause = "payload_change"
    draw_order = 26
    parameters = ("mass", "com_x", "com_y", "com_z", "time")
    units: ClassVar = {"mass": "kg", "com_x": "m", "com_y": "m", "com_z": "m", "time": "s"}
    sizes = ("mass",)
    local = False

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a body of a tenth of the last link's mass, taken up in the middle half of the log."""
        duration = len(steering.command) * 0.0005
        own = 0.1 * float(arm.bodies[-1][9])
        centre = rng.uniform(-0.05, 0.05, 3) + np.array([0.0, 0.0, 0.08])
        if arm.name.startswith("planar"):
            centre = np.array([rng.uniform(0.1, 0.3), *rng.uniform(-0.03, 0.03, 2)])
        return cls((arm.joints,), own, *(float(one) for one in centre), rng.uniform(0.3, 0.7) * duration)

    def carried(self) -> tuple[float, tuple[float, float, float]]:
        """Give mass and mass centre."""
        return self.mass, (self.com_x, self.com_y, self.com_z)


@dataclass(frozen=True)
class SpringCompensator(Effect):
    """Demand stiffness (q - rest_angle) of the drive; rest angle and offset are not distinguished."""

    stiffness: float
    rest_angle: float
    cause = "spring_compensator"
    draw_order = 27
    parameters = ("stiffness",)
    units: ClassVar = {"stiffness": "N m/rad"}
    sizes = ("stiffness",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint and a rest angle near the middle of its range."""
        joints = any_joint(rng, arm)
        own = joints[0] - 1
        width = arm.upper[own] - arm.lower[own]
        rest = 0.5 * (arm.upper[own] + arm.lower[own]) + rng.uniform(-0.1, 0.1) * width
        return cls(joints, 0.2 * torque_rms(steering, own) / width, rest)

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Pull towards the rest angle."""
        torque[self.own] -= self.stiffness * (state.position[self.own] - self.rest_angle)


@dataclass(frozen=True)
class CableForce(Effect):
    """Demand stiffness (q - engage_angle) of the drive beyond the angle, nothing before it."""

    stiffness: float
    engage_angle: float
    cause = "cable_force"
    draw_order = 28
    parameters = ("stiffness", "engage_angle")
    units: ClassVar = {"stiffness": "N m/rad", "engage_angle": "rad"}
    sizes = ("stiffness",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw an angle that the motion passes for a good part of its time."""
        joints = any_joint(rng, arm)
        own = joints[0] - 1
        angle = steering.centre[own] + rng.uniform(0.0, 0.15) * (arm.upper[own] - arm.lower[own])
        return cls(joints, 0.4 * torque_rms(steering, own), angle)

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Pull back."""
        torque[self.own] -= self.stiffness * max(state.position[self.own] - self.engage_angle, 0.0)


@dataclass(frozen=True)
class ExternalContact(Effect):
    """Push at the last link with a constant direction in the base frame, in half sine waves over `intervals`.

    `force` is the peak in N, at 10 cm from the last frame's origin along its z and x axes.
    """

    force: float
    direction: tuple[float, float, float]
    intervals: tuple[tuple[float, float], ...]
    cause = "external_contact"
    draw_order = 29
    parameters = ("force",)
    units: ClassVar = {"force": "N"}
    sizes = ("force",)
    local = False

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw two to four contacts of 0.3 to 0.8 s and a direction."""
        duration = len(steering.command) * 0.0005
        starts = np.sort(rng.uniform(0.1, 0.9, rng.integers(2, 5))) * duration
        spans = tuple((float(start), float(start + rng.uniform(0.3, 0.8))) for start in starts)
        direction = rng.normal(size=3)
        if arm.name.startswith("planar"):
            direction[1] = 0.0
        direction /= np.linalg.norm(direction)
        size = 0.3 * float(np.max(np.abs(steering.nominal[:, -1])))
        return cls(tuple(range(1, arm.joints + 1)), 5.0 * size, tuple(map(float, direction)), spans)

    def truth(self) -> tuple[Hidden, ...]:
        """Give the peak force and, numbered from 1, where the intervals begin and end."""
        ends = [
            Hidden(f"{name}_{number}", self.joints[0], "s", end)
            for number, span in enumerate(self.intervals, start=1)
            for name, end in zip(("start", "end"), span, strict=True)
        ]
        return (*super().truth(), *ends)

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Carry the force to the joints by virtual work."""
        for start, end in self.intervals:
            if start < state.time < end:
                size = self.force * np.sin(np.pi * (state.time - start) / (end - start))
                torque += state.jacobian().T @ (size * np.array(self.direction))
