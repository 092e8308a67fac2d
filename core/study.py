"""Tell the whole story on one page: from logs to a robot that can exist, and how far it is to be believed.

This is the only module that meets every chapter; each step takes what the step before gave.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from core.admission import admit, known_log
from core.arrays import Parameters
from core.diagnosis.belief import Belief
from core.diagnosis.diagnosis import Diagnosis
from core.diagnosis.reference import PRIOR, Reference, reference_from_prior
from core.diagnosis.verdict import Question
from core.diagnosis.verdict import diagnose as find_causes
from core.dynamics.model import DynamicModel, standard_model
from core.errors import OptionError, SolverError, VeritorqueError
from core.estimate.constraints import default_prior
from core.estimate.estimate import estimate
from core.estimate.feasibility import active_constraints, feasibility
from core.estimate.measured import Measured, smoothed, weighted_system
from core.estimate.system import System
from core.extension.extend import cures, extended_base, sizes, taken_along
from core.extension.fold import folded
from core.extension.gain import gains
from core.log.model import JointLog
from core.options import IdentifyOptions, parse_diagnose_options, parse_options
from core.precision.bootstrap import bootstrap
from core.precision.covariance import assess
from core.precision.essential import essential_parameters
from core.reduction.base import BaseModel, base_model
from core.regressor.columns import ColumnPlan
from core.regressor.observe import torque_scales
from core.report.compared import compared
from core.report.diagnosed import Diagnosed
from core.report.diagnosis_document import diagnosis_document
from core.report.document import grouping_row, identification_document
from core.report.earlier import reference_from_document
from core.report.identification import Identification
from core.report.numbers import plain
from core.report.traces.writing import write_traces
from core.robot.model import RobotModel
from core.signals.several import condition_all
from core.simulation.mechanism import mechanism_of
from core.simulation.multistep import Comparison, compare
from core.validation.excitation import excitation
from core.validation.mass_matrix import check_mass_matrix, pseudo_inertia_eigenvalues, workspace
from core.validation.scores import scores, total_percent

Progress = Callable[[str, float], None]

__all__ = ["IdentifyRequest", "base_parameters", "identify", "identify_in_full", "parse_options"]


@dataclass(frozen=True, eq=False)
class IdentifyRequest:
    """Ask for an identification: a robot, its logs, and options as plain data (see `core.options`).

    `reference` is the result document of the job that the option of that name means, where it means one;
    `traces` the file to write motion, torque and residual to, where somebody wants to look at them.
    """

    robot: RobotModel
    logs: tuple[JointLog, ...]
    options: Mapping[str, object] = field(default_factory=dict)
    reference: Mapping[str, object] | None = None
    traces: Path | None = None


def identify(request: IdentifyRequest, progress: Progress | None = None) -> dict[str, object]:
    """Identify a robot and give the result document.

    Parameters
    ----------
    progress
        Called with the stage's name and the fraction of the whole that is done.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way, with cause, evidence and remedy.
    """
    found = identify_in_full(request, progress)
    write_traces(request.traces, found)
    return identification_document(found, version=_version(), options=parse_options(request.options).given)


def identify_in_full(request: IdentifyRequest, progress: Progress | None = None) -> Identification:
    """Identify a robot and give every chapter's result."""
    tell = progress or _say_nothing
    options = parse_options(request.options)
    data, base = _prepared(request, options, tell)
    return _identified(request, options, _Fitting(data, base), tell)


def check_reference(request: IdentifyRequest) -> None:
    """Refuse a reference that a robot's logs cannot be compared with; logs are not looked at.

    Raises
    ------
    OptionError
        If it is the result of another robot's log, or options are given that it decides.
    RobotError
        If the robot's own bodies are to be compared with and it brings none.
    """
    options = parse_diagnose_options(request.options)
    _earlier(request, options)
    if options.reference == PRIOR:
        reference_from_prior(base_model(standard_model(request.robot, options.terms)))


