"""Fit one model to measured motion, and judge the fit by every measure there is."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from ..arrays import BaseParameters, JointVector
from ..estimate.constraints import default_prior
from ..estimate.estimate import Estimate, estimate
from ..estimate.feasibility import active_constraints, feasibility
from ..estimate.kalman.innovations import Track
from ..estimate.methods.auto import AUTO
from ..estimate.methods.kalman import KalmanFilter
from ..estimate.methods.method import Step
from ..estimate.plausibility import link_bounds
from ..estimate.problem import ObservedProblem, Problem
from ..estimate.simulator import SimulationSetup, simulation_setup
from ..estimate.system import System
from ..log.gaps import naming_gaps
from ..log.model import JointLog
from ..numerics.block_bootstrap import block_draws
from ..numerics.mapping import SERIAL, Mapper
from ..precision.attenuation import Attenuation, attenuation
from ..precision.bootstrap import bootstrap
from ..precision.endogeneity import endogeneity
from ..precision.essential import essential_parameters
from ..precision.inference import infer
from ..regressor.observe import Observation, torque_scales
from ..validation.excitation import excitation
from ..validation.mass_matrix import check_mass_matrix, pseudo_inertia_eigenvalues, workspace
from ..validation.scores import reversals_percent, scores, total_percent
from .choice import SPARED, USUAL, Choice, choose
from .convergence import Convergence, converge
from .flexible import springs_of
from .flexible_band import with_springs
from .options import IdentifyOptions
from .result import Identification

Progress = Callable[[str, float], None]


def no_progress(_stage: str, _fraction: float) -> None:
    """Take a report of progress and do nothing with it."""


def scaled_progress(tell: Progress, begin: float, share: float) -> Progress:
    """Report the progress of a part, which takes a share of the whole."""
    return lambda stage, done: tell(stage, begin + share * done)


@dataclass(frozen=True, eq=False)
class Fit:
    """Hold the solution of a problem."""

    problem: Problem
    observation: Observation
    """The equations of all blocks, rows as they were measured."""
    step: Step
    """The equations that were solved, without a prior."""
    estimate: Estimate
    convergence: Convergence
    """How an iterative estimator ended."""
    simulation: SimulationSetup
    """How the logs were simulated, or which other periods stood beside them, where it iterates."""
    position_rms: JointVector | None
    """RMS of that motion less the measured positions, rad or m; None where there is none."""
    track: Track | None
    """Its parameters over time; None where they were not followed."""
    options: IdentifyOptions
    """By which options it was fitted: with the estimator that was chosen, if the choice was left open."""
    choice: Choice | None = None
    """Which one that was; None where it was asked for."""

    @property
    def attenuation(self) -> Attenuation:
        """Predict what noise of positions makes of the inertias of least squares."""
        fitted, _ = self.observation.parts(self.problem.held_out)
        return attenuation(self.observation, fitted, self.problem.motions, self.estimate.base)


def fit(
    problem: Problem, options: IdentifyOptions, tell: Progress, observation: Observation | None = None
) -> Fit:
    """Fit one model to the motions, or to what was observed of them already."""
    if observation is None:
        observation = problem.observed(lambda done: tell("observe", 0.3 + 0.3 * done))

    def fit_by(estimator: str) -> Fit:
        return _fit(problem, replace(options, estimate=options.estimate.by(estimator)), tell, observation)

    if options.estimate.estimator != AUTO:
        return fit_by(options.estimate.estimator)
    least = fit_by(USUAL)
    found, choice = choose(problem, least, least.attenuation, lambda: fit_by(SPARED))
    return replace(found, choice=choice)


def refitted(problem: Problem, options: IdentifyOptions, tell: Progress, least: Fit) -> Fit:
    """Fit as asked what least squares was fitted to: that is the fit where no iteration is asked for."""
    return fit(problem, options, tell, least.observation) if options.estimate.method.iterative else least


def _fit(problem: Problem, options: IdentifyOptions, tell: Progress, observation: Observation) -> Fit:
    """Fit by the estimator that the options name."""
    tell("estimate", 0.6)
    asked = options.estimate
    with naming_gaps([motion.log for motion in problem.motions]):
        scales = torque_scales(observation, observation.parts(problem.held_out)[0])
    problem, observation, judged_by = _begun(problem, options, observation)
    simulation = simulation_setup(problem.base, problem.motions, asked.simulation)
    data = ObservedProblem(
        problem, observation, asked.robust, asked.weigh_reversals, simulation=simulation, kalman=asked.kalman
    )
    with naming_gaps([motion.log for motion in problem.motions]):
        data.check_excitation()
    prior = default_prior(problem.base.model, scales, problem.sizes)

    def solve(step: Step) -> Estimate:
        return estimate(problem.base, step.system.with_prior(problem.prior), prior, asked)

    step, found, convergence = converge(
        asked.method, data, solve, asked.iteration, lambda done: tell("simulate", 0.6 + 0.1 * done)
    )
    method = asked.method
    apart = data.position_rms(found.standard) if method.iterative else None
    track = None
    if isinstance(method, KalmanFilter) and asked.kalman.drift > 0.0 and step.innovations is not None:
        followed = data.tracked(found.standard, unscented=method.unscented)
        track = followed.widened(step.innovations.dispersion)
    return Fit(problem, judged_by(found.base), step, found, convergence, simulation, apart, track, options)


def _begun(
    problem: Problem, options: IdentifyOptions, observation: Observation
) -> tuple[Problem, Observation, Callable[[BaseParameters], Observation]]:
    """Give the problem, its first equations, and those that its estimate is judged by.

    With flexible joints they depend on where the links are.
    """
    joints = options.estimate.flexible_joints
    if not joints:
        return problem, observation, lambda _: observation
    begun = with_springs(problem, joints, options.filter)
    return begun.problem, begun.differentiated, begun.observed


def judge(logs: tuple[JointLog, ...], found: Fit, tell: Progress, mapper: Mapper = SERIAL) -> Identification:
    """Judge a fit: how well every parameter is known, and how well held-out blocks are predicted."""
    problem, observation, answer, options = found.problem, found.observation, found.estimate, found.options
    own, data, prior = found.step.system, found.step.data, answer.prior
    system = own.with_prior(problem.prior)
    base, model = problem.base, problem.base.model
    fitted, held = observation.parts(problem.held_out)
    tell("assess", 0.7)
    precision = infer(system, data.memory, data.columns_of, answer.base, prior=problem.prior)
    springs = springs_of(problem, found.step, answer, precision.covariance, options)
    essential = essential_parameters(system, precision)
    kept = essential.kept if options.essential else None
    if kept is not None:
        answer = estimate(base, system, prior, options.estimate, essential=kept)

    def solve(drawn: System) -> BaseParameters:
        system = drawn.with_prior(problem.prior)
        return estimate(base, system, prior, options.estimate, essential=kept).base

    drawn = block_draws(len(fitted), options.bootstrap.draws, options.bootstrap.seed)
    draws = bootstrap(system, data.block_factors, data.columns_of, solve, drawn, mapper)
    tell("validate", 0.9)
    return Identification(
        logs=logs,
        motions=problem.motions,
        base=base,
        flexible_joints=springs,
        observation=observation,
        estimate=answer,
        precision=precision,
        essential=essential,
        draws=draws,
        fit=scores(observation, fitted, answer.base),
        fit_total_percent=total_percent(observation, fitted, answer.base),
        validation=scores(observation, held, answer.base) if held else (),
        validation_total_percent=total_percent(observation, held, answer.base) if held else 0.0,
        reversals_percent=reversals_percent(observation, held, answer.base),
        reversal_weights=data.reversal_weights,
        excitation=excitation(system.triangle),
        unconstrained_feasibility=feasibility(base, answer.unconstrained, prior),
        estimate_feasibility=feasibility(base, base.base_of(answer.standard), prior),
        pseudo_inertia_eigenvalues=pseudo_inertia_eigenvalues(model, answer.standard),
        unconstrained_plausible=feasibility(
            base, answer.unconstrained, prior, options.estimate.bounds
        ).feasible,
        extents=tuple(link.extent for link in link_bounds(model, options.estimate.bounds, prior)),
        active_constraints=active_constraints(model, answer.standard, prior, options.estimate.bounds),
        trajectory=check_mass_matrix(model, answer.standard, observation.positions),
        workspace=check_mass_matrix(model, answer.standard, workspace(model.robot)),
        widths=model.smoothing_widths,
        seed=options.bootstrap.seed,
        held_out=problem.held_out,
        estimator=options.estimate.estimator,
        convergence=found.convergence,
        start_percent=None
        if found.convergence.start is None
        else total_percent(observation, held or fitted, found.convergence.start),
        simulation=found.simulation,
        position_rms=found.position_rms,
        innovations=found.step.innovations,
        track=found.track,
        endogeneity=None
        if own.carried is None
        else endogeneity(own, data.factors, data.memory, data.columns_of),
        attenuation=found.attenuation,
        choice=found.choice,
    )
