"""Combine a robot and its torque terms into one model that is linear in named parameters.

A model is extended by adding a term; the extended model has the same type.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import JointSeries, Parameters, Weights
from ..errors import OptionError
from ..robot.model import Parameter, RobotModel
from ..signals.state import MotionState
from .newton_euler import inverse_dynamics
from .term import Entry, Term
from .terms.coulomb import Coulomb
from .terms.coupling import GearCoupling
from .terms.offset import Offset
from .terms.rigid_body import RigidBody
from .terms.rotor_inertia import RotorInertia
from .terms.viscous import Viscous

STANDARD_TERMS: Mapping[str, type[RigidBody | RotorInertia | Viscous | Coulomb | Offset | GearCoupling]] = {
    "rigid_body": RigidBody,
    "rotor_inertia": RotorInertia,
    "viscous": Viscous,
    "coulomb": Coulomb,
    "offset": Offset,
    "coupling": GearCoupling,
}
"""The terms that can be chosen by name; a new standard term is one file and one line here."""


@dataclass(frozen=True, eq=False)
class DynamicModel:
    """Hold a robot and the terms: its joint torque is the sum of their columns times parameters."""

    robot: RobotModel
    terms: tuple[Term, ...]

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """List all standard parameters, term after term."""
        return tuple(parameter for term in self.terms for parameter in term.parameters(self.robot))

    @cached_property
    def entries(self) -> tuple[Entry, ...]:
        """List the (joint, parameter) pairs that can differ from zero, with positions in `parameters`."""
        found: list[Entry] = []
        start = 0
        for term in self.terms:
            found += [(joint, start + parameter) for joint, parameter in term.entries(self.robot)]
            start += len(term.parameters(self.robot))
        return tuple(found)

    @property
    def smoothing_widths(self) -> tuple[float, ...]:
        """Give the width of each joint's smoothed Coulomb friction, rad/s or m/s; empty for a sign."""
        return next((term.widths for term in self.terms if isinstance(term, Coulomb)), ())

    def torque(self, parameters: Parameters, state: MotionState) -> JointSeries:
        """Predict joint torque (N m or N) from standard parameters, by the terms' own plain series."""
        torque = np.zeros_like(state.position, dtype=float)
        for term, values in self.split(parameters):
            torque += term_torque(term, self.robot, values, state)
        return torque

    def split(self, parameters: Parameters) -> tuple[tuple[Term, Weights], ...]:
        """Split the standard parameters by term."""
        counts = [len(term.parameters(self.robot)) for term in self.terms]
        shares = np.split(np.asarray(parameters, dtype=float), np.cumsum(counts)[:-1])
        return tuple(zip(self.terms, shares, strict=True)) if counts else ()

    def with_term(self, term: Term) -> "DynamicModel":
        """Extend the model; a term of the same name is replaced."""
        kept = tuple(other for other in self.terms if other.name != term.name)
        return replace(self, terms=(*kept, term))


def term_torque(term: Term, robot: RobotModel, parameters: Parameters, state: MotionState) -> JointSeries:
    """Give the torque of one term, N m or N; rigid bodies need one recursion, not one per parameter."""
    if isinstance(term, RigidBody):
        return inverse_dynamics(robot, parameters.reshape(-1, 10), state.links)
    torque = np.zeros_like(state.position, dtype=float)
    for (joint, parameter), row in zip(term.entries(robot), term.series(robot, state), strict=True):
        torque[:, joint] += parameters[parameter] * row
    return torque


def standard_model(robot: RobotModel, names: tuple[str, ...] | None = None) -> DynamicModel:
    """Build the seed's model: rigid bodies, rotor inertia, friction, offset and declared couplings.

    Raises
    ------
    OptionError
        If a name is not a known term, or no term has a parameter on this robot.
    """
    wanted = tuple(STANDARD_TERMS) if names is None else names
    unknown = [name for name in wanted if name not in STANDARD_TERMS]
    if unknown:
        raise OptionError(
            "a torque term is not known",
            evidence={"unknown": unknown, "known": sorted(STANDARD_TERMS)},
            remedy="name terms from the list of known ones",
        )
    model = DynamicModel(robot, tuple(STANDARD_TERMS[name]() for name in STANDARD_TERMS if name in wanted))
    if not model.parameters:
        raise OptionError(
            "the chosen torque terms have no parameter on this robot",
            evidence={"terms": list(wanted), "couplings": len(robot.couplings)},
            remedy="keep rigid_body, or name terms that the robot's joints have",
        )
    return model
