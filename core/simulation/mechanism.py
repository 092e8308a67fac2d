"""Sort a model's torque terms by how they have to be integrated.

What multiplies acceleration joins the mass matrix, viscous friction is taken implicitly, Coulomb friction is
a set with a level, and every other term is evaluated as it stands at the state of the moment. Two kinds are
no function of that state: what depends on the motion before, and what only the torque channel shows.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import Indices, JointMarks, JointSeries, Parameters, Vector, Weights
from ..dynamics.model import DynamicModel
from ..dynamics.term import Term
from ..dynamics.terms.coulomb import Coulomb
from ..dynamics.terms.coupling import GearCoupling
from ..dynamics.terms.flexible_joints import FlexibleJoints
from ..dynamics.terms.joint_coupling import MissingCoupling
from ..dynamics.terms.offset import Offset
from ..dynamics.terms.rigid_body import RigidBody
from ..dynamics.terms.rotor_inertia import RotorInertia
from ..dynamics.terms.rotor_inertia_missing import MissingRotor
from ..dynamics.terms.viscous import Viscous
from ..errors import OptionError
from ..robot.model import Coupling, RobotModel
from ..signals.state import MotionState
from .bodies import Phases, is_body, phases_of
from .inverse import Bodies, bodies_of, columns

NEGLIGIBLE = 1e-6
"""A friction that lies below zero by less than this, times the largest one or 1 N m (N), is zero within the
tolerance of a programme (1e-7, scaled)."""
HOLDING = 1e9
"""Friction (N m or N) that no drive overcomes."""

Parts = list[tuple[Term, Weights]]


@dataclass(frozen=True, eq=False)
class Share:
    """Hold terms as a model of their own, and their parameters."""

    model: DynamicModel
    parameters: Parameters

    @property
    def names(self) -> tuple[str, ...]:
        """Name the terms."""
        return tuple(term.name for term in self.model.terms)

    def torque(self, state: MotionState) -> JointSeries:
        """Give the torque (N m or N) of these terms alone."""
        return self.model.torque(self.parameters, state)


@dataclass(frozen=True, eq=False)
class Springs:
    """Hold the springs between motors and links."""

    joints: Indices
    """The joints (from 0) that have one."""
    stiffness: Vector
    damping: Vector
    """Per such joint, N m/rad and N m s/rad."""


@dataclass(frozen=True, eq=False)
class Mechanism:
    """Hold a model with numbers, sorted for simulation; build it with `mechanism_of`."""

    model: DynamicModel
    parameters: Parameters
    """The model and its standard parameters."""
    inertia: np.ndarray
    damping: np.ndarray
    """What rotors and couplings add to the mass matrix (kg m2), and viscous friction (N m s/rad), joints x
    joints."""
    offset: np.ndarray
    """Constant torque per joint, N m."""
    weights: np.ndarray
    levels: np.ndarray
    """One row per friction that can hold: the speed it acts on is `weights @ velocity`, its level in N m."""
    frictions: np.ndarray
    """Their numbers among all frictions: the joints' own first, then those of couplings."""
    others: Share
    """All other terms of the state."""
    with_memory: Share
    """Terms whose torque depends on the motion before the instant."""
    channel: Share
    """Terms that are logged as torque and move nothing."""
    springs: Springs | None = None
    """Between motors and links; None where every joint is rigid. Who does not ask for them simulates rigid
    joints."""
    stiffness: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    """Of springs between coordinates, N m/rad, coordinates x coordinates; empty where there is none."""

    @property
    def robot(self) -> RobotModel:
        """Give the robot."""
        return self.model.robot

    @property
    def joints(self) -> int:
        """Count the joints."""
        return len(self.offset)

    @cached_property
    def phases(self) -> Phases:
        """Give the robot's bodies over time, as the kernels need them."""
        return phases_of(self.model, self.parameters)

    @property
    def bodies(self) -> Bodies:
        """Give the robot's bodies before any other joins them."""
        return self.phases.bodies[0]

    def mass_matrices(self, position: JointSeries) -> np.ndarray:
        """Give the mass matrix (kg m2), rotors included, for every row of positions; of `bodies`."""
        from . import forward  # compiled

        return np.asarray(forward.mass_matrices(self.bodies, columns(position)) + self.inertia)

    def holding(self, joints: JointMarks) -> "Mechanism":
        """Give the same with joints that nothing moves: friction holds them against any torque."""
        if not joints.any():
            return self
        rows = np.flatnonzero(joints)
        free = ~np.isin(self.frictions, rows)
        frictions = np.concatenate([rows, self.frictions[free]])
        order = np.argsort(frictions)
        weights = np.vstack([np.eye(self.joints)[rows], self.weights[free]])
        levels = np.concatenate([np.full(len(rows), HOLDING), self.levels[free]])
        return replace(self, frictions=frictions[order], weights=weights[order], levels=levels[order])

    def torque(self, state: MotionState) -> JointSeries:
        """Predict the torque (N m or N) of a motion, as `DynamicModel.torque` does but compiled."""
        from . import forward  # compiled

        moved = state.links
        tables = (columns(series) for series in (moved.position, moved.velocity, moved.acceleration))
        parts = self.model.split(self.parameters)
        links = sum(
            (values.reshape(-1, 10) for term, values in parts if isinstance(term, RigidBody)),
            np.zeros((len(self.robot.links), 10)),
        )
        carried = forward.torques(bodies_of(self.robot, links), *tables)
        rest = [part for part in parts if not isinstance(part[0], RigidBody)]
        return np.asarray(carried.T + share_of(self.robot, rest).torque(state))


