"""Compare every finding with its alternatives: those that explain the log as well, and those refuted.

An alternative takes the finding's place with the other findings kept, its scalars refined and its noise
estimated again. Two hypotheses whose criteria differ by less than six are undecided by this log.
Source: Burnham & Anderson, Model Selection (2002), ch. 2.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import starmap

import numpy as np

from ..causes.imitation import imitations
from ..causes.masking import excludes
from ..result import Alternative, Gain
from ..search.confounding import is_masked_by_last, keeps_beside
from ..search.entry_test import begins_within, passes_holdout, with_candidate
from ..search.fitter import HypothesisFitter
from ..search.holdout import holdout_share
from ..search.hypothesis import Candidate, Hypothesis
from ..search.likelihood_ratio import bic_gain, likelihood_ratio, position_noise_by_joint
from ..search.residuals import residual
from ..search.state import SearchState
from ..thresholds.checks import ALTERNATIVES
from ..thresholds.search import MASKING, SEARCH, SELECTION
from .gain import gain
from .lack_of_fit import best_unnamed_pattern, unnamed_candidates
from .plausible_size import has_plausible_size
from .unnamed_event import lead_over_events


@dataclass(frozen=True, eq=False)
class Comparison:
    """Hold the comparison of a finding with its alternatives."""

    index: int
    member: Candidate
    """Index in the hypothesis of the member that is judged, and the member."""
    statistic: float
    """Its likelihood ratio statistic."""
    bic_gain: float
    """Its BIC difference."""
    margin: float
    """Its BIC difference less that of the best alternative: another cause, or the same one elsewhere."""
    is_refuted: bool
    """Whether an alternative fits better by more than decides between the two."""
    ambiguous: tuple[Alternative, ...]
    refuted: tuple[Alternative, ...]
    without: Hypothesis
    over_unnamed: float = np.inf
    """The same over the best unnamed pattern on its joints, or the best unnamed event; infinite where none
    explains anything."""
    stays_beside_unnamed: bool = False
    """Whether it explains as much beside a pattern that leads, and no event does: another effect."""


def compare_alternatives(found: SearchState) -> tuple[SearchState, list[Comparison]]:
    """Compare every member with its alternatives, and drop those that are surrogates.

    Beside a strong effect whose columns are not exact, many causes fit the remainder a little. A member is
    such a surrogate where another candidate fits better in its place but was not swapped for it, or where an
    unnamed pattern fits far better. A member may also become inadmissible once another was dropped. What was
    dropped is no alternative. Gives what remains, with its members' comparisons.
    """
    state, unnamed = found, unnamed_candidates(found.fitter)
    while True:
        refitted = [refit_member(state, index) for index in range(len(state.chosen.members))]
        pairs = zip(state.fitter.fit_without_each(state.chosen), refitted, strict=True)
        brings = [likelihood_ratio(without, own) for without, own in pairs]
        comparisons: list[Comparison] = []
        # The first to be dropped is the least significant one, so no other is compared before it is gone.
        for index in sorted(range(len(brings)), key=brings.__getitem__):
            if _is_inadmissible(state, index):
                break
            own = _comparison(state, index, refitted[index], unnamed)
            if _is_surrogate(state, own, alone=own.statistic >= max(brings)):
                break
            comparisons.append(own)
        else:
            return state, sorted(comparisons, key=lambda own: own.index)
        state = _dropped(state, index, brings[index])


def refit_member(state: SearchState, index: int) -> Hypothesis:
    """Fit a member again on top of the others, from the noise that they have without it."""
    without = state.fitter.fit_without_each(state.chosen)[index]
    return state.fitter.fit((*without.members, state.chosen.members[index]), without)


def _dropped(state: SearchState, index: int, brings: float) -> SearchState:
    """Give the state without a member, linearised there."""
    without, member = state.fitter.fit_without_each(state.chosen)[index], state.chosen.members[index]
    return state.linearised_at(without).recorded("dropped", member, -brings).excluding(member.key)


def _comparison(
    state: SearchState, index: int, refitted: Hypothesis, unnamed: tuple[Candidate, ...]
) -> Comparison:
    return _with_unnamed(state.fitter, compare_member(state, index, refitted), unnamed)


def _is_inadmissible(state: SearchState, index: int) -> bool:
    """Tell whether a member is inadmissible, or of an implausible size."""
    return not state.chosen.admits(index) or not has_plausible_size(state.fitter, state.chosen, index)


def _is_surrogate(state: SearchState, own: Comparison, *, alone: bool) -> bool:
    """Tell whether another candidate or pattern should stand for a member, or none."""
    return (
        (own.is_refuted and not alone)
        or _reduces_no_error(state.fitter, state.chosen, own, alone=alone)
        or _pattern_is_better(own)
    )


def _reduces_no_error(fitter: HypothesisFitter, chosen: Hypothesis, own: Comparison, *, alone: bool) -> bool:
    """Tell whether a member reduces no error on held-out rows.

    The most significant member, and one that hardly acts on those rows, only fail where that error grows.
    """
    if own.member.cause.traits.transient or fitter.prior is not None:
        return False
    expected = holdout_share(fitter, chosen, chosen.by_key[own.member.key]) * own.statistic
    gains = list(_gains(fitter, chosen, own))
    if alone or expected < ALTERNATIVES.least_expected:
        return any(there.interval_95[1] < 0.0 for there, _ in gains)
    return bool(gains) and all(starmap(_holdout_refutes, gains))


def _gains(fitter: HypothesisFitter, chosen: Hypothesis, own: Comparison) -> Iterator[tuple[Gain, Gain]]:
    """Give a member's gains on held-out and on fitted rows: on the joints it acts on, then on all.

    What shared parameters absorb where a cause acts, they add to the error of the other joints.
    """
    dataset, left = fitter.dataset, (residual(fitter, own.without), residual(fitter, chosen))
    masks = [dataset.usable & (dataset.held_out == held)[:, None] for held in (True, False)]
    for joints in (tuple(sorted(fitter.columns([own.member])[0])), tuple(range(dataset.joints))):
        there, here = (gain(*left, mask, dataset.block_of_all, joints) for mask in masks)
        if there is not None and here is not None:
            yield there, here


def _holdout_refutes(there: Gain, here: Gain) -> bool:
    """Tell whether held-out rows show no gain, and contradict that of the fitted rows if there is one."""
    low, high = there.interval_95
    none = there.total_percent < 0.0 and here.total_percent < 0.0
    return none or (
        low <= 0.0 and there.total_percent < ALTERNATIVES.least_gain and high < here.total_percent
    )


def _with_unnamed(fitter: HypothesisFitter, own: Comparison, unnamed: tuple[Candidate, ...]) -> Comparison:
    """Compare a member with the best unnamed pattern in its place, on its joints."""
    joints = own.member.site or range(1, fitter.dataset.joints + 1)
    here = tuple(pattern for pattern in unnamed if pattern.site[0] in joints)
    pattern = best_unnamed_pattern(fitter, own.without, here)
    if pattern is None:
        return own
    lead = own.bic_gain - bic_gain(own.without, pattern)
    stays = lead < 0.0 <= own.over_unnamed and keeps_beside(
        fitter, own.without, pattern, own.member, own.statistic
    )
    return replace(own, over_unnamed=min(own.over_unnamed, lead), stays_beside_unnamed=stays)


def _pattern_is_better(own: Comparison) -> bool:
    """Tell whether an unnamed pattern in a member's place explains much more, its part among it."""
    if own.stays_beside_unnamed:
        return False
    if own.member.cause.traits.transient:
        return own.over_unnamed < MASKING.kept * own.statistic
    return own.over_unnamed < -max(SELECTION.undecided, ALTERNATIVES.unnamed_share * own.statistic)


