"""Run the whole computation, on one page: from logs to a consistent robot, and how well it is known.

This is the only module that meets every chapter; each step takes what the step before gave. What only a
diagnosis needs, which is half of all modules, is loaded by the first one.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from .conflicts.check import Conflicts, check
from .conflicts.doubt import is_doubtful, is_worse_than_none
from .document.conflicts import because_of, conflict_rows, with_conflicts
from .document.identification import identification_document
from .document.version import product_version
from .dynamics.model import standard_model
from .errors import OptionError, SolverError
from .estimate.problem import Problem
from .estimate.smoothing import with_smoothed_friction
from .identification.admission import admit, known_log
from .identification.contradictions import contradictions
from .identification.flexible_band import check_moved
from .identification.identify import Fit, Progress, fit, judge, no_progress, refitted, scaled_progress
from .identification.options import REPORT, IdentifyOptions, parse_diagnose_options, parse_options
from .identification.reference import PRIOR, Reference, reference_from_prior
from .identification.reference_score import score_reference
from .identification.result import Identification
from .log.columns.assignment import assigned
from .log.model import JointLog
from .numerics.mapping import SERIAL, Mapper
from .numerics.threads import on_one_thread
from .reduction.base import base_model
from .report.traces.writing import write_traces
from .robot.model import RobotModel
from .signals.several import condition_all

if TYPE_CHECKING:
    from .diagnosis.result import Diagnosis
    from .extension.result import Extension

__all__ = ["IdentifyRequest", "identify", "identify_in_full", "parse_options"]


@dataclass(frozen=True, eq=False)
class IdentifyRequest:
    """Ask for an identification: a robot, its logs, and options as plain data.

    The options are those of `core.identification.options`.

    `reference` is the result document of the job that the option of that name means, where it means one;
    `traces` the file to write motion, torque and residual to, where they are wanted; `mapper`
    runs fits that do not depend on each other.
    """

    robot: RobotModel
    logs: tuple[JointLog, ...]
    options: Mapping[str, object] = field(default_factory=dict)
    reference: Mapping[str, object] | None = None
    traces: Path | None = None
    mapper: Mapper = SERIAL


@dataclass(frozen=True, eq=False)
class _Task:
    """Hold a request with its options read."""

    asked: IdentifyRequest
    options: IdentifyOptions


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
    task = _Task(request, parse_options(request.options))
    found, conflicts = _identify(task, progress or no_progress)
    write_traces(task.asked.traces, found)
    document = identification_document(found, version=product_version(), options=task.options.given)
    return with_conflicts(document, conflict_rows(conflicts, request.robot, request.logs))


def identify_in_full(request: IdentifyRequest, progress: Progress | None = None) -> Identification:
    """Identify a robot and give every chapter's result."""
    return identify_with_conflicts(request, progress)[0]


def identify_with_conflicts(
    request: IdentifyRequest, progress: Progress | None = None, *, doubted: bool = False
) -> tuple[Identification, Conflicts]:
    """Identify a robot and give every chapter's result, and what was found to disagree.

    Parameters
    ----------
    doubted
        Whether to look for conflicts even where nothing gives reason to.
    """
    return _identify(_Task(request, parse_options(request.options)), progress or no_progress, doubted=doubted)


@on_one_thread()
def _identify(task: _Task, tell: Progress, *, doubted: bool = False) -> tuple[Identification, Conflicts]:
    settled = _settle(task, tell, doubted=doubted)
    asked = settled.task.asked
    return judge(asked.logs, settled.fit, tell, asked.mapper), settled.conflicts


@dataclass(frozen=True, eq=False)
class _Settled:
    """Hold a task whose conflicts are corrected, and its fit."""

    task: _Task
    fit: Fit
    conflicts: Conflicts


