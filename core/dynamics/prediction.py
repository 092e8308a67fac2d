"""Freeze a model with its parameters, so that an effect can be written in terms of what is predicted.

Friction that grows with the load, a compliant gear or a late torque channel change the torque in proportion
to the torque itself. The measured one would bring its own noise into the columns and bias them; so these
effects are built on the torque that a believed model predicts. Source: Ljung, System Identification (1999),
ch. 7, on endogenous regressors.
"""

from dataclasses import dataclass, field, replace
from weakref import WeakKeyDictionary

import numpy as np

from core.arrays import JointSeries, Parameters
from core.dynamics.model import DynamicModel, term_torque
from core.dynamics.newton_euler import inverse_dynamics
from core.dynamics.terms.rigid_body import RigidBody
from core.robot.model import RobotModel
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Prediction:
    """Predict torque from a model whose parameters are settled.

    Attributes
    ----------
    standard
        One value per parameter of the model.
    """

    model: DynamicModel
    standard: Parameters
    _loads: WeakKeyDictionary[MotionState, JointSeries] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )
    """Loads of states asked for before: several effects on one joint ask for the same."""

    def torque(self, state: MotionState) -> JointSeries:
        """Give the torque of all terms, N m or N."""
        return self.model.torque(self.standard, state)

    def load(self, state: MotionState, robot: RobotModel | None = None) -> JointSeries:
        """Give the torque that moves the links, N m or N: what the gears transmit.

        Parameters
        ----------
        robot
            The robot to move the same bodies on, where it is not the believed one.
        """
        if robot is not None and robot is not self.model.robot:
            return self._moved_bodies(robot, state)
        if state not in self._loads:
            self._loads[state] = self._moved_bodies(self.model.robot, state)
        return self._loads[state]

    def friction(self, state: MotionState) -> JointSeries:
        """Give the torque of all terms but moving masses, N m or N."""
        start, torque = 0, np.zeros_like(state.position, dtype=float)
        for term in self.model.terms:
            stop = start + len(term.parameters(self.model.robot))
            if not isinstance(term, RigidBody) and term.name != "rotor_inertia":
                torque += term_torque(term, self.model.robot, self.standard[start:stop], state)
            start = stop
        return torque

    def shifted(self, state: MotionState, joint: int, shift: MotionState) -> JointSeries:
        """Give how the load changes when one joint's position (from 0) is not the measured one.

        Parameters
        ----------
        shift
            What to add to that joint's position, velocity and acceleration, one column each.
        """
        return np.asarray(self.load(moved(state, joint, shift)) - self.load(state))

    def _moved_bodies(self, robot: RobotModel, state: MotionState) -> JointSeries:
        bodies = self._bodies
        if bodies is None:
            return np.zeros_like(state.position, dtype=float)
        return inverse_dynamics(robot, bodies, state)

    @property
    def _bodies(self) -> np.ndarray | None:
        start = 0
        for term in self.model.terms:
            stop = start + len(term.parameters(self.model.robot))
            if isinstance(term, RigidBody):
                return self.standard[start:stop].reshape(-1, 10)
            start = stop
        return None


def moved(state: MotionState, joint: int, shift: MotionState) -> MotionState:
    """Add a shift (one column) to the motion of one joint, counted from 0."""
    position, velocity, acceleration = (
        series.copy() for series in (state.position, state.velocity, state.acceleration)
    )
    position[:, joint] += shift.position[:, 0]
    velocity[:, joint] += shift.velocity[:, 0]
    acceleration[:, joint] += shift.acceleration[:, 0]
    return replace(state, position=position, velocity=velocity, acceleration=acceleration)
