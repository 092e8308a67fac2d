"""Say what is known of every spring between motors and links that was fitted.

A spring is told from a rigid joint by the simulation of both: noise of measured accelerations is in neither.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ..arrays import BaseParameters, Parameters, SquareMatrix, Vector
from ..dynamics.terms.flexible_joints import DAMPING, STIFFNESS, FlexibleJoints
from ..errors import SolverError
from ..estimate.constraints import default_prior
from ..estimate.estimate import Estimate, estimate
from ..estimate.methods.method import Equations, Step
from ..estimate.options import EstimateOptions
from ..estimate.problem import ObservedProblem, Problem
from ..estimate.simulator import SimulationSetup
from ..estimate.system import weighted
from ..reduction.base import BaseModel, base_model, flexible_joints
from ..regressor.eliminated import ROTOR, column_of
from ..regressor.observe import torque_scales
from ..simulation.closed_loop.springs import links_of
from ..simulation.mechanism import mechanism_of
from ..validation.springs_seen import reasons_unseen
from .options import IdentifyOptions
from .spring_evidence import KNOWN, positions_of, refuse_hidden, seen_by

CLEAR: Final = 3.0
"""Standard deviations, over blocks of the log, by which the residual has to fall below a rigid arm's."""
GAIN: Final = "residual_gain_deviations"


@dataclass(frozen=True)
class SpringValue:
    """Hold a number with its standard deviation."""

    name: str
    value: float
    standard_deviation: float
    unit: str


@dataclass(frozen=True, eq=False)
class FlexibleJoint:
    """Hold what is known of a flexible joint."""

    joint: int
    """From 1."""
    quantities: tuple[SpringValue, ...]
    """Stiffness, damping, inertias of motor and link, frequencies."""
    evidence: Mapping[str, float]
    """The numbers by which it is seen."""


def springs_of(
    problem: Problem, step: Step, found: Estimate, covariance: SquareMatrix, options: IdentifyOptions
) -> tuple[FlexibleJoint, ...]:
    """Give what is known of every flexible joint; nothing where all are rigid.

    Raises
    ------
    ExcitationError
        If the logs do not show one of the springs.
    """
    joints = flexible_joints(problem.base.model)
    if not joints:
        return ()
    rigid = _rigid(problem, options.estimate)
    flexible = step.data, found.base
    known = _Springs(problem, found, covariance)
    springs = tuple(known.of(joint, _gain(rigid, flexible, joint)) for joint in joints)
    evidence = {spring.joint: spring.evidence for spring in springs}
    reasons = {joint: list(reasons_unseen(own)) for joint, own in evidence.items()}
    for joint, own in evidence.items():
        if not own.get(GAIN, np.inf) >= CLEAR:
            reasons[joint].append(
                f"a flexible joint explains the torque no better than a rigid one ({own[GAIN]:.2g}"
                f" deviations, not {CLEAR:g})"
            )
    refuse_hidden(evidence, reasons, options.filter.cutoff_hz)
    return springs


def _squares(data: Equations, base: BaseParameters, joint: int) -> Vector:
    """Give the mean squared residual of a joint, fitted block after fitted block."""
    place = data.columns_of[joint]
    factors = [factors[joint] for factors in data.block_factors]
    return np.array([factor.residual_square(base[place]) / max(factor.rows, 1) for factor in factors])


def _gain(
    rigid: tuple[Equations, BaseParameters] | None, flexible: tuple[Equations, BaseParameters], joint: int
) -> dict[str, float]:
    """Give by how many deviations, over blocks, the simulated torque of a rigid robot is further off.

    Nothing where no rigid robot can be simulated.
    """
    if rigid is None:
        return {}
    gained = _squares(*rigid, joint) - _squares(*flexible, joint)
    spread = float(np.std(gained, ddof=1) / np.sqrt(len(gained)))
    return {GAIN: float(np.mean(gained)) / spread if spread > 0.0 else 0.0}


