"""Choose a motion that makes the arm's parameters visible: a Fourier series per joint, by random search.

Every draw is scaled into the joint limits; of all draws, that one is kept whose observation matrix is
conditioned best. Source: Swevers et al., IEEE Trans. Robotics and Automation 13(5), 1997.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
import pinocchio as pin

from examples.yumi import arm

HARMONICS: Final = 5
BASE_PERIOD: Final = 12.0
DURATION: Final = 30.0
BLEND: Final = 1.5
"""Seconds in which the motion grows out of rest and returns to it, by a quintic polynomial."""

DRAWS: Final = 200
MAX_ACCELERATION: Final = np.array([10.0, 10.0, 14.0, 14.0, 25.0, 25.0, 30.0])
"""Bounds of the reference's acceleration, rad/s2."""


@dataclass(frozen=True, eq=False)
class Excitation:
    """Describe the motion q(t) = centre + window(t) sum_k (sine_k sin kwt + cosine_k cos kwt), all in rad."""

    centre: np.ndarray
    sine: np.ndarray
    cosine: np.ndarray

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Give position, velocity and acceleration at the times (s), each samples x joints."""
        rate = 2.0 * np.pi / BASE_PERIOD * np.arange(1, HARMONICS + 1)
        angle = np.outer(time, rate)
        sine, cosine = np.sin(angle), np.cos(angle)
        swing = sine @ self.sine + cosine @ self.cosine
        slope = (cosine * rate) @ self.sine - (sine * rate) @ self.cosine
        bend = -(sine * rate**2) @ self.sine - (cosine * rate**2) @ self.cosine
        w, dw, ddw = (column[:, None] for column in window(time))
        return self.centre + w * swing, w * slope + dw * swing, w * bend + 2.0 * dw * slope + ddw * swing


def window(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Grow from 0 to 1 over the blend and fall back at the end, with two continuous derivatives.

    Examples
    --------
    >>> [float(value) for value in window(np.array([0.0, BLEND / 2, DURATION / 2, DURATION]))[0]]
    [0.0, 0.5, 1.0, 0.0]
    """
    rising = np.clip(time / BLEND, 0.0, 1.0)
    falling = np.clip((DURATION - time) / BLEND, 0.0, 1.0)
    x = np.minimum(rising, falling)
    direction = np.where(rising <= falling, 1.0, -1.0) / BLEND
    value = x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
    slope = 30.0 * x**2 * (1.0 - x) ** 2 * direction
    bend = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / BLEND**2
    return value, slope, bend


def draw(generator: np.random.Generator) -> Excitation:
    """Draw one motion at random and scale every joint until it touches the first of its limits."""
    shape = (HARMONICS, arm.JOINTS)
    centre = 0.5 * (arm.LOWER + arm.UPPER)
    raw = Excitation(np.zeros(arm.JOINTS), generator.normal(size=shape), generator.normal(size=shape))
    position, velocity, acceleration = (np.abs(value).max(axis=0) for value in raw.at(_grid(0.02)))
    room = np.stack(
        [
            0.46 * (arm.UPPER - arm.LOWER) / position,
            0.85 * arm.MAX_VELOCITY / velocity,
            MAX_ACCELERATION / acceleration,
        ]
    ).min(axis=0)
    return Excitation(centre, raw.sine * room, raw.cosine * room)


def condition_number(
    model: pin.Model, motion: Excitation, directions: np.ndarray, noise: np.ndarray
) -> float:
    """Condition the observation matrix of the motion, rows divided by the joint's torque noise (N m)."""
    samples = zip(*motion.at(_grid(0.2)), strict=True)
    rows = [_rows(model, sample) / noise[:, None] for sample in samples]
    return float(np.linalg.cond(np.vstack(rows) @ directions))


def distinguishable(model: pin.Model) -> np.ndarray:
    """Span the parameter directions that any motion at all can show (columns orthonormal)."""
    generator = np.random.default_rng(0)
    samples = generator.uniform(-1.0, 1.0, size=(60, 3, arm.JOINTS)) * 3.0
    observation = np.vstack([_rows(model, sample) for sample in samples])
    _, singular, directions = np.linalg.svd(observation, full_matrices=False)
    return np.asarray(directions[singular > 1e-9 * singular[0]].T)


def best_of_many(model: pin.Model, seed: int, noise: np.ndarray) -> Excitation:
    """Search at random, always the same for the same seed."""
    generator = np.random.default_rng(seed)
    directions = distinguishable(model)
    candidates = [draw(generator) for _ in range(DRAWS)]
    return min(candidates, key=lambda motion: condition_number(model, motion, directions, noise))


def _grid(spacing: float) -> np.ndarray:
    return np.arange(0.0, DURATION + spacing / 2, spacing)


def _rows(model: pin.Model, sample: tuple[np.ndarray, ...] | np.ndarray) -> np.ndarray:
    position, velocity, acceleration = sample
    data = model.createData()
    inertial = pin.computeJointTorqueRegressor(model, data, position, velocity, acceleration)
    drives = [np.diag(acceleration), np.diag(velocity), np.diag(np.sign(velocity)), np.eye(arm.JOINTS)]
    return np.hstack([inertial, *drives])
