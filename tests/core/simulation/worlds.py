"""Make mechanisms with chosen drives, and play them with a torque that is constant or given."""

from collections.abc import Callable

import numpy as np

from veritorque.core.dynamics.model import standard_model
from veritorque.core.robot.model import Joint, Link, RobotModel
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.drive import Drive
from veritorque.core.simulation.mechanism import Mechanism, mechanism_of
from veritorque.core.simulation.rollout import Trajectory, rollout
from veritorque.core.simulation.stage import States


def mechanism(robot: RobotModel, bodies: np.ndarray, **drives: float) -> Mechanism:
    """Give a robot's standard model bodies, and all joints the same drive (IA, FV, FC, OFF, FCM ...)."""
    model = standard_model(robot)
    values = np.array([drives.get(parameter.symbol, 0.0) for parameter in model.parameters])
    values[: bodies.size] = bodies.ravel()
    return mechanism_of(model, values)


def block(**drives: float) -> Mechanism:
    """Put a body of 2 kg on a level straight guide."""
    return mechanism(_single("prismatic", np.zeros(3)), np.array([[0.0] * 9 + [2.0]]), **drives)


def slope(**drives: float) -> Mechanism:
    """Put a body of 2 kg on a guide that gravity pulls along with 1 m/s2: 2 N."""
    return mechanism(_single("prismatic", np.array([0.0, 0.0, 1.0])), np.array([[0.0] * 9 + [2.0]]), **drives)


def pendulum(**drives: float) -> Mechanism:
    """Hang a point mass of 1 kg at 1 m from a horizontal axis; zero is straight down."""
    body = np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0]])
    return mechanism(_single("revolute", np.array([9.81, 0.0, 0.0])), body, **drives)


def _single(kind: str, gravity: np.ndarray) -> RobotModel:
    link = Link("link", kind, 0, 1, np.eye(3), np.zeros(3))
    return RobotModel("single", (link,), (Joint("joint"),), gravity)


def play(
    mechanism: Mechanism,
    position: np.ndarray,
    velocity: np.ndarray,
    seconds: float,
    steps: int,
    torque: Callable[[float], np.ndarray] | None = None,
) -> Trajectory:
    """Play one or more states (rows) with steps of one length; torque per joint is given over time (s)."""
    position, velocity = np.atleast_2d(position), np.atleast_2d(velocity)
    start = States.starting(mechanism, MotionState(position, velocity, np.zeros_like(position)))
    times = np.linspace(0.0, seconds, steps + 1)
    rows = np.array([np.zeros(mechanism.joints) if torque is None else torque(time) for time in times])
    driven = np.repeat(rows[:, :, None], len(position), axis=2)
    return rollout(mechanism, start, Drive(seconds / steps, driven), longest_step=1.0)
