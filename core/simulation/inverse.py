"""Compute the torque that moves the links, compiled, with the signature of the plain recursion.

Whoever asks for inverse dynamics many times may be handed this in its place; a law holds the two equal.
Source: Featherstone 2008, ch. 5.
"""

import numpy as np

from ..arrays import JointSeries, LinkTable
from ..robot.model import RobotModel
from ..signals.state import MotionState

Bodies = tuple[np.ndarray, ...]
"""What the kernels need of a robot, in the order of `kernel.ROBOT`."""


def inverse_dynamics(robot: RobotModel, links: LinkTable, state: MotionState) -> JointSeries:
    """Give the torque (N m or N) that moves the links, as `core.dynamics.newton_euler` does.

    Parameters
    ----------
    links
        Ten inertial parameters per link about its frame's origin (kg m2, kg m, kg).
    """
    from . import forward  # compiled

    motion = (columns(series) for series in (state.position, state.velocity, state.acceleration))
    return np.ascontiguousarray(forward.torques(bodies_of(robot, links), *motion).T)


def bodies_of(robot: RobotModel, links: LinkTable) -> Bodies:
    """Give a robot and its links' parameters as the kernels need them; masses of whole subtrees come last."""
    table = np.array(links, dtype=float)
    masses = table[:, 9].copy()
    for number in range(len(robot.links), 0, -1):
        if robot.links[number - 1].antecedent:
            masses[robot.links[number - 1].antecedent - 1] += masses[number - 1]
    return (*robot.link_arrays, np.array(robot.gravity, dtype=float), table, masses)


def columns(series: JointSeries) -> np.ndarray:
    """Turn (samples, joints) into the kernels' (joints, samples)."""
    return np.ascontiguousarray(series.T, dtype=float)
