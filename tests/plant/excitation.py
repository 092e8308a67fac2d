"""Draw a band-limited multisine motion that starts and ends at rest and stays within an arm's bounds.

Every joint reverses many times and sees the whole range of its speeds. Source: Swevers et al., IEEE Trans.
Robotics and Automation 13(5), 1997.
"""

from dataclasses import dataclass

import numpy as np

from tests.plant.robots import Arm

SINES = 7
LOWEST_HZ, HIGHEST_HZ = 0.08, 1.0
BLEND = 1.5
"""Seconds in which the motion grows out of rest and returns to it, by a quintic polynomial."""


@dataclass(frozen=True, eq=False)
class Excitation:
    """Describe q(t) = centre + window(t) sum_k amplitude_k sin(rate_k t + phase_k), arrays sines x joints."""

    duration: float
    centre: np.ndarray
    amplitude: np.ndarray
    rate: np.ndarray
    phase: np.ndarray

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Give position (rad), velocity and acceleration at the times (s), each samples x joints."""
        angle = time[:, None, None] * self.rate + self.phase
        sine, cosine = self.amplitude * np.sin(angle), self.amplitude * self.rate * np.cos(angle)
        swing, slope, bend = sine.sum(axis=1), cosine.sum(axis=1), -(sine * self.rate**2).sum(axis=1)
        w, dw, ddw = (column[:, None] for column in _window(time, self.duration))
        return self.centre + w * swing, w * slope + dw * swing, w * bend + 2.0 * dw * slope + ddw * swing


def draw_excitation(arm: Arm, rng: np.random.Generator, duration: float = 30.0) -> Excitation:
    """Draw one motion and scale every joint until it touches the first of its bounds."""
    shape = (SINES, arm.joints)
    rate = 2.0 * np.pi * np.exp(rng.uniform(np.log(LOWEST_HZ), np.log(HIGHEST_HZ), shape))
    raw = Excitation(
        duration,
        np.zeros(arm.joints),
        rng.uniform(0.4, 1.0, shape) / np.sqrt(rate),
        rate,
        rng.uniform(-np.pi, np.pi, shape),
    )
    position, velocity, acceleration = (
        np.abs(value).max(axis=0) for value in raw.at(np.arange(0.0, duration, 0.02))
    )
    room = np.stack(
        [
            0.46 * (arm.upper - arm.lower) / position,
            0.85 * arm.speed / velocity,
            arm.acceleration / acceleration,
        ]
    ).min(axis=0)
    return Excitation(duration, 0.5 * (arm.lower + arm.upper), raw.amplitude * room, rate, raw.phase)


def _window(time: np.ndarray, duration: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Grow from 0 to 1 over the blend and fall back at the end, with two continuous derivatives."""
    rising, falling = np.clip(time / BLEND, 0.0, 1.0), np.clip((duration - time) / BLEND, 0.0, 1.0)
    x = np.minimum(rising, falling)
    direction = np.where(rising <= falling, 1.0, -1.0) / BLEND
    value = x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
    slope = 30.0 * x**2 * (1.0 - x) ** 2 * direction
    return value, slope, 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / BLEND**2
