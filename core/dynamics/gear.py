"""Compute the torque that a joint's transmission carries: the link's, without the motor side.

A model whose base parameters contain a rotor's inertia in the link's predicts too much load, by that inertia
times the acceleration, and too heavy a link. Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import JointSeries, Samples
from ..robot.model import RobotModel
from ..signals.derivative import REACH, differentiate_throughout
from ..signals.state import MotionState
from .prediction import Prediction
from .terms.effect import step_of


@dataclass(frozen=True)
class Gear:
    """Predict the torque through one joint's transmission."""

    believed: Prediction
    joint: int
    """Counted from 1."""
    motor_inertia: float = 0.0
    """Rotor inertia that the operating point's load contains, kg m2 (kg)."""

    def load(self, state: MotionState, robot: RobotModel | None = None) -> Samples:
        """Give the transmitted torque, N m (N), on the operating point's robot or another one."""
        own = self.joint - 1
        transmitted = self.believed.transmitted(state, robot)[:, own]
        return np.asarray(transmitted - self.motor_inertia * state.acceleration[:, own])

    def inertia(self, state: MotionState) -> Samples:
        """Give the moved inertia while the other joints rest, kg m2 (kg)."""
        own = self.joint - 1
        return self.believed.slopes(state, own)[2][:, own] - self.motor_inertia

    def slopes(self, state: MotionState) -> tuple[Samples, Samples]:
        """Give the load's derivatives by the joint's own position and velocity."""
        own = self.joint - 1
        by_position, by_velocity, _ = self.believed.slopes(state, own)
        return by_position[:, own], by_velocity[:, own]

    def displaced(self, state: MotionState, lag: Samples) -> JointSeries:
        """Give the first-order change of all joints' loads where the link lies off the motor by a series."""
        own, change = self.joint - 1, np.zeros(state.position.shape[::-1])
        speed = _rate(lag, state)
        bend = _rate(speed, state)
        self.believed.add_change(state, own, (lag, speed, bend), change)
        change[own] -= self.motor_inertia * bend
        return change.T


def _rate(series: Samples, state: MotionState) -> Samples:
    """Differentiate a series as positions are."""
    from ..numerics.elementwise import differentiate_series  # compiled

    rate_hz, out = 1.0 / step_of(state), np.empty_like(series)
    if len(series) <= REACH:
        return differentiate_throughout(series[:, None], rate_hz)[:, 0]
    differentiate_series(series, rate_hz, out)
    return out
