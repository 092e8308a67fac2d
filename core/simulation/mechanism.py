"""Sort a model's torque terms by how they have to be integrated.

What multiplies acceleration joins the mass matrix, viscous friction is taken implicitly, Coulomb friction is
a set with a level, and every other term is evaluated as it stands at the state of the moment.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from core.arrays import JointSeries, Parameters
from core.dynamics.model import DynamicModel
from core.dynamics.term import Term
from core.dynamics.terms.coulomb import Coulomb
from core.dynamics.terms.coupling import GearCoupling
from core.dynamics.terms.offset import Offset
from core.dynamics.terms.rigid_body import RigidBody
from core.dynamics.terms.rotor_inertia import RotorInertia
from core.dynamics.terms.viscous import Viscous
from core.errors import OptionError
from core.robot.model import RobotModel
from core.signals.state import MotionState
from core.simulation import forward
from core.simulation.inverse import Bodies, bodies_of, columns


@dataclass(frozen=True, eq=False)
class Mechanism:
    """Hold a model with numbers, sorted for simulation; build it with `mechanism_of`.

    Attributes
    ----------
    model, parameters
        The model and its standard parameters.
    inertia, damping
        What rotors and couplings add to the mass matrix (kg m2), and viscous friction (N m s/rad), joints x
        joints.
    offset
        Constant torque per joint, N m.
    weights, levels
        One row per friction that can hold: the speed it acts on is `weights @ velocity`, its level in N m.
    others, other_parameters
        All other terms, and their parameters.
    """

    model: DynamicModel
    parameters: Parameters
    inertia: np.ndarray
    damping: np.ndarray
    offset: np.ndarray
    weights: np.ndarray
    levels: np.ndarray
    others: DynamicModel
    other_parameters: Parameters

    @property
    def robot(self) -> RobotModel:
        """Give the robot."""
        return self.model.robot

    @property
    def joints(self) -> int:
        """Count the joints."""
        return len(self.offset)

    @cached_property
    def bodies(self) -> Bodies:
        """Give the robot as the kernels need it; masses of whole subtrees come last."""
        table = np.zeros((len(self.robot.links), 10))
        for term, values in _parts(self.model, self.parameters):
            if isinstance(term, RigidBody):
                table += values.reshape(-1, 10)
        return bodies_of(self.robot, table)

    def mass_matrices(self, position: JointSeries) -> np.ndarray:
        """Give the mass matrix (kg m2), rotors included, for every row of positions."""
        matrices = np.empty((len(position), self.joints, self.joints))
        forward.mass_matrices(self.bodies, columns(position), matrices)
        return np.asarray(matrices + self.inertia)

    def torque(self, state: MotionState) -> JointSeries:
        """Predict the torque (N m or N) of a motion, as `DynamicModel.torque` does but compiled."""
        moved = np.empty((self.joints, len(state.position)))
        tables = (columns(one) for one in (state.position, state.velocity, state.acceleration))
        forward.torques(self.bodies, *tables, moved)
        kept = [
            (term, part) for term, part in _parts(self.model, self.parameters) if term.name != "rigid_body"
        ]
        rest = replace(self.model, terms=tuple(term for term, _ in kept))
        values = np.concatenate([np.zeros(0), *(part for _, part in kept)])
        return np.asarray(moved.T + rest.torque(values, state))


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
    drives, coupled, others = _sorted(model, parameters)
    inertia, damping = np.diag(drives[RotorInertia]), np.diag(drives[Viscous])
    for weights, (rotor, viscous, _) in coupled:
        inertia = inertia + rotor * np.outer(weights, weights)
        damping = damping + viscous * np.outer(weights, weights)
    weights = np.vstack([np.eye(joints), *(weights[None] for weights, _ in coupled)])
    levels = np.concatenate([drives[Coulomb], [values[2] for _, values in coupled]])
    _check_levels(levels)
    # Any term may jump where its joint stands: only a model without such terms can leave joints out.
    kept = (levels > 0.0) | (np.arange(len(levels)) < joints) & bool(others)
    return Mechanism(
        model=model,
        parameters=parameters,
        inertia=inertia,
        damping=damping,
        offset=drives[Offset],
        weights=weights[kept],
        levels=levels[kept],
        others=DynamicModel(model.robot, tuple(term for term, _ in others)),
        other_parameters=np.concatenate([np.zeros(0), *(values for _, values in others)]),
    )


def _parts(model: DynamicModel, parameters: Parameters) -> Iterator[tuple[Term, Parameters]]:
    start = 0
    for term in model.terms:
        stop = start + len(term.parameters(model.robot))
        yield term, np.asarray(parameters[start:stop], dtype=float)
        start = stop


def _sorted(
    model: DynamicModel, parameters: Parameters
) -> tuple[dict[type, np.ndarray], list[tuple[np.ndarray, np.ndarray]], list[tuple[Term, Parameters]]]:
    """Sort terms: numbers per joint by kind, couplings as weights and three numbers, all others."""
    drives: dict[type, np.ndarray] = {
        kind: np.zeros(len(model.robot.joints)) for kind in (RotorInertia, Viscous, Coulomb, Offset)
    }
    coupled: list[tuple[np.ndarray, np.ndarray]] = []
    others: list[tuple[Term, Parameters]] = []
    for term, values in _parts(model, parameters):
        if type(term) in drives:
            drives[type(term)][[joint for joint, _ in term.entries(model.robot)]] += values
        elif isinstance(term, GearCoupling):
            coupled += _couplings(model.robot, values)
        elif not isinstance(term, RigidBody):
            others.append((term, values))
    return drives, coupled, others


def _couplings(robot: RobotModel, values: Parameters) -> list[tuple[np.ndarray, np.ndarray]]:
    found = []
    for coupling, three in zip(robot.couplings, values.reshape(-1, 3), strict=True):
        weights = np.zeros(len(robot.joints))
        weights[[joint - 1 for joint in coupling.joints]] = coupling.weights
        found.append((weights, three))
    return found


def _check_levels(levels: np.ndarray) -> None:
    if (levels < 0.0).any():
        raise OptionError(
            "a negative Coulomb friction cannot be simulated: it would drive a joint at rest both ways",
            evidence={"levels": [float(one) for one in levels]},
            remedy="estimate with the semidefinite programme, which keeps friction physical",
        )
