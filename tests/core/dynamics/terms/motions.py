"""Make smooth motions of a few joints on a uniform clock."""

import numpy as np

from veritorque.core.signals.state import MotionState


def swinging(joints: int = 2, seconds: float = 10.0, rate_hz: float = 250.0, seed: int = 0) -> MotionState:
    """Swing every joint as a sum of three sines (rad, s), derivatives exact; temperatures rise by 10 K."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(seconds * rate_hz)) / rate_hz
    rate = 2.0 * np.pi * rng.uniform(0.15, 0.9, (3, joints))
    size, phase = rng.uniform(0.2, 0.6, (3, joints)), rng.uniform(-np.pi, np.pi, (3, joints))
    angle = time[:, None, None] * rate + phase
    return MotionState(
        (size * np.sin(angle)).sum(axis=1),
        (size * rate * np.cos(angle)).sum(axis=1),
        -(size * rate**2 * np.sin(angle)).sum(axis=1),
        time,
        30.0 + 10.0 * np.linspace(0.0, 1.0, len(time))[:, None] * np.ones(joints),
    )


def cycle(samples: int = 20001) -> MotionState:
    """Go once around a closed path of one joint: out and back between -1 and 1 rad in two seconds."""
    time = np.linspace(0.0, 2.0, samples)
    position = np.sin(np.pi * time) + 0.3 * np.sin(2.0 * np.pi * time)
    velocity = np.pi * np.cos(np.pi * time) + 0.6 * np.pi * np.cos(2.0 * np.pi * time)
    acceleration = -(np.pi**2) * (np.sin(np.pi * time) + 1.2 * np.sin(2.0 * np.pi * time))
    return MotionState(position[:, None], velocity[:, None], acceleration[:, None], time)