def _earlier(request: IdentifyRequest, options: IdentifyOptions) -> Reference | None:
    """Read the earlier result that logs are compared with; None where they are compared with none."""
    name = options.reference
    if name is None or name == PRIOR:
        return None
    decided = [one for one in ("terms", "smooth_coulomb") if options.given.get(one)]
    if decided or request.reference is None:
        raise OptionError(
            f"the reference {name} decides the model's {' and '.join(decided)}"
            if decided
            else f"the result of the reference {name} is not at hand",
            evidence={"reference": name, "given": decided},
            remedy="leave these options out" if decided else "name a finished job",
        )
    return reference_from_document(request.reference, request.robot, name)


def diagnose(request: IdentifyRequest, progress: Progress | None = None) -> dict[str, object]:
    """Identify a robot, name what the model misses, extend it, and give the result document.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way, with cause, evidence and remedy.
    """
    found = diagnose_in_full(request, progress)
    write_traces(request.traces, found.before, found)
    options = parse_diagnose_options(request.options).given
    return diagnosis_document(found, version=_version(), options=options)


def diagnose_in_full(request: IdentifyRequest, progress: Progress | None = None) -> Diagnosed:
    """Identify, diagnose, extend and identify again; give every chapter's result."""
    tell = progress or _say_nothing
    options = parse_diagnose_options(request.options)
    reference = _earlier(request, options)
    data, base = _prepared(request, options, tell, reference)
    if options.reference == PRIOR:
        reference = reference_from_prior(base)
    before = _identified(request, options, _Fitting(data, base), lambda stage, done: tell(stage, 0.3 * done))
    question = Question(data.plan, request.logs, data.held_out, options.validation.blocks, reference)
    found = find_causes(question, lambda stage, done: tell(stage, 0.3 + 0.5 * done))
    as_it_is = None if reference is None else compared(reference, before, data.parts(before.observation))
    terms = cures(found)
    if not terms:
        return Diagnosed(before, found, None, (), None, "nothing joined the model", as_it_is)
    whole = extended_base(base, terms)
    wider = Measured(ColumnPlan(whole.model, whole.kept), data.motions, data.held_out)
    fitting = _Fitting(wider, whole, sizes(found), None if reference is None else reference.belief)
    try:
        after = _identified(request, options, fitting, lambda stage, done: tell(stage, 0.8 + 0.15 * done))
    except SolverError as error:  # what was found stands, whether or not the cure can be computed
        note = f"the extended model could not be identified: {error.cause}"
        return Diagnosed(before, found, None, (), None, note, as_it_is)
    tell("simulate", 0.95)
    held = data.parts(before.observation)[1]
    old = before.estimate if as_it_is is None else as_it_is
    gained = gains((before.observation, old.base), (after.observation, after.estimate.base), held)
    motion, note = _motion((base.model, old.standard), after, found, data)
    return Diagnosed(before, found, after, gained, motion, note, as_it_is)


def _motion(
    before: tuple[DynamicModel, Parameters], after: Identification, found: Diagnosis, data: Measured
) -> tuple[Comparison | None, str]:
    """Simulate the held-out blocks with both models, and say which findings are not part of the motion."""
    try:
        old, new = (mechanism_of(*one) for one in (before, folded(after.base.model, after.estimate.standard)))
        return compare(old, new, data.motions, chosen=data.held_out or None), taken_along(found)
    except VeritorqueError as error:
        return None, str(error)


def _prepared(
    request: IdentifyRequest, options: IdentifyOptions, tell: Progress, reference: Reference | None = None
) -> tuple[Measured, BaseModel]:
    """Condition the logs, set blocks aside, and group the model's parameters; a reference has its own."""
    tell("condition", 0.02)
    model = standard_model(request.robot, options.terms) if reference is None else reference.base.model
    admit(options, model, [known_log(log) for log in request.logs])
    motions = condition_all(request.logs, request.robot, options.filter, blocks=options.validation.blocks)
    held_out = options.validation.chosen(len(motions))
    if reference is None and options.smooth_coulomb:
        model = smoothed(model, motions, held_out, lambda done: tell("smooth", 0.05 + 0.25 * done))
    base = base_model(model) if reference is None else reference.base
    return Measured(ColumnPlan(model, base.kept), motions, held_out), base