def _settle(
    task: _Task, tell: Progress, reference: Reference | None = None, *, doubted: bool = False
) -> _Settled:
    """Fit by least squares, correct conflicts, which may hide a controller, then fit as asked."""
    problem, logs = _prepare(task, tell, reference), task.asked.logs
    try:
        first = fit(problem, task.options.least_squares, tell)
    except (OptionError, SolverError) as error:
        conflicts, corrected = _corrected(task, problem, tell, reference, doubted=True)
        if corrected is None:
            raise because_of(conflict_rows(conflicts, task.asked.robot, logs), error) from None
        return corrected
    doubted = doubted or is_doubtful(first, logs)
    conflicts, corrected = _corrected(task, problem, tell, reference, doubted=doubted)
    return corrected or _Settled(task, refitted(problem, task.options, tell, first), conflicts)


def _corrected(
    task: _Task, problem: Problem, tell: Progress, reference: Reference | None = None, *, doubted: bool
) -> tuple[Conflicts, _Settled | None]:
    """Correct what robot and logs disagree in, and fit again; None if nothing, or against a reference."""
    asked, options = task.asked, task.options
    tell("check", 0.62)
    conflicts = check(problem, asked.logs, options.terms, doubted=doubted)
    setup = conflicts.setup
    if setup is None or reference is not None or options.conflicts == REPORT:
        return conflicts, None
    logs = tuple(assigned(log, setup.assignment) for log in asked.logs)
    corrected = replace(task, asked=replace(asked, robot=setup.robot, logs=logs))

    def correct(_stage: str, done: float) -> None:
        tell("correct", 0.63 + 0.05 * done)

    again = fit(_prepare(corrected, correct), options, correct)
    if is_worse_than_none(again):
        return conflicts.as_unsure, None
    return conflicts, _Settled(corrected, again, replace(conflicts, applied=True))


def check_reference(request: IdentifyRequest) -> None:
    """Refuse a reference that a robot's logs cannot be compared with; logs are not read.

    Raises
    ------
    OptionError
        If it is the result of another robot's log, or options are given that it decides.
    RobotError
        If the robot's own bodies are to be compared with and it brings none.
    """
    task = _Task(request, parse_diagnose_options(request.options))
    _read_reference(task)
    if task.options.reference == PRIOR:
        reference_from_prior(base_model(standard_model(task.asked.robot, task.options.terms)))


def _read_reference(task: _Task) -> Reference | None:
    """Read the earlier result that logs are compared with; None where they are compared with none."""
    options, name = task.options, task.options.reference
    if name is None or name == PRIOR:
        return None
    decided = [option for option in ("terms", "smooth_coulomb") if options.given.get(option)]
    if decided or task.asked.reference is None:
        cause, remedy = (
            (f"the reference {name} decides the model's {' and '.join(decided)}", "leave these options out")
            if decided
            else (f"the result of the reference {name} is not at hand", "name a finished job")
        )
        raise OptionError(cause, evidence={"reference": name, "given": decided}, remedy=remedy)
    from .document.model.reference import reference_from_document

    return reference_from_document(task.asked.reference, task.asked.robot, name)


def diagnose(request: IdentifyRequest, progress: Progress | None = None) -> dict[str, object]:
    """Identify a robot, name what the model misses, extend it, and give the result document.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way, with cause, evidence and remedy.
    """
    from .document.diagnosis import diagnosis_document

    task = _Task(request, parse_diagnose_options(request.options))
    found, conflicts = _diagnose(task, progress or no_progress)
    write_traces(task.asked.traces, found.before, found)
    document = diagnosis_document(found, version=product_version(), options=task.options.given)
    return with_conflicts(document, conflict_rows(conflicts, request.robot, request.logs))


def diagnose_in_full(request: IdentifyRequest, progress: Progress | None = None) -> "Extension":
    """Identify, diagnose, extend and identify again; give every chapter's result."""
    return _diagnose(_Task(request, parse_diagnose_options(request.options)), progress or no_progress)[0]


