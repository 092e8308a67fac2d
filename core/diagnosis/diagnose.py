"""Diagnose what a simulation gets wrong: the algorithm from the data set to the verdict, on one page.

The search names causes. Each is then compared with its alternatives, measured on held-out rows, and shown
over the coordinate that explains it. A generic learner predicts how much is left to explain.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ..arrays import JointSeries
from .causes.registry import AGAINST_REFERENCE, CAUSES
from .checks.alternatives import Comparison, compare_alternatives
from .checks.between_logs import BetweenLogs
from .checks.bursts import burst
from .checks.change_points import switching_candidates
from .checks.findings import finding
from .checks.holdout_outliers import has_holdout_outliers, with_other_holdout
from .checks.instruments import Instruments
from .checks.kurtosis import bounded_residual
from .checks.lack_of_fit import best_unnamed_pattern, unnamed_candidates
from .checks.lagging_reference import beside_reference, lagging_reference
from .checks.reservations import beside_dead_zones, beside_mixed_channels, beside_unknown_signs
from .checks.samples import check_samples, dataset_of
from .checks.smoothed_channels import beside_smoothing
from .checks.spring_resonance import beside_what_swings
from .checks.structure_left import StructureLeft, nothing_beside_structure
from .checks.unnamed_pattern import mixes_channels
from .dataset.dataset import later_torque
from .dataset.refusals import refuse_too_little
from .problem import DiagnosisProblem
from .residual.atlas import atlas
from .residual.learner import Predictable, predictable_share
from .result import Diagnosis, Finding, NotIdentifiable, UnnamedPattern, Verdict
from .search.alignment import restart_from_alignment
from .search.fitter import HypothesisFitter
from .search.hypothesis import Candidate
from .search.likelihood_ratio import likelihood_ratio, log_p
from .search.motion_band import drop_what_motion_does_not_show
from .search.residuals import residual, stiction_share
from .search.restarts import explains_more, restart_at_operating_point, restart_from_common_cause
from .search.state import SearchState
from .search.stepwise import confirm, continue_search, search_stepwise
from .thresholds.checks import VERDICT

Progress = Callable[[str, float], None]


def diagnose(problem: DiagnosisProblem, progress: Progress | None = None) -> Diagnosis:
    """Name what the model does not explain.

    Raises
    ------
    ExcitationError
        If the logs hold too little motion for a fit.
    """
    tell = progress or _no_progress
    problem, faults, plain = check_samples(problem)
    refuse_too_little(plain.dataset, problem.plan)
    found = _search_causes(_with_causes(problem, plain), tell)
    found = restart_from_alignment(found, partial(later_torque, plain.dataset))
    found = drop_what_motion_does_not_show(found, partial(dataset_of, problem))
    tell("compare alternatives", 0.6)
    lagging = lagging_reference(found)
    found, comparisons = compare(found)
    fitter, chosen, dataset = found.fitter, found.chosen, found.fitter.dataset
    after = residual(fitter, chosen)
    unnamed = _unnamed_pattern(found, after)
    statistic = 0.0 if unnamed is None else unnamed.statistic
    unnamed = _most_significant(unnamed, burst(dataset, after))
    checks = Instruments(fitter, chosen), StructureLeft(fitter, chosen)
    logs = BetweenLogs(fitter, chosen)
    named = [finding(found, own, after, statistic, checks, logs) for own in comparisons]
    findings = beside_dead_zones([*named, *faults], restored=bool(problem.zones))
    findings = beside_reference(findings, lagging)
    most = max((own.statistic for own in comparisons), default=0.0)
    findings = beside_mixed_channels(findings, unnamed, most)
    findings = beside_unknown_signs(findings, dataset)
    findings = beside_smoothing(findings, fitter, chosen)
    findings, swings = beside_what_swings(findings)
    doubted = any((lagging, swings, nothing_beside_structure(findings)))
    tell("predict the residual", 0.8)
    noise = tuple(joint.noise for joint in chosen.fit.joints)
    predictable = predictable_share(dataset, after, fitter.operating_point, noise)
    tell("prepare figures", 0.95)
    return Diagnosis(
        verdict="unexplained" if doubted else _verdict(findings, predictable, unnamed, most),
        findings=tuple(sorted(findings, key=lambda finding: finding.p_value)),
        not_identifiable=_not_identifiable(found),
        predictable=predictable,
        unnamed_pattern=lagging or unnamed,
        atlas=atlas(dataset, after, fitter.operating_point, noise),
        dataset=dataset,
        operating_point=fitter.operating_point,
        none=found.none,
        chosen=chosen,
        steps=found.steps,
        residual_after=after,
        at_rest=stiction_share(fitter, chosen),
    )


def _with_causes(problem: DiagnosisProblem, plain: HypothesisFitter) -> HypothesisFitter:
    """Give a fitter all candidate causes, and the prior that a reference gives."""
    reference = problem.reference
    causes, prior = (CAUSES, None) if reference is None else (AGAINST_REFERENCE, reference.prior)
    return plain.with_causes(causes, prior)


def _search_causes(fitter: HypothesisFitter, tell: Progress) -> SearchState:
    """Search for causes, and again with other blocks held out where a held-out block is an outlier."""

    def progress(done: float) -> None:
        tell("search", 0.1 + 0.5 * done)

    progress(0.0)
    found = _search(fitter, progress)
    if has_holdout_outliers(found.fitter, found.chosen):
        other = with_other_holdout(fitter.dataset)
        if other is not None:
            more = _search(found.fitter.with_dataset(other), progress, found.chosen.members)
            if more.chosen.members and not has_holdout_outliers(more.fitter, more.chosen):
                return more
    return found


def _search(
    fitter: HypothesisFitter, progress: Callable[[float], None], start: Sequence[Candidate] = ()
) -> SearchState:
    """Search; and again under noise of ordinary residuals where too much is left to the noise."""
    found = search_stepwise(fitter, progress, start)
    if not found.fitter.needs_ordinary_noise(found.chosen):
        found = restart_from_common_cause(found)
    if found.fitter.needs_ordinary_noise(found.chosen):
        ordinary = found.fitter.with_ordinary_noise()
        again = confirm(ordinary, found, progress) or search_stepwise(ordinary, progress, start)
        found = restart_from_common_cause(again)
    return restart_at_operating_point(found)


def compare(found: SearchState) -> tuple[SearchState, list[Comparison]]:
    """Keep the causes that pass the comparison, and search for those that the dropped ones excluded.

    What is found so has to pass it, too, and what is left of it has to explain more than what was kept.
    """
    kept, comparisons = compare_alternatives(found)
    if len(kept.excluded) > len(found.excluded):
        more = continue_search(kept)
        if len(more.chosen.members) > len(kept.chosen.members):
            after, again = compare_alternatives(more)
            if explains_more(after, kept):
                return after, again
        # What follows is linearised where that search ended.
        kept = replace(kept, fitter=more.fitter)
    return kept, comparisons


def _not_identifiable(found: SearchState) -> tuple[NotIdentifiable, ...]:
    """List the kinds whose columns the fitted model spans, cause by cause with all such joints."""
    open_sites: dict[str, list[int]] = {}
    by_id = {cause.id: cause for cause in found.fitter.causes}
    for scored in found.fitter.scan(found.none):
        if not scored.identifiable:
            open_sites.setdefault(scored.candidate.cause.id, []).extend(scored.candidate.site)
    return tuple(
        NotIdentifiable(
            name,
            tuple(sorted(set(joints))),
            "in this motion the parameters of the standard model absorb it",
            by_id[name].experiment,
        )
        for name, joints in sorted(open_sites.items())
    )


def _unnamed_pattern(found: SearchState, left: JointSeries) -> UnnamedPattern | None:
    """Give the clearest pattern that the residual follows and no listed cause has."""
    patterns = (unnamed_candidates(found.fitter), switching_candidates(found.fitter, found.chosen, left))
    fitted = [_fit_pattern(found, candidates) for candidates in patterns]
    return _most_significant(*fitted, bounded_residual(found.fitter.dataset, left))


def _most_significant(*patterns: UnnamedPattern | None) -> UnnamedPattern | None:
    present = (pattern for pattern in patterns if pattern is not None)
    return max(present, key=lambda pattern: pattern.statistic, default=None)


def _fit_pattern(found: SearchState, candidates: tuple[Candidate, ...]) -> UnnamedPattern | None:
    larger = best_unnamed_pattern(found.fitter, found.chosen, candidates)
    if larger is None:
        return None
    last, dataset = larger.members[-1], found.fitter.dataset
    log_p_value = log_p(found.chosen, larger) + float(np.log(dataset.joints))
    return UnnamedPattern(
        joint=last.site[0],
        statement=last.cause.statement(larger.in_joint_units(len(larger.members) - 1, dataset.robot)),
        statistic=likelihood_ratio(found.chosen, larger),
        log10_p=log_p_value / float(np.log(10.0)),
        mixes_channels=mixes_channels(last.scalars),
    )


def _verdict(
    findings: Sequence[Finding],
    predictable: Sequence[Predictable],
    unnamed: UnnamedPattern | None,
    most: float,
) -> Verdict:
    """Give `unexplained` where the unexplained part exceeds what the causes found explain.

    Faulty samples leave patterns, too: joints where a sample check explains a part do not count.
    """
    if unnamed is not None and unnamed.statistic > most and unnamed.joint not in _faulty_joints(findings):
        return "unexplained"
    left = [joint for joint in predictable if joint.interval[0] > VERDICT.unexplained_share]
    if _exceeds_findings(left, findings):
        return "unexplained"
    return "causes_found" if findings else "nothing_found"


def _exceeds_findings(left: Sequence[Predictable], findings: Sequence[Finding]) -> bool:
    """Tell whether what is predictable on some joint is more than the findings explain there."""
    if not findings:
        return bool(left)
    explained = {joint: finding.explained_fraction for finding in findings for joint in finding.joints}
    return any(joint.share > explained.get(joint.joint, 0.0) for joint in left)


def _faulty_joints(findings: Sequence[Finding]) -> set[int]:
    """Give the joints on which a sample check explains a part."""
    checks = (finding for finding in findings if finding.member is None)
    return {
        joint
        for finding in checks
        if finding.explained_fraction > VERDICT.unexplained_share
        for joint in finding.joints
    }


def _no_progress(_stage: str, _fraction: float) -> None:
    pass