def compare_member(state: SearchState, index: int, own: Hypothesis) -> Comparison:
    """Compare a member with the best of all other candidates in its place, but for excluded ones.

    Parameters
    ----------
    own
        The hypothesis with the member as `refit_member` gives it.
    """
    fitter, chosen = state.fitter, state.chosen
    member, without = chosen.members[index], fitter.fit_without_each(chosen)[index]
    ambiguous, refuted, margin, is_refuted = [], [], np.inf, False
    own_gain, own_ratio = bic_gain(without, own), likelihood_ratio(without, own)
    trials = _not_left(fitter, own, _trials(state, without))
    for trial in trials:
        other, ratio = trial.members[-1], likelihood_ratio(without, trial)
        if keeps_beside(fitter, without, own, other, ratio):
            continue
        why = _objection(fitter, without, trial)
        settled = _at_its_own_point(state, trial, why)
        ratio, behind = likelihood_ratio(without, settled), own_gain - bic_gain(without, settled)
        undecided = _undecided_bound(member, other, own_ratio)
        if not why:
            margin = min(margin, behind)
            is_refuted = is_refuted or behind < -undecided
        # An alternative that explains no more than position noise might refutes no finding.
        like = _noise_statistic(fitter, own, (member, other))
        if not why and behind < max(like, undecided):
            ambiguous.append(_undecided_alternative(member, other, ratio, behind, like))
        elif ratio > ALTERNATIVES.least_ratio_listed * own_ratio:
            refuted.append(_refuted_alternative(other, ratio, own_ratio, why))
    return Comparison(
        index,
        member,
        own_ratio,
        own_gain,
        float(margin),
        is_refuted,
        tuple(ambiguous),
        tuple(refuted),
        without,
        lead_over_events(fitter, without, own, trials),
    )