@on_one_thread()
def _diagnose(task: _Task, tell: Progress) -> "tuple[Extension, Conflicts]":
    reference = _read_reference(task)
    first = scaled_progress(tell, 0.0, 0.3)
    settled = _settle(task, first, reference)
    if task.options.reference == PRIOR:
        reference = reference_from_prior(settled.fit.problem.base)
    before, found = _judge_and_search(settled, reference, first, scaled_progress(tell, 0.3, 0.5))
    if found.verdict != "nothing_found" and not settled.conflicts.searched and reference is None:
        # What a wrong set-up leaves, as little as it may be on an arm of two joints, resembles a cause.
        still = scaled_progress(tell, 0.78, 0.0)
        conflicts, corrected = _corrected(task, settled.fit.problem, still, doubted=True)
        settled = corrected or replace(settled, conflicts=conflicts)
        if corrected is not None:
            before, found = _judge_and_search(settled, reference, still, still)
    return _explain(settled, before, found, reference, tell), settled.conflicts


def _judge_and_search(
    settled: _Settled, reference: Reference | None, first: Progress, then: Progress
) -> "tuple[Identification, Diagnosis]":
    """Judge a fit, and find the causes of what it leaves."""
    from .diagnosis.diagnose import diagnose as find_causes
    from .diagnosis.problem import DiagnosisProblem

    asked, options, problem = settled.task.asked, settled.task.options, settled.fit.problem
    before = judge(asked.logs, settled.fit, first, asked.mapper)
    question = DiagnosisProblem(
        problem.plan, asked.logs, problem.held_out, options.validation.blocks, reference
    )
    return before, find_causes(question, then)


def _explain(
    settled: _Settled, before: Identification, found: "Diagnosis", reference: Reference | None, tell: Progress
) -> "Extension":
    """Extend the model by the causes that were found, and measure what that gains."""
    from .diagnosis.checks.reservations import SetupDoubts, with_reservations
    from .extension import cure, extend, measure, reserved, result

    task, problem, options = settled.task, settled.fit.problem, settled.task.options
    last = scaled_progress(tell, 0.8, 0.15)
    conflicts, doubted = settled.conflicts, bool(contradictions(before))
    doubts = SetupDoubts(
        conflicts.is_open, conflicts.doubtful_causes, conflicts.promising, conflicts.confidence
    )
    found = with_reservations(found, doubts, doubted=doubted)
    plain = problem if reference is None else replace(problem, prior=reference.prior)
    found, proof = extend.verified(found, options, plain, lambda: tell("verify", 0.78))
    parts = before.observation.parts(problem.held_out)
    as_it_is = None if reference is None else score_reference(reference, before, parts)
    without = result.Extension(before, found, None, (), None, "no finding entered the model", as_it_is)
    if not cure.corrections(found):
        return reserved.reserved(without)
    try:
        extended = proof or fit(extend.extend(found, plain), options, last)
        after = judge(task.asked.logs, extended, last, task.asked.mapper)
    except SolverError as error:  # what was found stands, whether or not the correction can be computed
        note = f"the extended model could not be identified: {error.cause}"
        return reserved.reserved(replace(without, motion_note=note))
    tell("simulate", 0.95)
    return reserved.reserved(measure.measure_gains(without, after, problem))


def _prepare(task: _Task, tell: Progress, reference: Reference | None = None) -> Problem:
    """Condition the logs, set blocks aside, and group the model's parameters; a reference has its own."""
    tell("condition", 0.02)
    asked, options = task.asked, task.options
    model = standard_model(asked.robot, options.terms) if reference is None else reference.base.model
    admit(options, model, [known_log(log) for log in asked.logs])
    motions = condition_all(asked.logs, asked.robot, options.filter, blocks=options.validation.blocks)
    check_moved(motions, options.estimate.flexible_joints)
    held_out = options.validation.chosen(len(motions))
    if reference is None and options.smooth_coulomb:
        model = with_smoothed_friction(
            model, motions, held_out, lambda done: tell("smooth", 0.05 + 0.25 * done)
        )
    base = base_model(model) if reference is None else reference.base
    return Problem(base, motions, held_out)
