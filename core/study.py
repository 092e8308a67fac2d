"""Tell the whole story on one page: from logs to a robot that can exist, and how far it is to be believed.

This is the only module that meets every chapter; each step takes what the step before gave.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version

from core.diagnosis.diagnosis import Diagnosis
from core.diagnosis.verdict import Question
from core.diagnosis.verdict import diagnose as find_causes
from core.dynamics.model import standard_model
from core.errors import LogError, VeritorqueError
from core.estimate.constraints import default_prior
from core.estimate.estimate import estimate
from core.estimate.feasibility import active_constraints, feasibility
from core.estimate.measured import Measured, smoothed, weighted_system
from core.extension.extend import cures, extended_base, remembers
from core.extension.gain import gains
from core.log.model import JointLog
from core.options import IdentifyOptions, parse_diagnose_options, parse_options
from core.precision.bootstrap import bootstrap
from core.precision.covariance import assess
from core.precision.essential import essential_parameters
from core.reduction.base import BaseModel, base_model
from core.regressor.columns import ColumnPlan
from core.regressor.observe import torque_scales
from core.report.diagnosed import Diagnosed
from core.report.document import grouping_row, identification_document
from core.report.identification import Identification
from core.report.numbers import plain
from core.robot.model import RobotModel
from core.signals.condition import Motion, condition
from core.simulation.mechanism import mechanism_of
from core.simulation.multistep import Comparison, compare
from core.validation.excitation import excitation
from core.validation.mass_matrix import check_mass_matrix, pseudo_inertia_eigenvalues, workspace
from core.validation.scores import scores, total_percent

Progress = Callable[[str, float], None]

__all__ = ["IdentifyRequest", "base_parameters", "identify", "identify_in_full", "parse_options"]


@dataclass(frozen=True, eq=False)
class IdentifyRequest:
    """Ask for an identification: a robot, its logs, and options as plain data (see `core.options`)."""

    robot: RobotModel
    logs: tuple[JointLog, ...]
    options: Mapping[str, object] = field(default_factory=dict)


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
    return identification_document(found, version=_version(), options=parse_options(request.options).given)


def identify_in_full(request: IdentifyRequest, progress: Progress | None = None) -> Identification:
    """Identify a robot and give every chapter's result."""
    tell = progress or _say_nothing
    options = parse_options(request.options)
    data, base = _prepared(request, options, tell)
    return _identified(request, options, _Fitting(data, base), tell)


def diagnose(request: IdentifyRequest, progress: Progress | None = None) -> dict[str, object]:
    """Identify a robot, name what the model misses, extend it, and give the result document.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way, with cause, evidence and remedy.
    """
    found = diagnose_in_full(request, progress)
    options = parse_diagnose_options(request.options).given
    from core.report.diagnosis_document import diagnosis_document

    return diagnosis_document(found, version=_version(), options=options)


def diagnose_in_full(request: IdentifyRequest, progress: Progress | None = None) -> Diagnosed:
    """Identify, diagnose, extend and identify again; give every chapter's result."""
    tell = progress or _say_nothing
    options = parse_diagnose_options(request.options)
    data, base = _prepared(request, options, tell)
    before = _identified(request, options, _Fitting(data, base), lambda stage, done: tell(stage, 0.3 * done))
    question = Question(data.plan, request.logs, data.held_out, options.validation.blocks)
    found = find_causes(question, lambda stage, done: tell(stage, 0.3 + 0.5 * done))
    terms = cures(found)
    if not terms:
        return Diagnosed(before, found, None, (), None, "nothing joined the model")
    whole = extended_base(base, terms)
    wider = Measured(ColumnPlan(whole.model, whole.kept), data.motions, data.held_out)
    sizes = {
        f"{one.name}{one.joint}": 10.0 * abs(one.value)
        for finding in found.findings
        for one in finding.quantities
    }
    after = _identified(
        request, options, _Fitting(wider, whole, sizes), lambda stage, done: tell(stage, 0.8 + 0.15 * done)
    )
    tell("simulate", 0.95)
    held = data.parts(before.observation)[1]
    gained = gains((before.observation, before.estimate.base), (after.observation, after.estimate.base), held)
    motion, note = _motion(before, after, found, data)
    return Diagnosed(before, found, after, gained, motion, note)


