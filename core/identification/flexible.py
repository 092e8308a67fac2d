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
    problem: Problem, step: Step, found: Estimate, covariance: SquareMatrix, options: EstimateOptions
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
    rigid = _rigid(problem, options)
    flexible = step.data, found.base
    known = _Springs(problem, found, covariance)
    springs = tuple(known.of(joint, _gain(rigid, flexible, joint)) for joint in joints)
    evidence = {spring.joint: spring.evidence for spring in springs}
    reasons = {joint: list(reasons_unseen(own)) for joint, own in evidence.items()}
    for joint, own in evidence.items():
        if not own[GAIN] >= CLEAR:
            reasons[joint].append(
                f"it explains the torque no better than a rigid one ({own[GAIN]:.2g} deviations, not"
                f" {CLEAR:g})"
            )
    refuse_hidden(evidence, reasons)
    return springs


def _squares(data: Equations, base: BaseParameters, joint: int) -> Vector:
    """Give the mean squared residual of a joint, fitted block after fitted block."""
    place = data.columns_of[joint]
    factors = [factors[joint] for factors in data.block_factors]
    return np.array([factor.residual_square(base[place]) / max(factor.rows, 1) for factor in factors])


def _gain(
    rigid: tuple[Equations, BaseParameters] | None, flexible: tuple[Equations, BaseParameters], joint: int
) -> float:
    """Give by how many deviations, over blocks, the simulated torque of a rigid robot is further off."""
    if rigid is None:
        return np.inf
    gained = _squares(*rigid, joint) - _squares(*flexible, joint)
    spread = float(np.std(gained, ddof=1) / np.sqrt(len(gained)))
    return float(np.mean(gained)) / spread if spread > 0.0 else 0.0


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

    def of(self, joint: int, gain: float) -> FlexibleJoint:
        """Give what is known of a joint (from 0)."""
        plan = self.problem.plan
        stiff, damp, rotor = (column_of(plan, symbol, joint) for symbol in (STIFFNESS, DAMPING, ROTOR))
        units = np.eye(len(self.base))
        k, motor, link = self.base[stiff], self.base[rotor], self.inertias[joint, 0]
        slope = self.inertias[joint, 1:]
        antiresonance = np.sqrt(k / link) / (2.0 * np.pi)
        natural = np.sqrt(k / link + k / motor) / (2.0 * np.pi)
        by_k, by_link = units[stiff] / (2.0 * k), -slope / (2.0 * link)
        share = link / (motor + link)
        rows = [
            ("stiffness", k, units[stiff], plan.model.parameters[plan.columns[stiff]].unit),
            ("damping", self.base[damp], units[damp], plan.model.parameters[plan.columns[damp]].unit),
            ("motor_inertia", motor, units[rotor], plan.model.parameters[plan.columns[rotor]].unit),
            ("link_inertia", link, slope, plan.model.parameters[plan.columns[rotor]].unit),
            ("antiresonance", antiresonance, antiresonance * (by_k + by_link), "Hz"),
            (
                "natural",
                natural,
                natural * (by_k + (1.0 - share) * by_link - share * units[rotor] / (2.0 * motor)),
                "Hz",
            ),
        ]
        quantities = tuple(
            SpringValue(name, float(value), float(np.sqrt(max(by @ self.covariance @ by, 0.0))), unit)
            for name, value, by, unit in rows
        )
        return FlexibleJoint(joint + 1, quantities, self._evidence(joint, quantities) | {GAIN: gain})

    def _evidence(self, joint: int, quantities: tuple[SpringValue, ...]) -> dict[str, float]:
        known = {quantity.name: quantity for quantity in quantities}
        stiffness = known["stiffness"]
        return {
            **seen_by(self.problem.motions, joint, known["antiresonance"].value, known["natural"].value),
            KNOWN: 100.0 * stiffness.standard_deviation / stiffness.value,
        }
