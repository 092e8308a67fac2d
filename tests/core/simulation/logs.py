"""Make logs whose torque pinocchio has computed, with known noise."""

from collections.abc import Callable

import numpy as np

from tests.tools import Motion as Samples
from tests.tools import pinocchio_torque
from veritorque.core.log.model import ArraySource, JointLog, LogRows
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.condition import Motion, condition
from veritorque.core.signals.state import MotionState

RATE_HZ = 500.0


def logged(
    robot: RobotModel,
    bodies: np.ndarray,
    *,
    seconds: float = 8.0,
    noise: float = 0.0,
    more: Callable[[MotionState], np.ndarray] | None = None,
) -> Motion:
    """Move every joint by sines of about 1 Hz; friction 1 N m sign(v) is added to pinocchio's torque.

    `noise` is that of the torque, N m; `more` is torque that a motion takes besides.
    """
    rng = np.random.default_rng(4)
    time = np.arange(0.0, seconds, 1.0 / RATE_HZ)
    joints = len(robot.joints)
    rate, phase = rng.uniform(3.0, 8.0, (2, joints)), rng.uniform(0.0, 6.0, (2, joints))
    angle = time[:, None, None] * rate + phase
    motion = Samples(
        0.2 * np.sin(angle).sum(axis=1),
        0.2 * (rate * np.cos(angle)).sum(axis=1),
        -0.2 * (rate**2 * np.sin(angle)).sum(axis=1),
    )
    torque = pinocchio_torque(robot, bodies, motion) + np.sign(motion.velocity)
    torque += noise * rng.normal(size=torque.shape)
    if more is not None:
        torque += more(MotionState(motion.position, motion.velocity, motion.acceleration, time))
    rows = LogRows(time, motion.position, torque)
    log = JointLog("made", ArraySource(rows), joints, RATE_HZ, seconds, ((0, len(time)),))
    return condition(log, robot, blocks=8)
