"""Close the position loop: three sampled controllers, whose noise of encoders becomes torque.

``L1`` is a soft PD at the log's rate; ``L2`` BIRDy's own, stiff and five times as fast, whose speed of finite
differences makes encoder noise into torque; ``L3`` is L1 with a first-order low pass on the speed and
friction that is fed forward, as industrial controllers have.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.estimators.arms import Driven

SOFT: Final = (0.1, 0.32)
"""Shares of BIRDy's proportional and derivative gains that L1 and L3 have."""
CUTOFF_HZ: Final = 50.0
KNOWN: Final = 0.9
"""Share of its friction that L3 feeds forward."""
EASE: Final = 0.02
"""Share of a joint's top speed over which it turns round."""


@dataclass
class Memory:
    """Hold what a controller remembers: the last position that it saw, and the filtered speed."""

    position: np.ndarray
    speed: np.ndarray


@dataclass(frozen=True, eq=False)
class Loop:
    """Hold a PD controller."""

    driven: Driven
    cycle: float
    """Seconds from one command to the next."""
    shares: tuple[float, float] = (1.0, 1.0)
    """Of the arm's stiff gains."""
    cutoff_hz: float = 0.0
    """Of the low pass on the speed; 0 for none."""
    feeds: bool = False
    """Whether friction is fed forward."""

    @property
    def is_soft(self) -> bool:
        """Tell whether it is the one whose log the Cramer-Rao bound is computed for: `L1`."""
        return self.shares == SOFT and not self.cutoff_hz

    def start(self, position: np.ndarray, velocity: np.ndarray) -> Memory:
        """Give the memory of a controller that has followed its reference."""
        return Memory(position - self.cycle * velocity, velocity.copy())

    def command(self, memory: Memory, wanted: np.ndarray, rate: np.ndarray, seen: np.ndarray) -> np.ndarray:
        """Give the torque (N m) for what the encoders show, and renew the memory."""
        pole = np.exp(-2.0 * np.pi * self.cutoff_hz * self.cycle) if self.cutoff_hz else 0.0
        memory.speed = pole * memory.speed + (1.0 - pole) * (seen - memory.position) / self.cycle
        memory.position = seen
        kp, kd = self.shares[0] * self.driven.kp, self.shares[1] * self.driven.kd
        return np.asarray(kp * (wanted - seen) + kd * (rate - memory.speed))

    def feed_forward(self, rate: np.ndarray) -> np.ndarray:
        """Give the torque (N m) that is known beforehand along a reference's velocities."""
        arm = self.driven.arm
        friction = arm.coulomb * np.tanh(rate / (EASE * arm.speed)) + arm.viscous * rate
        return np.asarray(KNOWN * self.feeds * friction)


def loop_of(name: str, own: Driven) -> Loop:
    """Give a loop by its name."""
    return {
        "L1": Loop(own, 1e-3, SOFT),
        "L2": Loop(own, 2e-4),
        "L3": Loop(own, 1e-3, SOFT, CUTOFF_HZ, feeds=True),
    }[name]


LOOPS: Final[Mapping[str, str]] = {
    "L1": "PD at the log's rate",
    "L2": "stiff PD at 5 kHz",
    "L3": "filtered speed, friction fed forward",
}
