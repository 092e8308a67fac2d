"""Give what a joint's gear transmits: what moves the link, without what turns with the motor before it.

A model whose base parameters hold a rotor's inertia in the link's predicts too much load, by that inertia
times the acceleration, and too heavy a link. Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import JointSeries, Samples
from ..robot.model import RobotModel
from ..signals.state import MotionState
from .prediction import Prediction


@dataclass(frozen=True)
class Gear:
    """Predict what goes through one joint's gear.

    Attributes
    ----------
    joint
        Counted from 1.
    motor_inertia
        What the believed load holds of the rotor's inertia, kg m2 (kg).
    """

    believed: Prediction
    joint: int
    motor_inertia: float = 0.0

    def load(self, state: MotionState, robot: RobotModel | None = None) -> Samples:
        """Give the torque that it transmits, N m (N); on another robot than the believed one if given."""
        own = self.joint - 1
        transmitted = self.believed.transmitted(state, robot)[:, own]
        return np.asarray(transmitted - self.motor_inertia * state.acceleration[:, own])

    def inertia(self, state: MotionState) -> Samples:
        """Give the inertia that it moves while the other joints stand still, kg m2 (kg)."""
        own = self.joint - 1
        return self.believed.slopes(state, own)[2][:, own] - self.motor_inertia

    def change(self, state: MotionState, shift: MotionState) -> JointSeries:
        """Give how all joints' loads change, to first order, when the link's motion is not the motor's.

        Parameters
        ----------
        shift
            What to add to the link's position, velocity and acceleration, one column each.
        """
        own = self.joint - 1
        change = self.believed.change(state, own, shift)
        change[:, own] -= self.motor_inertia * shift.acceleration[:, 0]
        return change
