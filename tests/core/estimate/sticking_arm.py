"""Draw noisy logs of arms that stick at their reversals, and measure estimates on motions that were not seen.

The arms move in an engine that is not ours. Noise of encoders and torques is added to what it recorded: it
does not go round the robot's own loop.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from tests.plant.cases import World, draw_world
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan, dense
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, identify_in_full

SEED, STATES, SECONDS, RATE_HZ = 708, 2000, 10.0, 1000.0
QUIET = 0.02
"""Share of the usual noise of torques, so that other errors are the largest."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Hold an arm, its true base parameters, and columns of motions that are in no log."""

    world: World
    model: DynamicModel
    standard: np.ndarray
    """The true standard parameters."""
    true: np.ndarray
    unseen: np.ndarray

    def log(self, encoder_deg: float, torque_share: float, seed: int) -> JointLog:
        """Draw a log: white noise of the encoders, and a share of the plant's usual noise of the torques."""
        signals, rng = self.world.signals(()), np.random.default_rng(seed)
        position = signals.position + np.deg2rad(encoder_deg) * rng.normal(size=signals.position.shape)
        torque = signals.torque + torque_share * self.world.noise_rms * rng.normal(size=signals.torque.shape)
        return log_from_arrays("noisy", signals.time, position, torque)

    def estimated(self, log: JointLog, estimator: str, options: Mapping[str, object]) -> np.ndarray:
        """Fit the base parameters."""
        asked = {"estimator": estimator, "bootstrap": {"draws": 0}, **options}
        return identify_in_full(IdentifyRequest(self.world.arm.robot, (log,), asked)).estimate.base

    def error(self, base: np.ndarray) -> float:
        """Give the error of the torque of the unseen motions, % of its RMS, all joints alike."""
        missed, whole = (
            np.reshape(self.unseen @ part, (STATES, -1)) for part in (base - self.true, self.true)
        )
        return float(100.0 * np.sqrt(np.mean((missed / np.sqrt(np.mean(whole**2, axis=0))) ** 2)))


@cache
def scene(robot: str) -> Scene:
    """Draw an arm with its motion, and speeds and accelerations of the motion's size at other positions."""
    rng = np.random.default_rng([SEED, 0])
    world = draw_world(rng, SEED, robot=robot, noise="white", duration=SECONDS, rate_hz=RATE_HZ)
    model = standard_model(world.arm.robot)
    base = base_model(model)
    standard = _truth(world, [parameter.name for parameter in model.parameters])
    true = base.base_of(standard)
    signals = world.signals(())
    velocity = np.gradient(signals.position, signals.time, axis=0)
    acceleration = np.gradient(velocity, signals.time, axis=0)
    drawn = np.random.default_rng(SEED).normal(size=(3, STATES, velocity.shape[1]))
    state = MotionState(drawn[0], drawn[1] * velocity.std(axis=0), drawn[2] * acceleration.std(axis=0))
    return Scene(world, model, standard, true, dense(ColumnPlan(model, base.kept), state))


def _truth(world: World, names: list[str]) -> np.ndarray:
    """Give the standard parameters of those names: bodies in the order of the links, drives by name."""
    arm = world.arm
    parts = (("IA", arm.rotor_inertia), ("FV", arm.viscous), ("FC", arm.coulomb), ("OFF", arm.offset))
    drives = {f"{symbol}{joint + 1}": part[joint] for symbol, part in parts for joint in range(len(part))}
    bodies = iter(arm.bodies.ravel())
    return np.array([float(drives[name]) if name in drives else float(next(bodies)) for name in names])
