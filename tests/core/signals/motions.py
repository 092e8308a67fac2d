"""Make logs whose motion is known in closed form, so that every derivative has a true value."""

from dataclasses import dataclass

import numpy as np

from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import Joint, Link, RobotModel


@dataclass(frozen=True, eq=False)
class Multisine:
    """Move each joint by a sum of sines: rows are joints, columns are components (rad, Hz, rad)."""

    amplitude: np.ndarray
    frequency_hz: np.ndarray
    phase: np.ndarray

    @classmethod
    def random(cls, rng: np.random.Generator, joints: int, *, highest_hz: float = 1.0) -> "Multisine":
        """Draw three components per joint, none slower than a tenth of the highest."""
        shape = (joints, 3)
        return cls(
            rng.uniform(0.2, 0.6, shape),
            highest_hz * rng.uniform(0.1, 1.0, shape),
            rng.uniform(-np.pi, np.pi, shape),
        )

    def derivative(self, time: np.ndarray, order: int) -> np.ndarray:
        """Give the derivative of this order at these instants, samples by joints."""
        pace = 2.0 * np.pi * self.frequency_hz
        angle = time[:, None, None] * pace + self.phase + 0.5 * np.pi * order
        return (self.amplitude * pace**order * np.sin(angle)).sum(axis=-1)

    def position(self, time: np.ndarray) -> np.ndarray:
        """Give the positions, rad."""
        return self.derivative(time, 0)


def turntables(joints: int) -> RobotModel:
    """Make a robot whose only part in a test is its number of joints."""
    links = tuple(
        Link(f"link_{number}", "revolute", number - 1, number, np.eye(3), np.array([0.3, 0.0, 0.0]))
        for number in range(1, joints + 1)
    )
    return RobotModel(
        "turntables",
        links,
        tuple(Joint(f"joint_{number}") for number in range(1, joints + 1)),
        np.array([0.0, 0.0, -9.81]),
    )


def log_of(time: np.ndarray, position: np.ndarray, torque: np.ndarray | None = None) -> JointLog:
    """Log positions (rad) with torques (N m); without any, with their sines."""
    return log_from_arrays("known", time, position, np.sin(position) if torque is None else torque)


def jittered(rng: np.random.Generator, samples: int, rate_hz: float, share: float) -> np.ndarray:
    """Give stamps (s) that stray from a uniform clock by up to a share of a step."""
    return (np.arange(samples) + rng.uniform(-share, share, samples)) / rate_hz
