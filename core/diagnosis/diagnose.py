"""Decide what a simulation gets wrong, and say how sure that is.

The search names causes; every one of them then meets its rivals, is measured on rows that no fit has seen,
and is shown over the coordinate that explains it. A generic learner says what is left to explain.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arrays import BlockKey, JointSeries
from ..dynamics.model import DynamicModel
from ..identification.reference import Reference
from ..log.model import JointLog
from ..regressor.columns import ColumnPlan
from .bandwidth import Fitted, limit_bandwidth
from .causes.registry import AGAINST_REFERENCE, CAUSES, SAMPLE_CHECKS
from .checks.alternatives import Comparison, compare_alternatives
from .checks.bursts import burst
from .checks.change_points import switching_candidates
from .checks.findings import finding, sample_finding
from .checks.holdout_outliers import Explained, has_holdout_outliers, with_other_holdout, with_typical_holdout
from .checks.kurtosis import bounded_residual
from .checks.lack_of_fit import best_unnamed_pattern, unnamed_candidates
from .dataset.dataset import Dataset, build_dataset
from .residual.atlas import atlas
from .residual.learner import Predictable, predictable_share, refuse_too_little
from .result import Diagnosis, Finding, NotIdentifiable, UnnamedPattern, Verdict
from .search.fitter import HypothesisFitter
from .search.hypothesis import Candidate
from .search.likelihood_ratio import likelihood_ratio, log_p
from .search.restarts import restart_at_operating_point, restart_from_common_cause
from .search.stepwise import Selection, confirm, continue_search, search_stepwise

Progress = Callable[[str, float], None]
OPEN = 1e-3
"""A candidate of whose columns the model spans all but this share cannot be shown by this motion."""
UNEXPLAINED_SHARE = 0.03
"""Least share of a joint's residual that must be predictable, with its interval, to be called structure."""


@dataclass(frozen=True, eq=False)
class DiagnosisProblem:
    """Ask what is missing from a model, or what has changed since a reference.

    Attributes
    ----------
    plan
        The model and its base columns.
    held_out, blocks
        Blocks of every log that no fit may see, and how many blocks a log has.
    reference
        What the logs are compared with; None to identify the model from the logs first.
    """

    plan: ColumnPlan
    logs: tuple[JointLog, ...]
    held_out: frozenset[BlockKey]
    blocks: int
    reference: Reference | None = None

    @property
    def model(self) -> DynamicModel:
        """Give the model."""
        return self.plan.model


def diagnose(question: DiagnosisProblem, progress: Progress | None = None) -> Diagnosis:
    """Name what the model does not explain.

    Raises
    ------
    ExcitationError
        If the logs are too short to hold anything out.
    """
    tell = progress or _say_nothing
    raw, dataset = _looked(question)
    refuse_too_little(dataset.clear)
    fitter, searched = _searched(question, dataset, tell)
    dataset = fitter.dataset
    tell("compare alternatives", 0.6)
    selection, comparisons = _weighed(fitter, searched)
    chosen, everyone = selection.chosen, range(len(selection.chosen.members))
    after = fitter.residual(chosen)
    before = fitter.residual(selection.none) if fitter.prior is None else fitter.residual(chosen, everyone)
    unnamed_pattern = _stranger(fitter, selection, after)
    unnamed = 0.0 if unnamed_pattern is None else unnamed_pattern.statistic
    unnamed_pattern = _clearer(unnamed_pattern, burst(dataset, after))
    found = [
        finding(fitter, chosen, place, one, after, unnamed) for place, one in enumerate(comparisons)
    ] + raw
    most = max((one.statistic for one in comparisons), default=0.0)
    tell("predict the residual", 0.8)
    noise = tuple(one.noise for one in chosen.fit.joints)
    predictable = predictable_share(dataset, after, fitter.operating_point, noise)
    tell("prepare figures", 0.95)
    return Diagnosis(
        verdict=_verdict(found, predictable, unnamed_pattern, most),
        findings=tuple(sorted(found, key=lambda one: one.p_value)),
        not_identifiable=_not_identifiable(fitter, selection),
        predictable=predictable,
        unnamed_pattern=unnamed_pattern,
        atlas=atlas(dataset, after, fitter.operating_point, noise),
        dataset=dataset,
        operating_point=fitter.operating_point,
        selection=selection,
        residual_before=before,
        residual_after=after,
        at_rest=fitter.at_rest(chosen),
    )


