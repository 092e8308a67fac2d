"""Draw the reference motions: Fourier series of five harmonics within an arm's bounds, in mid-motion.

Source: Swevers et al., IEEE Trans. Robotics and Automation 13(5), 1997.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from tests.plant.excitation import BLEND, Excitation
from tests.plant.robots import Arm

HARMONICS: Final = 5
BASE_HZ: Final[Mapping[str, float]] = {"slow": 0.1, "fast": 1.0}
"""Lowest frequency, Hz; the highest is five times as large."""
_ROOM, _SPEED = 0.42, 0.7
"""Shares of the positions' range and of the top speed that a motion uses."""


@dataclass(frozen=True, eq=False)
class Reference:
    """Hold a reference motion."""

    whole: Excitation

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Give positions (rad) and velocities at the times (s), which may be negative for a second."""
        position, velocity, _ = self.whole.at(time + BLEND + 1.0)
        return position, velocity

    @property
    def centre(self) -> np.ndarray:
        """Give the middle of the motion, rad."""
        return self.whole.centre


def draw_reference(arm: Arm, kind: str, seed: int, seconds: float) -> Reference:
    """Draw a motion and scale every joint until it touches the first of its bounds."""
    rng = np.random.default_rng([seed, arm.joints])
    shape = (HARMONICS, arm.joints)
    rate = 2.0 * np.pi * BASE_HZ[kind] * np.arange(1, HARMONICS + 1)[:, None] * np.ones(shape)
    duration = seconds + 2.0 * BLEND + 2.0
    amplitude = rng.uniform(0.4, 1.0, shape) / np.sqrt(rate)
    phase = rng.uniform(-np.pi, np.pi, shape)
    raw = Excitation(duration, np.zeros(arm.joints), amplitude, rate, phase)
    inner = np.arange(BLEND, duration - BLEND, 0.1 / (HARMONICS * BASE_HZ[kind]) / 5.0)
    position, velocity, acceleration = (np.abs(value).max(axis=0) for value in raw.at(inner))
    room = np.stack(
        [
            _ROOM * (arm.upper - arm.lower) / position,
            _SPEED * arm.speed / velocity,
            arm.acceleration / acceleration,
        ]
    ).min(axis=0)
    centre = 0.5 * (arm.lower + arm.upper)
    return Reference(Excitation(duration, centre, amplitude * room, rate, phase))