def _rigid(problem: Problem, options: EstimateOptions) -> tuple[Equations, BaseParameters] | None:
    """Fit the same logs by the same simulation of a rigid robot; None where that diverges."""
    model, least = problem.base.model, options.by("sdp")
    plain = replace(model, terms=tuple(term for term in model.terms if not isinstance(term, FlexibleJoints)))
    own = replace(problem, base=base_model(plain), sizes={})
    observation = own.observed()
    data = ObservedProblem(own, observation, simulation=SimulationSetup(options.simulation)).discounted()
    prior = default_prior(plain, torque_scales(observation, data.fitted))
    system = weighted(data.factors, data.columns_of, data.size)
    try:
        found = estimate(own.base, system, prior, least)
        moved = data.simulated(found.standard).discounted()
    except SolverError:
        return None
    return moved, weighted(moved.factors, moved.columns_of, moved.size).solved()


class _Springs:
    """Compute quantities of springs with deviations."""

    def __init__(self, problem: Problem, found: Estimate, covariance: SquareMatrix) -> None:
        self.problem, self.base, self.covariance = problem, found.base, covariance
        self.positions = positions_of(problem)
        self.inertias = self._inertias(problem.base, found.standard)

    def _inertias(self, model: BaseModel, standard: Parameters) -> Vector:
        """Give the median inertia of every joint's links, and its derivatives by the base parameters."""
        changes = [1e-3 * max(abs(value), 1e-3) for value in self.base]
        units = np.eye(len(standard))

        def of(at: Parameters) -> Vector:
            mass = links_of(mechanism_of(model.model, at)).mass_matrices(self.positions)
            return np.asarray(np.median(np.diagonal(mass, axis1=1, axis2=2), axis=0))

        own = of(standard)
        slopes = [
            (of(standard + change * units[kept]) - own) / change
            for kept, change in zip(model.kept, changes, strict=True)
        ]
        return np.column_stack([own, *slopes])

    def of(self, joint: int, gain: Mapping[str, float]) -> FlexibleJoint:
        """Give what is known of a joint (from 0)."""
        plan = self.problem.plan
        columns = [column_of(plan, symbol, joint) for symbol in (STIFFNESS, DAMPING, ROTOR)]
        units = [plan.model.parameters[plan.columns[column]].unit for column in columns]
        stiffness, damping, motor = self.base[columns]
        by_stiffness, by_damping, by_motor = np.eye(len(self.base))[columns]
        link, by_link = self.inertias[joint, 0], self.inertias[joint, 1:]
        inverses = np.array([1.0 / link, 1.0 / link + 1.0 / motor])
        low, high = (float(hertz) for hertz in np.sqrt(stiffness * inverses) / (2.0 * np.pi))
        share = motor / (motor + link)
        by_low = by_stiffness / stiffness - by_link / link
        by_high = by_stiffness / stiffness - share * by_link / link - (1.0 - share) * by_motor / motor
        quantities = (
            self._value("stiffness", stiffness, by_stiffness, units[0]),
            self._value("damping", damping, by_damping, units[1]),
            self._value("motor_inertia", motor, by_motor, units[2]),
            self._value("link_inertia", link, by_link, units[2]),
            self._value("antiresonance", low, low * by_low / 2.0, "Hz"),
            self._value("natural", high, high * by_high / 2.0, "Hz"),
        )
        known = {KNOWN: 100.0 * quantities[0].standard_deviation / quantities[0].value}
        evidence = seen_by(self.problem.motions, joint, low, high) | known | dict(gain)
        return FlexibleJoint(joint + 1, quantities, evidence)

    def _value(self, name: str, value: float, slopes: Vector, unit: str) -> SpringValue:
        """Give a quantity with its deviation, by its derivatives."""
        variance = max(slopes @ self.covariance @ slopes, 0.0)
        return SpringValue(name, float(value), float(np.sqrt(variance)), unit)