def _motion(
    before: Identification, after: Identification, found: Diagnosis, data: Measured
) -> tuple[Comparison | None, str]:
    """Simulate the held-out blocks with both models, where neither needs the past."""
    if any(remembers(one, found) for one in found.findings):
        return None, "a finding's torque depends on the motion before the instant, which is not simulated"
    try:
        old, new = (mechanism_of(one.base.model, one.estimate.standard) for one in (before, after))
        return compare(old, new, data.motions, chosen=data.held_out or None), ""
    except VeritorqueError as error:
        return None, str(error)


def _prepared(
    request: IdentifyRequest, options: IdentifyOptions, tell: Progress
) -> tuple[Measured, BaseModel]:
    """Condition the logs, set blocks aside, and group the model's parameters."""
    _check_logs(request.logs)
    tell("condition", 0.02)
    motions = _condition(request, options)
    held_out = options.validation.chosen(len(motions))
    model = standard_model(request.robot, options.terms)
    if options.smooth_coulomb:
        model = smoothed(model, motions, held_out, lambda done: tell("smooth", 0.05 + 0.25 * done))
    base = base_model(model)
    return Measured(ColumnPlan(model, base.kept), motions, held_out), base


def _identified(
    request: IdentifyRequest, options: IdentifyOptions, fitting: "_Fitting", tell: Progress
) -> Identification:
    """Fit one model and judge it."""
    data, base, model = fitting.data, fitting.base, fitting.base.model
    observation = data.observed(lambda done: tell("observe", 0.3 + 0.3 * done))
    tell("estimate", 0.6)
    used, system = weighted_system(data, observation, options.estimate)
    fitted, held = data.parts(observation)
    prior = default_prior(model, torque_scales(observation, fitted), fitting.sizes)
    answer = estimate(base, system, prior, options.estimate)
    tell("assess", 0.7)
    precision = assess(system, used.memory, used.columns_of, answer.base)
    essential = essential_parameters(system, precision)
    if options.essential:
        answer = estimate(base, system, prior, options.estimate, essential=essential.kept)
    draws = bootstrap(
        system,
        tuple(used.blocks[index] for index in fitted),
        used.columns_of,
        lambda drawn: (
            estimate(
                base, drawn, prior, options.estimate, essential=essential.kept if options.essential else None
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
        widths=next((term.widths for term in model.terms if term.name == "coulomb"), ()),  # type: ignore[attr-defined]
        seed=options.bootstrap.seed,
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
    """Hold a model to be fitted: the data, its base parameters, and sizes known otherwise."""

    data: Measured
    base: BaseModel
    sizes: Mapping[str, float] = field(default_factory=dict)


def _check_logs(logs: tuple[JointLog, ...]) -> None:
    if not logs:
        raise LogError("there is no log to identify from", evidence={"logs": 0}, remedy="name at least one")
    hashes = [log.sha256 for log in logs if log.sha256]
    if len(set(hashes)) < len(hashes):
        raise LogError(
            "the same log is given more than once, and would count as independent data",
            evidence={"logs": [log.name for log in logs], "different": len(set(hashes))},
            remedy="name every log once",
        )


def _condition(request: IdentifyRequest, options: IdentifyOptions) -> tuple[Motion, ...]:
    motions = []
    for log in request.logs:
        try:
            motions.append(condition(log, request.robot, options.filter, blocks=options.validation.blocks))
        except VeritorqueError as error:
            error.evidence.setdefault("log", log.name)
            raise
    return tuple(motions)


def _say_nothing(_stage: str, _fraction: float) -> None:
    pass


def _version() -> str:
    try:
        return version("veritorque")
    except PackageNotFoundError:
        return "0.1.0"
