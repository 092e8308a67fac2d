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
from .bandwidth import Fitted, narrowed
from .causes.registry import AGAINST_REFERENCE, CAUSES, RAW_CAUSES
from .checks.alternatives import Standing, weighed
from .checks.bursts import burst
from .checks.change_points import switchings
from .checks.findings import finding, raw_finding
from .checks.holdout_outliers import Explained, surprised, turned, unsurprising
from .checks.kurtosis import level_keeper
from .checks.lack_of_fit import best_stranger, strangers
from .dataset.dataset import Look, look_at
from .residual.atlas import atlas
from .residual.learner import Predictable, predictable_share, refuse_too_little
from .result import Diagnosis, Finding, NotIdentifiable, Stranger, Verdict
from .search.fitter import Bench
from .search.hypothesis import Candidate
from .search.likelihood_ratio import log_p, rise
from .search.restarts import consolidated, reconsidered
from .search.stepwise import Selection, confirmed, continued, select

Progress = Callable[[str, float], None]
OPEN = 1e-3
"""A candidate of whose columns the model spans all but this share cannot be shown by this motion."""
UNEXPLAINED_SHARE = 0.03
"""Least share of a joint's residual that must be predictable, with its interval, to be called structure."""


@dataclass(frozen=True, eq=False)
class Question:
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


def diagnose(question: Question, progress: Progress | None = None) -> Diagnosis:
    """Name what the model does not explain.

    Raises
    ------
    ExcitationError
        If the logs are too short to hold anything out.
    """
    tell = progress or _say_nothing
    raw, look = _looked(question)
    refuse_too_little(look.clear)
    bench, searched = _searched(question, look, tell)
    look = bench.look
    tell("weigh rivals", 0.6)
    selection, standings = _weighed(bench, searched)
    chosen, everyone = selection.chosen, range(len(selection.chosen.members))
    after = bench.residual(chosen)
    before = bench.residual(selection.none) if bench.belief is None else bench.residual(chosen, everyone)
    stranger = _stranger(bench, selection, after)
    unnamed = 0.0 if stranger is None else stranger.statistic
    stranger = _clearer(stranger, burst(look, after))
    found = [finding(bench, chosen, place, one, after, unnamed) for place, one in enumerate(standings)] + raw
    most = max((one.statistic for one in standings), default=0.0)
    tell("learn what is left", 0.8)
    noise = tuple(one.noise for one in chosen.fit.joints)
    predictable = predictable_share(look, after, bench.believed, noise)
    tell("lay out", 0.95)
    return Diagnosis(
        verdict=_verdict(found, predictable, stranger, most),
        findings=tuple(sorted(found, key=lambda one: one.p_value)),
        not_identifiable=_not_identifiable(bench, selection),
        predictable=predictable,
        stranger=stranger,
        atlas=atlas(look, after, bench.believed, noise),
        look=look,
        believed=bench.believed,
        selection=selection,
        residual_before=before,
        residual_after=after,
        at_rest=bench.at_rest(chosen),
    )


def _searched(question: Question, look: Look, tell: Progress) -> tuple[Bench, Selection]:
    """Search for causes, and on with other blocks held out where one hides what no other shows."""

    def progress(done: float) -> None:
        tell("search", 0.1 + 0.5 * done)

    progress(0.0)
    bench, found = _found(_bench(question, look), progress)
    other_look = turned(look) if surprised(bench, found.chosen) else None
    if other_look is not None:
        other, more = _found(bench.with_look(other_look), progress, found.chosen.members)
        if more.chosen.members and not surprised(other, more.chosen):
            return other, more
    return bench, found


def _found(
    bench: Bench, progress: Callable[[float], None], start: Sequence[Candidate] = ()
) -> tuple[Bench, Selection]:
    """Search; and once more with noise learned from ordinary fits where the noise is left too much."""
    found = select(bench, progress, start)
    if not bench.needs_ordinary_noise(found.chosen):
        found = consolidated(bench, found)
    if bench.needs_ordinary_noise(found.chosen):
        bench, found = _found_anew(bench, found, progress, start)
    return bench, reconsidered(bench, found)


