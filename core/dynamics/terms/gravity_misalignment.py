"""Give the effect of a tilted base: the bodies' weight along the change of gravity.

Gravity g rotated by a small angle about an axis u changes by u x g, as for a base tilted the other way. Loads
are linear in gravity, so that a column is the weight of the bodies under that vector, at rest. Source: Khalil
& Dombre (2002), ch. 9.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import JointSeries, Vector3
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import AllJointsTerm, without_rounding


@dataclass(frozen=True, eq=False)
class Tilt(AllJointsTerm):
    """Model gravity rotated by `tilt_x` and `tilt_y` about the base's axes."""

    believed: Prediction
    symbols = (("tilt_x", "rad", None), ("tilt_y", "rad", None))
    kind = "gravity_misalignment"
    loads = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the weight per rad about either axis."""
        rest = at_rest(state)
        gravity = np.asarray(robot.gravity, dtype=float)
        return without_rounding(
            [
                self.believed.load(rest, replace(robot, gravity=np.cross(axis, gravity)))
                for axis in tilt_axes(gravity)
            ]
        )


def tilt_axes(gravity: Vector3) -> tuple[Vector3, Vector3]:
    """Give the base's x and y axes; z in place of one that is within 30 degrees of upright.

    Examples
    --------
    >>> tilt_axes(np.array([9.81, 0.0, 0.0]))
    (array([0., 0., 1.]), array([0., 1., 0.]))
    """
    upright = np.abs(gravity) > np.cos(np.pi / 6.0) * np.linalg.norm(gravity)
    x, y, z = np.eye(3)
    return (z if upright[0] else x), (z if upright[1] else y)


def at_rest(state: MotionState) -> MotionState:
    """Keep the postures and stop the motion."""
    still = np.zeros_like(state.velocity)
    return replace(state, velocity=still, acceleration=still)
