"""Fit a robot with springs between motors and links, and say what is known of every spring.

The first estimate takes the links to be where the torques say they are. Then the log is simulated with motors
and links apart. Noise outweighs the motion far above the modes, so that the filter follows them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ..arrays import BaseParameters, JointSeries, Parameters, SquareMatrix, Vector
from ..dynamics.terms.flexible_joints import DAMPING, STIFFNESS, FlexibleJoints
from ..errors import ExcitationError, OptionError, SolverError, VeritorqueError
from ..estimate.constraints import default_prior
from ..estimate.estimate import Estimate, estimate
from ..estimate.flexible_start import FlexibleStart, begin, flexible_joints, standard_of
from ..estimate.methods.method import Equations, Step
from ..estimate.options import EstimateOptions
from ..estimate.problem import ObservedProblem, Problem
from ..estimate.simulator import SimulationSetup
from ..estimate.system import weighted
from ..reduction.base import BaseModel, base_model
from ..regressor.eliminated import column_of
from ..regressor.observe import torque_scales
from ..signals.condition import Motion, condition
from ..signals.recipe import FilterOptions
from ..simulation.closed_loop.springs import links_of
from ..simulation.mechanism import mechanism_of
from ..validation.springs_seen import HIGHEST_SHARE, reasons_unseen, torque_share

BAND_OVER_MODE: Final = 1.6
"""Parallel cut-off over the highest mode: the mode and what lies around it pass."""
POSITIONS_OVER_BAND: Final = 3.0
"""Cut-off of positions over that: it bends what passes by less than 1e-5."""
SETTLED: Final = 0.15
"""Relative change of the band below which it follows the modes."""
BANDS: Final = (1.0, 2.5, 6.0)
"""Bands that are begun with, as multiples of the motion's: near the mode a spring shows most clearly."""
CLEAR: Final = 3.0
"""Standard deviations, over blocks of the log, by which the residual has to fall below a rigid arm's."""
KNOWN, GAIN = "stiffness_deviation_percent", "residual_gain_deviations"
ROUNDS: Final = 5
"""Bands at most: from a tenth of the mode each round finds more of it."""


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


def with_springs(problem: Problem, joints: tuple[int, ...], options: FilterOptions) -> FlexibleStart:
    """Give the problem in which these joints are flexible, and where it begins.

    Raises
    ------
    ExcitationError
        If the logs do not show that they are.
    """
    own = replace(problem, base=base_model(problem.base.model.with_term(FlexibleJoints(joints))))
    if options.cutoff_hz is not None:
        return _sized(_checked(begin(own)))
    band = max(motion.recipe.motion_band_hz for motion in problem.motions)
    failure: VeritorqueError | None = None
    for share in BANDS:
        try:
            return _sized(_checked(_followed(own, options, share * band)))
        except (ExcitationError, OptionError) as error:
            failure = failure or error
    raise failure or unseen(list(joints), {}, "no band shows it")


def _followed(problem: Problem, options: FilterOptions, band: float) -> FlexibleStart:
    """Begin with a band, and let it follow the modes that are found, but not below the motion."""
    least = max(motion.recipe.motion_band_hz for motion in problem.motions)
    begun = begin(replace(problem, motions=_conditioned(problem, options, band)))
    for _ in range(ROUNDS):
        wanted = max(BAND_OVER_MODE * float(np.max(_modes(begun)[1])), least)
        if not abs(wanted - band) > SETTLED * band:
            break
        band = wanted
        begun = begin(replace(problem, motions=_conditioned(problem, options, band)))
    return begun


def _conditioned(problem: Problem, options: FilterOptions, band_hz: float) -> tuple[Motion, ...]:
    """Condition the logs anew, with a filter that passes so much."""
    robot = problem.base.model.robot

    def within(motion: Motion) -> FilterOptions:
        rate = motion.log.rate_hz
        band = min(band_hz, HIGHEST_SHARE * rate)
        positions = options.position_cutoff_hz or min(POSITIONS_OVER_BAND * band, 0.4 * rate)
        return replace(options, cutoff_hz=band, position_cutoff_hz=positions)

    return tuple(
        condition(motion.log, robot, within(motion), blocks=motion.blocks) for motion in problem.motions
    )


def _modes(begun: FlexibleStart) -> tuple[Vector, Vector]:
    """Give every spring's antiresonance and natural frequency, Hz; infinite where an inertia is negative."""
    problem, own = begun.problem, begun.transmission(begun.base)
    mechanism = links_of(mechanism_of(problem.base.model, standard_of(problem, begun.base)))
    mass = mechanism.mass_matrices(_positions(problem))
    link = np.median(np.diagonal(mass, axis1=1, axis2=2), axis=0)[own.joints]
    squares = np.where(link > 0.0, own.stiffness / np.where(link > 0.0, link, 1.0), np.inf)
    return np.sqrt(squares) / (2.0 * np.pi), np.sqrt(squares + own.stiffness / own.rotor) / (2.0 * np.pi)


