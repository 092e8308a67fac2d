"""Set the scene of the benchmarks: YuMi's left arm, a body per link, and smooth random motion at 250 Hz.

Frequencies are drawn at random, so that a motion of an hour does not repeat itself.
"""

from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np

from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.reduction.base import BaseModel, base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.inertia import from_mass_properties
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.state import MotionState

RATE_HZ: Final = 250.0
HARMONICS: Final = 6
NOISE_SHARE: Final = 0.02
"""Torque noise as a share of the joint's torque."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Hold a robot, its model, base parameters, plan of columns, and parameters of a possible robot."""

    robot: RobotModel
    model: DynamicModel
    base: BaseModel
    plan: ColumnPlan
    truth: np.ndarray

    def torque(self, state: MotionState) -> np.ndarray:
        """Predict joint torque without noise, N m."""
        values = self.base.base_of(self.truth)
        torque = np.zeros_like(state.position)
        for (joint, column), row in zip(self.plan.entries, self.plan.series(state), strict=True):
            torque[:, joint] += values[column] * row
        return torque


@cache
def yumi_arm() -> Scene:
    """Give YuMi's left arm with plausible bodies and drives."""
    return scene_of(builtin_robot("yumi-left"))


def scene_of(robot: RobotModel) -> Scene:
    """Give a robot plausible bodies and drives, drawn with a fixed seed."""
    model = standard_model(robot)
    base = base_model(model)
    rng = np.random.default_rng(7)
    drives = {"IA": 0.02, "FV": 0.3, "FC": 0.8, "OFF": 0.1}
    truth = np.array([drives.get(parameter.symbol, 0.0) for parameter in model.parameters])
    place = {parameter.name: column for column, parameter in enumerate(model.parameters)}
    for number in range(1, len(robot.links) + 1):
        spread = rng.normal(scale=0.05, size=(3, 3)) + 0.04 * np.eye(3)
        second = spread @ spread.T
        inertia = np.trace(second) * np.eye(3) - second
        first = place[f"XX{number}"]
        truth[first : first + 10] = from_mass_properties(1.0, rng.normal(scale=0.05, size=3), inertia)
    return Scene(robot, model, base, ColumnPlan(model, base.kept), truth)


@dataclass(frozen=True, eq=False)
class Motion:
    """Describe q(t) per joint as a sum of sines: amplitudes in rad, frequencies in Hz, phases in rad."""

    amplitude: np.ndarray
    frequency_hz: np.ndarray
    phase: np.ndarray

    def at(self, time: np.ndarray) -> MotionState:
        """Give position, velocity and acceleration at the times (s)."""
        rate = 2.0 * np.pi * self.frequency_hz
        position, velocity, acceleration = (np.zeros((len(time), rate.shape[1])) for _ in range(3))
        for amplitude, speed, phase in zip(self.amplitude, rate, self.phase, strict=True):
            angle = np.outer(time, speed) + phase
            sine, cosine = np.sin(angle), np.cos(angle)
            position += amplitude * sine
            velocity += amplitude * speed * cosine
            acceleration -= amplitude * speed**2 * sine
        return MotionState(position, velocity, acceleration)


def smooth_motion(joints: int, seed: int = 3) -> Motion:
    """Draw a motion of sines between 0.05 and 0.6 Hz."""
    rng = np.random.default_rng(seed)
    shape = (HARMONICS, joints)
    return Motion(
        rng.uniform(0.1, 0.35, shape), rng.uniform(0.05, 0.6, shape), rng.uniform(0.0, 2.0 * np.pi, shape)
    )