def _found_anew(
    bench: Bench, before: Selection, progress: Callable[[float], None], start: Sequence[Candidate]
) -> tuple[Bench, Selection]:
    """Search under ordinary noise: on from what was found where all of that stays, or from the beginning."""
    ordinary = bench.with_ordinary_noise()
    found = confirmed(ordinary, before, progress)
    if found is None:
        # What was ranked meanwhile is of beliefs that did not hold.
        ordinary = bench.with_ordinary_noise()
        found = select(ordinary, progress, start)
    return ordinary, consolidated(ordinary, found)


def _weighed(bench: Bench, found: Selection) -> tuple[Selection, list[Standing]]:
    """Keep the causes that stand up to their rivals, and look for what the others kept out."""
    kept, standings = weighed(bench, found)
    lost = {key: np.inf for key in found.chosen.by_key if key not in kept.chosen.by_key}
    if lost:
        more = continued(bench, kept, lost)
        if len(more.chosen.members) > len(kept.chosen.members):
            return weighed(bench, more, lost)
    return kept, standings


def _bench(question: Question, look: Look) -> Bench:
    """Lay out what is suspected, and what is believed beforehand."""
    reference = question.reference
    causes, belief = (CAUSES, None) if reference is None else (AGAINST_REFERENCE, reference.belief)
    return Bench(look, question.plan, causes, belief)


def _looked(question: Question) -> tuple[list[Finding], Look]:
    """Examine the raw samples in a wide look, then narrow it to where positions are not all noise."""
    looks: list[Fitted] = []
    plain: list[Explained] = []

    def look_again(width: float) -> Fitted:
        look = look_at(
            question.model, question.logs, held_out=question.held_out, blocks=question.blocks, width=width
        )
        bench, found = _bare(question, look)
        bench.believe(found)
        plain.append((bench, found))
        looks.append((look, bench.believed, tuple(one.noise for one in found.fit.joints)))
        return looks[-1]

    look, _, _ = narrowed(look_again)
    wide, believed, _ = looks[0]
    raw = [raw_finding(cause, one, wide) for cause in RAW_CAUSES for one in cause.examine(wide, believed)]
    return raw, unsurprising(look, plain[-1], partial(_bare, question))


def _bare(question: Question, look: Look) -> Explained:
    """Fit the model with nothing suspected, under ordinary noise where that is left too much."""
    bench = Bench(look, question.plan, ())
    found = bench.tried(())
    if bench.needs_ordinary_noise(found):
        bench = bench.with_ordinary_noise()
        found = bench.tried(())
    return bench, found


def _not_identifiable(bench: Bench, selection: Selection) -> tuple[NotIdentifiable, ...]:
    """List the kinds whose columns the fitted model spans, cause by cause with all such joints."""
    open_sites: dict[str, list[int]] = {}
    by_id = {cause.id: cause for cause in bench.causes}
    for one in bench.scanned(selection.none):
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


def _stranger(bench: Bench, selection: Selection, left: JointSeries) -> Stranger | None:
    """Give the clearest of what the residual follows though no listed cause would."""
    ways = (strangers(bench), switchings(bench, selection.chosen, left))
    return _clearer(*(_pattern(bench, selection, one) for one in ways), level_keeper(bench.look, left))


def _clearer(*told: Stranger | None) -> Stranger | None:
    return max((one for one in told if one is not None), key=lambda one: one.statistic, default=None)


def _pattern(bench: Bench, selection: Selection, suspects: tuple[Candidate, ...]) -> Stranger | None:
    found = best_stranger(bench, selection.chosen, suspects)
    if found is None:
        return None
    last = found.members[-1]
    chance = log_p(selection.chosen, found) + float(np.log(bench.look.joints))
    return Stranger(
        joint=last.site[0],
        statement=last.cause.statement(found.told(len(found.members) - 1, bench.look.robot)),
        statistic=rise(selection.chosen, found),
        log10_p=chance / float(np.log(10.0)),
    )


def _verdict(
    found: Sequence[Finding], predictable: Sequence[Predictable], stranger: Stranger | None, most: float
) -> Verdict:
    """Say `unexplained` where what no cause explains is more than what the causes found do.

    What spoilt samples leave follows patterns, too: on joints where a raw check explains a part, it does.
    """
    spoilt = {joint for one in found if one.member is None for joint in _spoilt(one)}
    if stranger is not None and stranger.statistic > most and stranger.joint not in spoilt:
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