def _positions(problem: Problem) -> JointSeries:
    """Give some positions of every motion."""
    return np.vstack([next(motion.tiles()).state.position[::200] for motion in problem.motions])


def _checked(begun: FlexibleStart) -> FlexibleStart:
    """Refuse at once springs that the sampling or the torque hides: they would be simulated to no end."""
    low, high = _modes(begun)
    joints = [int(joint) for joint in begun.transmission(begun.base).joints]
    evidence = {
        joint + 1: _seen_by(begun.problem.motions, joint, float(at), float(mode)) | {KNOWN: 0.0}
        for joint, at, mode in zip(joints, low, high, strict=True)
    }
    _refuse_hidden(evidence, {joint: list(reasons_unseen(own)) for joint, own in evidence.items()})
    return begun


def _refuse_hidden(evidence: Mapping[int, Mapping[str, float]], reasons: Mapping[int, list[str]]) -> None:
    hidden = [joint for joint, own in reasons.items() if own]
    if hidden:
        why = "; ".join(f"joint {joint}: {', '.join(reasons[joint])}" for joint in hidden)
        raise unseen(hidden, {f"joint_{joint}": dict(evidence[joint]) for joint in hidden}, why)


def _seen_by(motions: Sequence[Motion], joint: int, low_hz: float, high_hz: float) -> dict[str, float]:
    """Give what tells whether logs show a mode."""
    seen = np.isfinite(high_hz)
    shares = [
        torque_share(_torque(motion)[:, joint], motion.log.rate_hz, low_hz, high_hz) if seen else 0.0
        for motion in motions
    ]
    return {
        "natural_hz": high_hz,
        "antiresonance_hz": low_hz,
        "rate_hz": min(motion.log.rate_hz for motion in motions),
        "torque_share_percent": 100.0 * max(shares),
    }


def unseen(joints: list[int], evidence: Mapping[str, object], why: str) -> ExcitationError:
    """Say that the logs do not show springs."""
    named = f"joint {joints[0]} is" if len(joints) == 1 else f"joints {', '.join(map(str, joints))} are"
    return ExcitationError(
        f"the logs do not show that {named} flexible: {why}",
        evidence=dict(evidence),
        remedy="leave rigid joints out of flexible_joints, or let all joints move with frequencies up to "
        f"their modes, sampled at more than {1.0 / HIGHEST_SHARE:.2g} times these",
    )


def _sized(begun: FlexibleStart) -> FlexibleStart:
    """Say what counts as one unit of a spring in a prior."""
    own, sizes = begun.transmission(begun.base), dict(begun.problem.sizes)
    for joint, stiffness, rotor in zip(own.joints, own.stiffness, own.rotor, strict=True):
        sizes[f"{STIFFNESS}{joint + 1}"] = float(stiffness)
        sizes[f"{DAMPING}{joint + 1}"] = float(np.sqrt(stiffness * rotor))
    return replace(begun, problem=replace(begun.problem, sizes=sizes))


def springs_of(
    problem: Problem, step: Step, found: Estimate, covariance: SquareMatrix, options: EstimateOptions
) -> tuple[FlexibleJoint, ...]:
    """Give what is known of every flexible joint; nothing where all are rigid.

    Raises
    ------
    ExcitationError
        If the logs do not show one of the springs.
    """
    joints = flexible_joints(problem)
    if not len(joints):
        return ()
    rigid = _rigid(problem, options)
    flexible = step.data, found.base
    known = _Springs(problem, found, covariance)
    springs = tuple(known.of(int(joint), _gain(rigid, flexible, int(joint))) for joint in joints)
    evidence = {spring.joint: spring.evidence for spring in springs}
    reasons = {joint: list(reasons_unseen(own)) for joint, own in evidence.items()}
    for joint, own in evidence.items():
        if not own[GAIN] >= CLEAR:
            reasons[joint].append(
                f"it explains the torque no better than a rigid one ({own[GAIN]:.2g} deviations, not"
                f" {CLEAR:g})"
            )
    _refuse_hidden(evidence, reasons)
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
        self.positions = _positions(problem)
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
        stiff, damp, rotor = (column_of(plan, symbol, joint) for symbol in (STIFFNESS, DAMPING, "IA"))
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
            **_seen_by(self.problem.motions, joint, known["antiresonance"].value, known["natural"].value),
            KNOWN: 100.0 * stiffness.standard_deviation / stiffness.value,
        }


def _torque(motion: Motion) -> JointSeries:
    """Give the torque of the longest stretch of a motion."""
    segment = max(motion.segments, key=lambda one: one.samples)
    return segment.effort(0, segment.kept)[0]