def _searched(
    question: DiagnosisProblem, dataset: Dataset, tell: Progress
) -> tuple[HypothesisFitter, Selection]:
    """Search for causes, and on with other blocks held out where one hides what no other shows."""

    def progress(done: float) -> None:
        tell("search", 0.1 + 0.5 * done)

    progress(0.0)
    fitter, found = _found(_bench(question, dataset), progress)
    other_look = with_other_holdout(dataset) if has_holdout_outliers(fitter, found.chosen) else None
    if other_look is not None:
        other, more = _found(fitter.with_look(other_look), progress, found.chosen.members)
        if more.chosen.members and not has_holdout_outliers(other, more.chosen):
            return other, more
    return fitter, found


def _found(
    fitter: HypothesisFitter, progress: Callable[[float], None], start: Sequence[Candidate] = ()
) -> tuple[HypothesisFitter, Selection]:
    """Search; and once more with noise learned from ordinary fits where the noise is left too much."""
    found = search_stepwise(fitter, progress, start)
    if not fitter.needs_ordinary_noise(found.chosen):
        found = restart_from_common_cause(fitter, found)
    if fitter.needs_ordinary_noise(found.chosen):
        fitter, found = _found_anew(fitter, found, progress, start)
    return fitter, restart_at_operating_point(fitter, found)


def _found_anew(
    fitter: HypothesisFitter, before: Selection, progress: Callable[[float], None], start: Sequence[Candidate]
) -> tuple[HypothesisFitter, Selection]:
    """Search under ordinary noise: on from what was found where all of that stays, or from the beginning."""
    ordinary = fitter.with_ordinary_noise()
    found = confirm(ordinary, before, progress)
    if found is None:
        # What was ranked meanwhile is of beliefs that did not hold.
        ordinary = fitter.with_ordinary_noise()
        found = search_stepwise(ordinary, progress, start)
    return ordinary, restart_from_common_cause(ordinary, found)


def _weighed(fitter: HypothesisFitter, found: Selection) -> tuple[Selection, list[Comparison]]:
    """Keep the causes that stand up to their rivals, and look for what the others kept out."""
    kept, comparisons = compare_alternatives(fitter, found)
    lost = {key: np.inf for key in found.chosen.by_key if key not in kept.chosen.by_key}
    if lost:
        more = continue_search(fitter, kept, lost)
        if len(more.chosen.members) > len(kept.chosen.members):
            return compare_alternatives(fitter, more, lost)
    return kept, comparisons


def _bench(question: DiagnosisProblem, dataset: Dataset) -> HypothesisFitter:
    """Lay out what is suspected, and what is believed beforehand."""
    reference = question.reference
    causes, prior = (CAUSES, None) if reference is None else (AGAINST_REFERENCE, reference.prior)
    return HypothesisFitter(dataset, question.plan, causes, prior)


def _looked(question: DiagnosisProblem) -> tuple[list[Finding], Dataset]:
    """Examine the raw samples in a wide look, then narrow it to where positions are not all noise."""
    datasets: list[Fitted] = []
    plain: list[Explained] = []

    def dataset_at(width: float) -> Fitted:
        dataset = build_dataset(
            question.model, question.logs, held_out=question.held_out, blocks=question.blocks, width=width
        )
        fitter, found = _bare(question, dataset)
        fitter.believe(found)
        plain.append((fitter, found))
        datasets.append((dataset, fitter.operating_point, tuple(one.noise for one in found.fit.joints)))
        return datasets[-1]

    dataset, _, _ = limit_bandwidth(dataset_at)
    wide, operating_point, _ = datasets[0]
    raw = [
        sample_finding(cause, one, wide)
        for cause in SAMPLE_CHECKS
        for one in cause.examine(wide, operating_point)
    ]
    return raw, with_typical_holdout(dataset, plain[-1], partial(_bare, question))