def mechanism_of(model: DynamicModel, parameters: Parameters) -> Mechanism:
    """Sort the terms of a model.

    A smoothed Coulomb term is simulated with the sign it stands for: its width covers for errors of a
    measured velocity, which a simulated one does not have.

    Raises
    ------
    OptionError
        If the parameters are not finite, not as many as the model has, or a Coulomb friction is negative.
    """
    if len(parameters) != len(model.parameters) or not np.isfinite(parameters).all():
        raise OptionError(
            "the parameters do not belong to the model",
            evidence={"given": len(parameters), "wanted": len(model.parameters)},
            remedy="give one finite number per standard parameter of the model",
        )
    joints = len(model.robot.joints)
    drives, coupled, others = _sort_terms(model, parameters)
    inertia, damping = np.diag(drives[RotorInertia]), np.diag(drives[Viscous])
    for weights, (rotor, viscous, _) in coupled:
        inertia = inertia + rotor * np.outer(weights, weights)
        damping = damping + viscous * np.outer(weights, weights)
    weights = np.vstack([np.eye(joints), *(weights[None] for weights, _ in coupled)])
    levels = _checked_levels(np.concatenate([drives[Coulomb], [values[2] for _, values in coupled]]))
    _, others = _partition(others, lambda term: term.shapes_motion)
    channel, rest = _partition(others, lambda term: term.channel)
    with_memory, of_state = _partition(rest, lambda term: term.has_memory)
    # Any term may jump where its joint stands: only a model without such terms can leave joints out.
    kept = (levels > 0.0) | (np.arange(len(levels)) < joints) & bool(of_state)
    return Mechanism(
        model=model,
        parameters=parameters,
        inertia=inertia,
        damping=damping,
        offset=drives[Offset],
        weights=weights[kept],
        levels=levels[kept],
        frictions=np.flatnonzero(kept),
        others=share_of(model.robot, of_state),
        with_memory=share_of(model.robot, with_memory),
        channel=share_of(model.robot, channel),
        springs=_springs(model, parameters),
    )


def _springs(model: DynamicModel, parameters: Parameters) -> Springs | None:
    for term, values in model.split(parameters):
        if isinstance(term, FlexibleJoints):
            return Springs(np.array(term.flexible) - 1, values[0::2], values[1::2])
    return None


def _partition(parts: Parts, chosen: Callable[[Term], bool]) -> tuple[Parts, Parts]:
    """Divide weighted terms into those that are chosen and those that are not."""
    return [part for part in parts if chosen(part[0])], [part for part in parts if not chosen(part[0])]


def _sort_terms(
    model: DynamicModel, parameters: Parameters
) -> tuple[dict[type, np.ndarray], list[tuple[np.ndarray, np.ndarray]], Parts]:
    """Sort all terms but bodies: numbers per joint, couplings as weights and three numbers, others."""
    robot = model.robot
    kinds = (RotorInertia, Viscous, Coulomb, Offset)
    drives: dict[type, np.ndarray] = dict(zip(kinds, np.zeros((4, len(robot.joints))), strict=True))
    coupled: list[tuple[np.ndarray, np.ndarray]] = []
    others: Parts = []
    for term, values in model.split(parameters):
        if type(term) in drives:
            drives[type(term)][[joint for joint, _ in term.entries(robot)]] += values
        elif isinstance(term, MissingRotor):
            drives[RotorInertia][term.joint - 1] += values[0]
        elif isinstance(term, GearCoupling):
            coupled += _couplings(robot.couplings, values, len(robot.joints))
        elif isinstance(term, MissingCoupling):
            coupled += _couplings((term.coupling,), values, len(robot.joints))
        elif not is_body(term):
            others.append((term, values))
    return drives, coupled, others


def _couplings(
    couplings: tuple[Coupling, ...], values: Weights, joints: int
) -> list[tuple[np.ndarray, np.ndarray]]:
    found = []
    for coupling, three in zip(couplings, values.reshape(-1, 3), strict=True):
        weights = np.zeros(joints)
        weights[[joint - 1 for joint in coupling.joints]] = coupling.weights
        found.append((weights, three))
    return found


def _checked_levels(levels: np.ndarray) -> np.ndarray:
    """Give the frictions, at least zero: a solver that keeps them there does so within its tolerance."""
    if (levels < -NEGLIGIBLE * np.abs(levels).max(initial=1.0)).any():
        raise OptionError(
            "a negative Coulomb friction cannot be simulated: it would drive a joint at rest both ways",
            evidence={"levels": [float(level) for level in levels]},
            remedy="estimate with the semidefinite programme, which keeps friction physical",
        )
    return np.asarray(np.maximum(levels, 0.0))


def share_of(robot: RobotModel, parts: Sequence[tuple[Term, Weights]]) -> Share:
    """Put terms together."""
    model = DynamicModel(robot, tuple(term for term, _ in parts))
    return Share(model, np.concatenate([np.zeros(0), *(values for _, values in parts)]))