def _not_left(fitter: HypothesisFitter, own: Hypothesis, trials: list[Hypothesis]) -> list[Hypothesis]:
    """Give the trials whose last member is not what the member that is judged leaves."""
    return [trial for trial in trials if not is_masked_by_last(fitter, own, trial.members[-1])]


def _trials(state: SearchState, without: Hypothesis) -> list[Hypothesis]:
    """Fit the best candidates in a member's place, the best first."""
    fitter, taken = state.fitter, {*state.keys, *state.excluded}
    closed = {name for member in without.members for name in excludes(member.cause.id)}
    others = [
        scored
        for scored in fitter.scan(without)
        if scored.determined and scored.candidate.key not in taken and scored.candidate.cause.id not in closed
    ]
    trials = [with_candidate(fitter, without, scored) for scored in others[: SEARCH.swaps]]
    whole = [fitter.fit(trial.members, trial) for trial in trials]
    return sorted(whole, key=lambda trial: -bic_gain(without, trial))


def _at_its_own_point(state: SearchState, trial: Hypothesis, objection: str) -> Hypothesis:
    """Fit an alternative that can be one where it is linearised at itself, unless it is worse there.

    Where robot or signals are wrong, columns are derivatives of the model's torque. Those of a zero that is
    off by some degrees differ at a model with another cause in its place. A further term has its own columns.
    """
    if objection or trial.members[-1].cause.cure == "term":
        return trial
    moved = state.linearised_at(trial).chosen
    return max(trial, moved if moved.admissible else trial, key=lambda one: one.fit.log_likelihood)


def _undecided_bound(member: Candidate, other: Candidate, own_ratio: float) -> float:
    known = imitations(member.cause.id).get(other.cause.id)
    return max(SELECTION.undecided, (known.share if known else ALTERNATIVES.other_share) * own_ratio)


def _noise_statistic(fitter: HypothesisFitter, own: Hypothesis, both: tuple[Candidate, ...]) -> float:
    """Give the statistic that position noise may give two candidates: none where one is unlike it."""
    if not all(candidate.cause.traits.like_position_noise for candidate in both):
        return 0.0
    worth = position_noise_by_joint(fitter, own)
    every = range(1, len(worth) + 1)
    return min(max(float(worth[joint - 1]) for joint in candidate.site or every) for candidate in both)


def _undecided_alternative(
    member: Candidate, other: Candidate, statistic: float, behind: float, like: float
) -> Alternative:
    known = imitations(member.cause.id).get(other.cause.id)
    why = known.why if known else "the columns of both are nearly collinear in this motion"
    experiment = known.experiment if known else other.cause.experiment
    noise = f"; position noise may account for {like:.1f}" if like > SELECTION.undecided else ""
    return Alternative(
        other.cause.id, other.site, statistic, f"Delta BIC only {behind:.1f}{noise}: {why}", experiment
    )


def _objection(fitter: HypothesisFitter, without: Hypothesis, trial: Hypothesis) -> str:
    """Say why an alternative cannot take a finding's place; empty where it can."""
    if not trial.admissible:
        return "fits only with a sign or size that is not physically admissible"
    if not begins_within(fitter, trial.members[-1]):
        return "would act from the log's beginning, and so throughout"
    return "" if passes_holdout(fitter, without, trial) else "does not help on held-out data"


def _refuted_alternative(other: Candidate, statistic: float, own: float, inadmissible: str) -> Alternative:
    why = (
        f"{inadmissible} (log-likelihood ratio statistic {statistic:.1f})"
        if inadmissible
        else f"log-likelihood ratio statistic {statistic:.1f}, where the finding has {own:.1f}"
    )
    return Alternative(other.cause.id, other.site, statistic, why, "")
