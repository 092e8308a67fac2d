"""Make operating points whose effects pinocchio can compute exactly."""

import numpy as np

from tests.tools import Motion, pinocchio_torque, random_bodies, random_motion, random_robot
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.state import MotionState

JOINTS = 4


def described_chain(seed: int) -> tuple[Prediction, np.ndarray]:
    """Believe in the bodies of a chain of turning joints, and in nothing else."""
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, JOINTS, prismatic=0.0)
    bodies = random_bodies(rng, JOINTS)
    return Prediction(standard_model(robot, ("rigid_body",)), bodies.ravel()), bodies


def motion_of(seed: int, samples: int = 6, joints: int = JOINTS) -> MotionState:
    """Draw states of the chain."""
    motion = random_motion(np.random.default_rng(seed), joints, samples)
    return MotionState(motion.position, motion.velocity, motion.acceleration)


def exact(robot: RobotModel, bodies: np.ndarray, state: MotionState) -> np.ndarray:
    """Ask pinocchio for the torque, N m."""
    return pinocchio_torque(robot, bodies, Motion(state.position, state.velocity, state.acceleration))


def one_viscous_joint() -> Prediction:
    """Believe in a single joint with a friction of 1 N m s/rad and no mass."""
    robot = random_robot(np.random.default_rng(0), 1, prismatic=0.0)
    model: DynamicModel = standard_model(robot, ("viscous",))
    return Prediction(model, np.ones(1))