def _bare(question: DiagnosisProblem, dataset: Dataset) -> Explained:
    """Fit the model with nothing suspected, under ordinary noise where that is left too much."""
    fitter = HypothesisFitter(dataset, question.plan, ())
    found = fitter.tried(())
    if fitter.needs_ordinary_noise(found):
        fitter = fitter.with_ordinary_noise()
        found = fitter.tried(())
    return fitter, found


def _not_identifiable(fitter: HypothesisFitter, selection: Selection) -> tuple[NotIdentifiable, ...]:
    """List the kinds whose columns the fitted model spans, cause by cause with all such joints."""
    open_sites: dict[str, list[int]] = {}
    by_id = {cause.id: cause for cause in fitter.causes}
    for one in fitter.scanned(selection.none):
        if one.clear_share < OPEN:
            open_sites.setdefault(one.candidate.cause.id, []).extend(one.candidate.site)
    return tuple(
        NotIdentifiable(
            name,
            tuple(sorted(set(joints))),
            "in this motion the parameters of the standard model can stand for it",
            by_id[name].experiment,
        )
        for name, joints in sorted(open_sites.items())
    )


def _stranger(fitter: HypothesisFitter, selection: Selection, left: JointSeries) -> UnnamedPattern | None:
    """Give the clearest of what the residual follows though no listed cause would."""
    ways = (unnamed_candidates(fitter), switching_candidates(fitter, selection.chosen, left))
    return _clearer(
        *(_pattern(fitter, selection, one) for one in ways), bounded_residual(fitter.dataset, left)
    )


def _clearer(*with_deviations: UnnamedPattern | None) -> UnnamedPattern | None:
    return max(
        (one for one in with_deviations if one is not None), key=lambda one: one.statistic, default=None
    )


def _pattern(
    fitter: HypothesisFitter, selection: Selection, unnamed: tuple[Candidate, ...]
) -> UnnamedPattern | None:
    found = best_unnamed_pattern(fitter, selection.chosen, unnamed)
    if found is None:
        return None
    last = found.members[-1]
    chance = log_p(selection.chosen, found) + float(np.log(fitter.dataset.joints))
    return UnnamedPattern(
        joint=last.site[0],
        statement=last.cause.statement(found.with_deviations(len(found.members) - 1, fitter.dataset.robot)),
        statistic=likelihood_ratio(selection.chosen, found),
        log10_p=chance / float(np.log(10.0)),
    )


def _verdict(
    found: Sequence[Finding],
    predictable: Sequence[Predictable],
    unnamed_pattern: UnnamedPattern | None,
    most: float,
) -> Verdict:
    """Say `unexplained` where what no cause explains is more than what the causes found do.

    What spoilt samples leave follows patterns, too: on joints where a raw check explains a part, it does.
    """
    spoilt = {joint for one in found if one.member is None for joint in _spoilt(one)}
    if (
        unnamed_pattern is not None
        and unnamed_pattern.statistic > most
        and unnamed_pattern.joint not in spoilt
    ):
        return "unexplained"
    left = [one for one in predictable if one.interval[0] > UNEXPLAINED_SHARE]
    if not found:
        return "unexplained" if left else "nothing_found"
    explained = {joint: one.explained_fraction for one in found for joint in one.joints}
    if any(one.share > explained.get(one.joint, 0.0) for one in left):
        return "unexplained"
    return "causes_found"


def _spoilt(found: Finding) -> tuple[int, ...]:
    return found.joints if found.explained_fraction > UNEXPLAINED_SHARE else ()


def _say_nothing(_stage: str, _fraction: float) -> None:
    pass
