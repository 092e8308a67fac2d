"""Hold a model with its parameters: the operating point at which effects are linearised.

Load-dependent friction, joint elasticity or a delayed torque channel change the torque in proportion to the
torque itself. The measured torque would bring its noise into the columns and bias the estimates, so columns
are functions of the torque that the operating point predicts. Source: Ljung, System Identification (1999),
ch. 7, on endogenous regressors.
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from ..arrays import JointSeries, LinkTable, Parameters, Samples, Series, Weights
from ..robot.model import RobotModel
from ..signals.state import MotionState
from .model import DynamicModel, term_torque
from .newton_euler import inverse_dynamics
from .term import Term
from .terms.rigid_body import RigidBody

STEPS = (1e-5, 1.0, 1.0)
"""Steps of the differences by position, velocity and acceleration, rad (m), per s, per s2."""
Shift = tuple[Samples, Samples, Samples]
"""What is added to position, velocity and acceleration of one joint: contiguous."""
Slopes = tuple[JointSeries, JointSeries, JointSeries]
"""Derivatives of the load by position, velocity and acceleration of one joint."""
InverseDynamics = Callable[[RobotModel, LinkTable, MotionState], JointSeries]
"""Give the torque that moves links of given inertial parameters, N m or N."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """Predict torque from a model with fixed parameters.

    A series that several effects use is computed once per state; such series are read-only.
    """

    model: DynamicModel
    standard: Parameters
    """One value per parameter of the model."""
    newton_euler: InverseDynamics = inverse_dynamics
    """Inverse dynamics of the links: the plain recursion unless a faster one is passed."""
    joined: tuple[tuple[Term, Weights], ...] = ()
    """Terms added to the model, with their parameters. Transmissions carry those that act on the links, a
    torque channel scales and delays all of them."""
    _loads: WeakKeyDictionary[MotionState, JointSeries] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )
    _torques: WeakKeyDictionary[MotionState, JointSeries] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )
    _sums: WeakKeyDictionary[MotionState, dict[str, JointSeries]] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )
    _slopes: WeakKeyDictionary[MotionState, dict[int, Slopes]] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )

    def joined_by(self, terms: Iterable[tuple[Term, Weights]]) -> "Prediction":
        """Join further terms to the model; what is computed of the model alone is then shared."""
        more = replace(self, joined=(*self.joined, *terms))
        for shared in ("_loads", "_torques", "_slopes"):
            object.__setattr__(more, shared, getattr(self, shared))  # no other copy may share them
        return more

    def torque(self, state: MotionState) -> JointSeries:
        """Give the torque of all the model's terms, N m or N."""
        if state not in self._torques:
            others = (part for part in self._parts if not isinstance(part[0], RigidBody))
            self._torques[state] = _contiguous(self.load(state) + self._sum(others, state))
        return self._torques[state]

    def transmitted(self, state: MotionState, robot: RobotModel | None = None) -> JointSeries:
        """Give the torque that transmissions carry, N m or N: the load, and added terms on the links.

        Parameters
        ----------
        robot
            The robot that moves the model's bodies, where it is not the model's.
        """
        joined = self._joined("loads", state, [part for part in self.joined if part[0].loads])
        return np.asarray(self.load(state, robot) + joined)

    def applied(self, state: MotionState) -> JointSeries:
        """Give the torque of the model and of added terms in the robot, N m or N, before its channels."""
        joined = self._joined("robot", state, [part for part in self.joined if not part[0].channel])
        return np.asarray(self.torque(state) + joined)

    def scaled(self, state: MotionState) -> JointSeries:
        """Give the torque with the channel errors, N m or N: what may be delayed."""
        return np.asarray(self.torque(state) + self._joined("all", state, self.joined))

    def load(self, state: MotionState, robot: RobotModel | None = None) -> JointSeries:
        """Give the torque that moves the model's links, N m or N.

        Parameters
        ----------
        robot
            The robot that moves the same bodies, where it is not the model's.
        """
        if robot is not None and robot is not self.model.robot:
            return self._moved_bodies(robot, state)
        if state not in self._loads:
            self._loads[state] = _contiguous(self._moved_bodies(self.model.robot, state))
        return self._loads[state]

    def rotor(self, joint: int) -> float:
        """Give the inertia of a joint's rotor (joint from 1); zero where it is part of the link's."""
        return self._sum_of("IA", joint)

    def viscous(self, joint: int) -> float:
        """Give the viscous friction of a joint (from 1)."""
        return self._sum_of("FV", joint)

    def coulomb(self, joint: int) -> float:
        """Give the Coulomb friction of a joint (from 1)."""
        return self._sum_of("FC", joint)

    def friction(self, state: MotionState) -> JointSeries:
        """Give the torque of all terms but moving masses, N m or N."""
        light = (
            part
            for part in self._parts
            if not isinstance(part[0], RigidBody) and part[0].name != "rotor_inertia"
        )
        return self._sum(light, state)

    def add_change(self, state: MotionState, joint: int, shift: Shift, change: Series) -> None:
        """Add the first-order change of the load where one joint's motion differs from the measured one.

        Parameters
        ----------
        joint
            Counted from 0.
        shift
            Difference of that joint's position, velocity and acceleration.
        change
            Joints x samples, to which it is added.
        """
        from ..numerics.elementwise import add_products  # compiled

        by_position, by_velocity, by_acceleration = (table.T for table in self.slopes(state, joint))
        add_products((by_position, by_velocity, by_acceleration), shift, change)

    def slopes(self, state: MotionState, joint: int) -> Slopes:
        """Give the load's derivatives by position, velocity and acceleration of a joint, counted from 0.

        Notes
        -----
        Loads are quadratic in velocity and linear in acceleration: their central differences are exact for
        any step. The error of that by position is the step squared, and rounding over the step: both are
        1e-11.
        """
        known = self._slopes.setdefault(state, {})
        if joint not in known:
            known[joint] = (
                self._slope(state, joint, (STEPS[0], 0.0, 0.0)),
                self._slope(state, joint, (0.0, STEPS[1], 0.0)),
                self._slope(state, joint, (0.0, 0.0, STEPS[2])),
            )
        return known[joint]

    def _sum_of(self, symbol: str, joint: int) -> float:
        return math.fsum(
            value
            for parameter, value in zip(self.model.parameters, self.standard, strict=True)
            if parameter.symbol == symbol and parameter.joint == joint
        )

    def _joined(self, which: str, state: MotionState, parts: Iterable[tuple[Term, Weights]]) -> JointSeries:
        known = self._sums.setdefault(state, {})
        if which not in known:
            known[which] = _contiguous(self._sum(parts, state))
        return known[which]

    def _moved_bodies(self, robot: RobotModel, state: MotionState) -> JointSeries:
        torque = np.zeros_like(state.position, dtype=float)
        for term, values in self._parts:
            if isinstance(term, RigidBody):
                torque += self.newton_euler(robot, values.reshape(-1, 10), state)
        return torque

    def _slope(self, state: MotionState, joint: int, step: tuple[float, float, float]) -> JointSeries:
        """Give the central difference of the load over a step of one joint's motion."""
        ones = np.ones((len(state.position), 1))
        ahead, behind = (
            self._moved_bodies(
                self.model.robot,
                shift_joint(state, joint, MotionState(*(side * size * ones for size in step))),
            )
            for side in (1.0, -1.0)
        )
        # Joint after joint in memory, because the factor is one column.
        return _contiguous(np.asfortranarray((ahead - behind) / (2.0 * sum(step))))

    def _sum(self, parts: Iterable[tuple[Term, Weights]], state: MotionState) -> JointSeries:
        torque = np.zeros_like(state.position, dtype=float)
        for term, values in parts:
            torque += term_torque(term, self.model.robot, values, state)
        return torque

    @cached_property
    def _parts(self) -> tuple[tuple[Term, Weights], ...]:
        """Give every term its share of the parameters."""
        return self.model.split(self.standard)


def _contiguous(series: JointSeries) -> JointSeries:
    series.setflags(write=False)
    return series


def shift_joint(state: MotionState, joint: int, shift: MotionState) -> MotionState:
    """Add a shift (one column) to the motion of one joint, counted from 0."""
    position, velocity, acceleration = (
        series.copy() for series in (state.position, state.velocity, state.acceleration)
    )
    position[:, joint] += shift.position[:, 0]
    velocity[:, joint] += shift.velocity[:, 0]
    acceleration[:, joint] += shift.acceleration[:, 0]
    stamped = state.stamped_velocity
    if stamped is not None:
        stamped = stamped.copy()
        stamped[:, joint] += shift.velocity
    return replace(
        state, position=position, velocity=velocity, acceleration=acceleration, stamped_velocity=stamped
    )
