"""Freeze a model with its parameters, so that an effect can be written in terms of what is predicted.

Friction that grows with the load, a compliant gear or a late torque channel change the torque in proportion
to the torque itself. The measured one would bring its own noise into the columns and bias them; so these
effects are built on the torque that a believed model predicts. Source: Ljung, System Identification (1999),
ch. 7, on endogenous regressors.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from core.arrays import JointSeries, LinkTable, Parameters
from core.dynamics.model import DynamicModel, term_torque
from core.dynamics.newton_euler import inverse_dynamics
from core.dynamics.term import Term
from core.dynamics.terms.rigid_body import RigidBody
from core.robot.model import RobotModel
from core.signals.state import MotionState

InverseDynamics = Callable[[RobotModel, LinkTable, MotionState], JointSeries]
"""Give the torque that moves links of given inertial parameters, N m or N."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """Predict torque from a model whose parameters are settled.

    What several effects ask for of one state is computed once; such series are read-only.

    Attributes
    ----------
    standard
        One value per parameter of the model.
    newton_euler
        How to compute the torque that moves the links: the plain recursion unless a faster one is handed in.
    """

    model: DynamicModel
    standard: Parameters
    newton_euler: InverseDynamics = inverse_dynamics
    _loads: WeakKeyDictionary[MotionState, JointSeries] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )
    _torques: WeakKeyDictionary[MotionState, JointSeries] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )

    def torque(self, state: MotionState) -> JointSeries:
        """Give the torque of all terms, N m or N."""
        if state not in self._torques:
            others = (part for part in self._parts if not isinstance(part[0], RigidBody))
            self._torques[state] = _kept(self.load(state) + self._sum(others, state))
        return self._torques[state]

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
            self._loads[state] = _kept(self._moved_bodies(self.model.robot, state))
        return self._loads[state]

    def friction(self, state: MotionState) -> JointSeries:
        """Give the torque of all terms but moving masses, N m or N."""
        light = (
            part
            for part in self._parts
            if not isinstance(part[0], RigidBody) and part[0].name != "rotor_inertia"
        )
        return self._sum(light, state)

    def shifted(self, state: MotionState, joint: int, shift: MotionState) -> JointSeries:
        """Give how the load changes when one joint's position (from 0) is not the measured one.

        Parameters
        ----------
        shift
            What to add to that joint's position, velocity and acceleration, one column each.
        """
        return np.asarray(self.load(moved(state, joint, shift)) - self.load(state))

    def _moved_bodies(self, robot: RobotModel, state: MotionState) -> JointSeries:
        torque = np.zeros_like(state.position, dtype=float)
        for term, values in self._parts:
            if isinstance(term, RigidBody):
                torque += self.newton_euler(robot, values.reshape(-1, 10), state)
        return torque

    def _sum(self, parts: Iterable[tuple[Term, Parameters]], state: MotionState) -> JointSeries:
        torque = np.zeros_like(state.position, dtype=float)
        for term, values in parts:
            torque += term_torque(term, self.model.robot, values, state)
        return torque

    @cached_property
    def _parts(self) -> tuple[tuple[Term, Parameters], ...]:
        """Give every term its share of the parameters."""
        counts = [len(term.parameters(self.model.robot)) for term in self.model.terms]
        shares = np.split(np.asarray(self.standard), np.cumsum(counts)[:-1])
        return tuple(zip(self.model.terms, shares, strict=True))


def _kept(series: JointSeries) -> JointSeries:
    series.setflags(write=False)
    return series


def moved(state: MotionState, joint: int, shift: MotionState) -> MotionState:
    """Add a shift (one column) to the motion of one joint, counted from 0."""
    position, velocity, acceleration = (
        series.copy() for series in (state.position, state.velocity, state.acceleration)
    )
    position[:, joint] += shift.position[:, 0]
    velocity[:, joint] += shift.velocity[:, 0]
    acceleration[:, joint] += shift.acceleration[:, 0]
    return replace(state, position=position, velocity=velocity, acceleration=acceleration)
