"""Give what a tilted base adds: the bodies' weight along the directions into which gravity turns.

A base that is turned by a small angle about a horizontal axis u sees gravity g turned the other way, by
-u x g. Loads are linear in gravity, so that a column is the weight of the bodies under that vector, at rest.
Source: Khalil & Dombre (2002), ch. 9.
"""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from core.arrays import JointSeries, Vector3
from core.dynamics.prediction import Prediction
from core.dynamics.terms.effect import AllJointsTerm, Symbol
from core.robot.model import RobotModel
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Tilt(AllJointsTerm):
    """Model a base turned by `tilt_x` and `tilt_y` about its horizontal axes."""

    believed: Prediction
    symbols: ClassVar[tuple[Symbol, ...]] = (("tilt_x", "rad", None), ("tilt_y", "rad", None))
    kind: ClassVar[str] = "gravity_misalignment"

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the weight per rad about either axis."""
        rest = at_rest(state)
        gravity = np.asarray(robot.gravity, dtype=float)
        return [
            self.believed.load(rest, replace(robot, gravity=-np.cross(axis, gravity)))
            for axis in horizontal_axes(gravity)
        ]


def horizontal_axes(gravity: Vector3) -> tuple[Vector3, Vector3]:
    """Give the base's level unit axes: x made level (y where x is nearly upright), and up times it.

    Examples
    --------
    >>> horizontal_axes(np.array([0.0, 0.0, -9.81]))
    (array([1., 0., 0.]), array([0., 1., 0.]))
    """
    up = -gravity / max(float(np.linalg.norm(gravity)), 1e-12)
    first = np.eye(3)[int(abs(up[0]) > abs(up[1]) and abs(up[0]) > 0.5)]
    level = first - (first @ up) * up
    level /= np.linalg.norm(level)
    return level + 0.0, np.cross(up, level) + 0.0


def at_rest(state: MotionState) -> MotionState:
    """Keep the postures and stop the motion."""
    still = np.zeros_like(state.velocity)
    return replace(state, velocity=still, acceleration=still)