def _identified(
    request: IdentifyRequest, options: IdentifyOptions, fitting: "_Fitting", tell: Progress
) -> Identification:
    """Fit one model and judge it."""
    data, base, model = fitting.data, fitting.base, fitting.base.model
    observation = data.observed(lambda done: tell("observe", 0.3 + 0.3 * done))
    tell("estimate", 0.6)
    used, system = weighted_system(data, observation, options.estimate)
    known = fitting.belief
    inform = _unchanged if known is None else lambda plain: plain.informed(known.rows, known.target)
    system = inform(system)
    fitted, held = data.parts(observation)
    prior = default_prior(model, torque_scales(observation, fitted), fitting.sizes)
    answer = estimate(base, system, prior, options.estimate)
    tell("assess", 0.7)
    precision = assess(
        system, used.memory, used.columns_of, answer.base, known=None if known is None else known.rows
    )
    essential = essential_parameters(system, precision)
    if options.essential:
        answer = estimate(base, system, prior, options.estimate, essential=essential.kept)
    draws = bootstrap(
        system,
        tuple(used.blocks[index] for index in fitted),
        used.columns_of,
        lambda drawn: (
            estimate(
                base,
                inform(drawn),
                prior,
                options.estimate,
                essential=essential.kept if options.essential else None,
            ).base
        ),
        draws=options.bootstrap.draws,
        seed=options.bootstrap.seed,
    )
    tell("validate", 0.9)
    return Identification(
        logs=request.logs,
        motions=data.motions,
        base=base,
        observation=observation,
        estimate=answer,
        precision=precision,
        essential=essential,
        draws=draws,
        fit=scores(observation, fitted, answer.base),
        fit_total_percent=total_percent(observation, fitted, answer.base),
        validation=scores(observation, held, answer.base) if held else (),
        validation_total_percent=total_percent(observation, held, answer.base) if held else 0.0,
        excitation=excitation(system.triangle),
        unconstrained_feasibility=feasibility(base, answer.unconstrained, prior),
        estimate_feasibility=feasibility(base, base.base_of(answer.standard), prior),
        pseudo_inertia_eigenvalues=pseudo_inertia_eigenvalues(model, answer.standard),
        active_constraints=active_constraints(model, answer.standard, prior, options.estimate.bounds),
        trajectory=check_mass_matrix(model, answer.standard, observation.positions),
        workspace=check_mass_matrix(model, answer.standard, workspace(request.robot)),
        widths=next((term.widths for term in model.terms if term.name == "coulomb"), ()),  # type: ignore[attr-defined]  # Coulomb friction alone has them
        seed=options.bootstrap.seed,
        held_out=data.held_out,
    )


def base_parameters(robot: RobotModel) -> dict[str, object]:
    """Give the base parameters that a robot's structure allows, with their groupings."""
    base = base_model(standard_model(robot))
    rows = [grouping_row(base, row) for row in range(len(base.kept))]
    counts = {"standard": len(base.model.parameters), "base": len(base.kept)}
    without = [base.model.parameters[column].name for column in base.without_effect]
    document = {"counts": counts, "base_parameters": rows, "without_effect": without}
    return {key: plain(value) for key, value in document.items()}


@dataclass(frozen=True, eq=False)
class _Fitting:
    """Hold a model to be fitted: the data, its base parameters, and what is known otherwise."""

    data: Measured
    base: BaseModel
    sizes: Mapping[str, float] = field(default_factory=dict)
    belief: Belief | None = None


def _unchanged(system: System) -> System:
    return system


def _say_nothing(_stage: str, _fraction: float) -> None:
    pass


def _version() -> str:
    try:
        return version("veritorque")
    except PackageNotFoundError:
        return "0.1.0"
