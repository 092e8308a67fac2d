"""Make small worlds whose truth is known: robots, motions, logs and the equations that they give.

Motions are sums of sines, so that velocity and acceleration are exact; torque is the model's own, which other
tests hold against engines that are not ours.
"""

from dataclasses import dataclass

import numpy as np

from tests.tools import random_bodies, random_motion
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.estimate.constraints import Prior, default_prior
from veritorque.core.estimate.system import System, weighted
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import BaseModel, base_model
from veritorque.core.regressor.columns import ColumnPlan, dense
from veritorque.core.regressor.factor import Factor
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.state import MotionState

FRICTION = {"IA": 0.05, "FV": 0.6, "FC": 0.8, "OFF": 0.2, "IAM": 0.04, "FVM": 0.5, "FCM": 0.7}


def planar_robot(**more: object) -> RobotModel:
    """Give two links of 0.4 m that move in a vertical plane: 13 base parameters, all known in closed form."""
    row = {"type": "revolute", "alpha": 0.0, "r": 0.0, "theta_offset": 0.0}
    joints = [{**row, "d": 0.0}, {**row, "d": 0.4}]
    return robot_from_description({"name": "planar", "gravity": [0.0, -9.81, 0.0], "joints": joints} | more)


def wrist_robot() -> RobotModel:
    """Give a three-link arm whose third motor turns with the sum of joints 2 and 3."""
    row = {"type": "revolute", "r": 0.0, "theta_offset": 0.0}
    joints = [
        {**row, "alpha": 0.0, "d": 0.0},
        {**row, "alpha": -np.pi / 2, "d": 0.1},
        {**row, "alpha": np.pi / 2, "d": 0.3, "rotor_inertia": False},
    ]
    coupling = {"name": "wrist", "joints": [2, 3], "weights": [1.0, 1.0], "number": 3}
    return robot_from_description({"name": "wrist", "joints": joints, "couplings": [coupling]})


def true_parameters(model: DynamicModel, seed: int = 0, mass: float = 2.0) -> np.ndarray:
    """Give standard parameters of a physically consistent robot."""
    bodies = random_bodies(np.random.default_rng(seed), len(model.robot.links), mass=mass)
    symbols = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
    return np.array(
        [
            bodies[one.number - 1, symbols.index(one.symbol)]
            if one.symbol in symbols
            else FRICTION[one.symbol] * (1.0 + 0.1 * one.number)
            for one in model.parameters
        ]
    )


def swing(joints: int, *, seed: int = 1, seconds: float = 20.0, rate_hz: float = 100.0) -> MotionState:
    """Swing every joint by five sines below 1.3 Hz, without drift."""
    rng = np.random.default_rng(seed)
    time = np.arange(int(seconds * rate_hz)) / rate_hz
    angular = 2.0 * np.pi * rng.uniform(0.1, 1.3, (5, joints))
    size = rng.uniform(0.2, 0.6, (5, joints)) / np.sqrt(angular)
    angle = time[:, None, None] * angular + rng.uniform(0.0, 2.0 * np.pi, (5, joints))
    return MotionState(
        (size * np.sin(angle)).sum(axis=1),
        (size * angular * np.cos(angle)).sum(axis=1),
        (-size * angular**2 * np.sin(angle)).sum(axis=1),
    )


def log_of(
    model: DynamicModel, standard: np.ndarray, state: MotionState, noise: np.ndarray | float = 0.0
) -> JointLog:
    """Record a motion at 100 Hz with its torque and noise on it (N m)."""
    time = np.arange(len(state.position)) / 100.0
    return log_from_arrays("swing", time, state.position, model.torque(standard, state) + noise)


@dataclass(frozen=True, eq=False)
class World:
    """Hold a robot's model, the truth, and weighted equations of a random motion."""

    model: DynamicModel
    base: BaseModel
    truth: np.ndarray
    factors: tuple[Factor, ...]
    columns_of: tuple[np.ndarray, ...]
    system: System
    prior: Prior

    @property
    def true_base(self) -> np.ndarray:
        """Give the true base parameters."""
        return self.base.base_of(self.truth)


def world_of(
    robot: RobotModel,
    *,
    seed: int = 0,
    samples: int = 200,
    noise: tuple[float, ...] | float = 0.1,
    truth: np.ndarray | None = None,
) -> World:
    """Write the equations of random states with white torque noise of the given deviation per joint (N m)."""
    rng = np.random.default_rng(seed)
    model = standard_model(robot)
    base = base_model(model)
    truth = true_parameters(model, seed) if truth is None else truth
    motion = random_motion(rng, len(robot.joints), samples, speed=2.0)
    state = MotionState(motion.position, motion.velocity, motion.acceleration)
    torque = model.torque(truth, state) + noise * rng.normal(size=state.position.shape)
    factors, columns_of = joint_factors(base, state, torque)
    system = weighted(factors, columns_of, len(base.kept))
    scales = np.sqrt(np.mean(torque**2, axis=0))
    return World(model, base, truth, factors, columns_of, system, default_prior(model, scales))


def joint_factors(
    base: BaseModel, state: MotionState, torque: np.ndarray
) -> tuple[tuple[Factor, ...], tuple[np.ndarray, ...]]:
    """Condense the equations joint by joint."""
    plan = ColumnPlan(base.model, base.kept)
    joints = torque.shape[1]
    whole = dense(plan, state).reshape(len(torque), joints, -1)
    factors = tuple(
        Factor.of(np.column_stack([whole[:, joint][:, plan.columns_of[joint]], torque[:, joint]]))
        for joint in range(joints)
    )
    return factors, plan.columns_of
