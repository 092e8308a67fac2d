"""Compute the geometric Jacobian of a link's frame.

By virtual work its transpose maps a wrench on the link to joint torques. Source: Khalil & Dombre
(2002), ch. 5.
"""

import numpy as np

from ..arrays import Jacobian, JointSeries
from ..robot.model import Link, RobotModel


def jacobian(robot: RobotModel, link: int, position: JointSeries) -> Jacobian:
    """Give linear (m/s, first three rows) and angular velocity (rad/s) of a link per unit of joint speed.

    Parameters
    ----------
    link
        Number of the link, from 1.

    Returns
    -------
    Jacobian
        In the axes of the base.
    """
    samples = len(position)
    rotation, point = np.tile(np.eye(3), (samples, 1, 1)), np.zeros((samples, 3))
    chain = [robot.links[index] for index in robot.supports[link - 1]]
    axes, points = [], []
    for carrier in chain:
        point = point + rotation @ carrier.translation
        rotation = rotation @ carrier.rotation
        coordinate = carrier.ratio * position[:, carrier.joint - 1] + carrier.offset
        if carrier.kind == "prismatic":
            point = point + coordinate[:, None] * rotation[:, :, 2]
        axes.append(rotation[:, :, 2])
        points.append(point)
        if carrier.kind == "revolute":
            rotation = rotation @ _rotations(coordinate)
    out = np.zeros((samples, 6, position.shape[1]))
    for carrier, axis, origin in zip(chain, axes, points, strict=True):
        out[:, :, carrier.joint - 1] += carrier.ratio * _column(carrier, axis, point - origin)
    return out


def _column(link: Link, axis: np.ndarray, lever: np.ndarray) -> np.ndarray:
    if link.kind == "prismatic":
        return np.hstack([axis, np.zeros_like(axis)])
    return np.hstack([np.cross(axis, lever), axis])


def _rotations(angle: np.ndarray) -> np.ndarray:
    turn = np.zeros((len(angle), 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 1, 0] = np.sin(angle)
    turn[:, 0, 1] = -turn[:, 1, 0]
    turn[:, 2, 2] = 1.0
    return turn
