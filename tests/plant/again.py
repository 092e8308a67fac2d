"""Record the same arm again and again, each time along another motion, with something changed in between.

An earlier log, from which a robot is identified, and a later one that is compared with it.
"""

from dataclasses import replace

import numpy as np

from tests.plant.cases import World
from tests.plant.controller import steer
from tests.plant.effects.effect import Effect
from tests.plant.excitation import draw_excitation
from tests.plant.robots import Arm, draw_arm
from tests.plant.sensors import record
from veritorque.core.log.model import JointLog

NOISE_SHARE = 0.02
"""Noise RMS over torque RMS."""


def arm_of(name: str, seed: int) -> Arm:
    """Draw the arm."""
    return draw_arm(name, np.random.default_rng([seed, 7]))


def logged(arm: Arm, seed: int, *effects: Effect, noise: str = "white", duration: float = 30.0) -> JointLog:
    """Record it for `duration` s along a motion of its own, drawn from a seed."""
    rng = np.random.default_rng(seed)
    steering = steer(arm, draw_excitation(arm, rng, duration))
    noise_rms = NOISE_SHARE * np.sqrt(np.mean(steering.nominal**2, axis=0))
    world = World(arm, steering, noise, noise_rms, 250.0, seed)
    return record(world.signals(effects), noise_rms, noise, rng)


def with_friction(arm: Arm, joint: int, *, viscous: float, coulomb: float) -> Arm:
    """Change the friction of one joint (from 1) by N m s/rad and N m."""
    levels = arm.viscous.copy(), arm.coulomb.copy()
    for values, change in zip(levels, (viscous, coulomb), strict=True):
        values[joint - 1] += change
    return replace(arm, viscous=levels[0], coulomb=levels[1])


def with_gravity(arm: Arm, turn: np.ndarray) -> Arm:
    """Turn gravity in the base frame, as a tilted base does."""
    return replace(arm, robot=replace(arm.robot, gravity=turn @ arm.robot.gravity))
