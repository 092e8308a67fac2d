"""Test what may enter a hypothesis: significant, large enough to matter, and of use on held-out rows.

A scan ranks the candidates. Each is fitted with the noise estimated again where it acts before it is tested,
because noise that was estimated without it has absorbed it.
"""

from collections.abc import Sequence

import numpy as np

from ..causes.masking import excludes
from ..thresholds.causes import EVENTS
from ..thresholds.search import ENTRY, HOLDOUT, SEARCH
from .confounding import is_masked
from .fitter import HypothesisFitter
from .holdout import holdout_likelihood_ratio, holdout_share
from .hypothesis import Candidate, Hypothesis, ScoredCandidate
from .likelihood_ratio import (
    bic_gain,
    bounded_likelihood_ratio,
    likelihood_ratio,
    likelihood_ratio_by_joint,
    log_p,
    position_noise_by_joint,
    wald_statistic,
)
from .lr_bound import predicted_likelihood_ratios
from .profile_likelihood import refine_scalars
from .state import Excluded

NOTHING: Excluded = {}
Ranked = Sequence[tuple[ScoredCandidate, float]]
"""Candidates, and the most that each may bring."""


def best_entry(
    fitter: HypothesisFitter,
    now: Hypothesis,
    excluded_kinds: Excluded = NOTHING,
    most: int = SEARCH.tried,
    least: float = 0.0,
) -> Hypothesis | None:
    """Give the hypothesis with the best cause that may enter, of so many tried; None where none may.

    Parameters
    ----------
    least
        BIC gain that it has to exceed.
    """
    scans = _admissible_scans(fitter, now, excluded_kinds)
    tried = scans[:most] + [scored for scored in scans[most:] if scored.candidate.cause.traits.transient]
    reach = zip(tried, predicted_likelihood_ratios(fitter, now, tried), strict=True)
    bounds = ((scored, ENTRY.bound_factor * brings + ENTRY.bound_excess) for scored, brings in reach)
    ranked = sorted(bounds, key=lambda pair: -pair[1])
    found: Hypothesis | None = None
    left: Ranked = [(scored, most) for scored, most in ranked if most > least]
    while left and found is None:
        likely, left = _significant(fitter, now, left, least, len(scans))
        found = _best_on_holdout(fitter, now, likely, excluded_kinds, least)
    return found


def _admissible_scans(
    fitter: HypothesisFitter, now: Hypothesis, excluded_kinds: Excluded
) -> list[ScoredCandidate]:
    """Give the scored candidates that neither the log, nor a member, nor the search before excludes."""
    excluded = set().union(*(excludes(member.cause.id) for member in now.members))
    taken = {*now.by_key, *(key for key, brings in excluded_kinds.items() if brings == np.inf)}
    return [
        scored
        for scored in fitter.scan(now)
        if scored.determined
        and scored.candidate.key not in taken
        and scored.candidate.cause.id not in excluded
    ]


def _significant(
    fitter: HypothesisFitter, now: Hypothesis, ranked: Ranked, least: float, kinds: int
) -> tuple[list[Hypothesis], Ranked]:
    """Fit candidates, and give those that are significant, the best ones first.

    Those that cannot be better than a significant one are not fitted, and are given besides.
    """
    likely: list[Hypothesis] = []
    left: list[tuple[ScoredCandidate, float]] = []
    best = least
    for scored, most in ranked:
        if most <= best:
            left.append((scored, most))
            continue
        trial = with_candidate(fitter, now, scored)
        gains = bic_gain(now, trial)
        fits = trial.admissible and gains > least and begins_within(fitter, trial.members[-1])
        if fits and _passes_entry_test(fitter, now, trial, kinds):
            likely.append(trial)
            best = best if scored.candidate.cause.traits.transient else max(best, gains)
    return sorted(likely, key=lambda trial: -bic_gain(now, trial)), left


def _best_on_holdout(
    fitter: HypothesisFitter,
    now: Hypothesis,
    likely: Sequence[Hypothesis],
    excluded_kinds: Excluded,
    least: float,
) -> Hypothesis | None:
    """Give the best of some trials that passes the hold-out test and is not masked by a member."""
    # A shared parameter carries an effect to other joints, so the noise of all of them is estimated again.
    whole = [fitter.fit(trial.members, trial) for trial in likely[: SEARCH.fitted_whole]]
    # A cause in short spans fits a part of whatever is left, and is tried after those that act all the time.
    ranked = sorted(
        whole, key=lambda trial: (trial.members[-1].cause.traits.transient, -bic_gain(now, trial))
    )
    entering = (
        trial
        for trial in ranked
        if trial.admissible
        and bic_gain(now, trial) > least
        and likelihood_ratio(now, trial) > excluded_kinds.get(trial.members[-1].key, 0.0)
        and passes_holdout(fitter, now, trial)
        and not is_masked(fitter, trial, len(now.members), now)
    )
    return next(entering, None)


def _passes_entry_test(
    fitter: HypothesisFitter, now: Hypothesis, trial: Hypothesis, kinds: int, index: int = -1
) -> bool:
    """Tell whether a member passes the entry test (the last one by default; so below)."""
    return is_significant(fitter, now, trial, kinds, index=index) or _is_independent(
        fitter, now, trial, kinds, index
    )


def begins_within(fitter: HypothesisFitter, member: Candidate) -> bool:
    """Tell whether a member with an onset begins within the log: otherwise it acts throughout."""
    first = float(fitter.dataset.time.min()) + EVENTS.shortest
    return all(member.scalars[name] > first for name in member.cause.traits.onset if name in member.scalars)


def passes_exit_test(fitter: HypothesisFitter, without: Hypothesis, now: Hypothesis, index: int) -> bool:
    """Tell whether a member is admissible, and would enter beside the others again."""
    if not now.admits(index):
        return False
    if not without.members:
        return bool(wald_statistic(now, index) > -2.0 * np.log(ENTRY.level))
    return _passes_entry_test(fitter, without, now, fitter.kinds, index)


def _is_independent(
    fitter: HypothesisFitter, now: Hypothesis, trial: Hypothesis, kinds: int, index: int
) -> bool:
    """Tell whether a member is as significant as a first one has to be, and independent of the others."""
    member, others = trial.members[index], [set(other.site) for other in now.members]
    if not others or not member.site or _acts_rarely(trial, index):
        return False
    if not all(others) or not set().union(*others).isdisjoint(member.site):
        return False
    if not is_significant(fitter, now, trial, kinds, ENTRY.level, index):
        return False
    none = fitter.fit(())
    alone, beside = likelihood_ratio(none, fitter.fit_with(none, member)), likelihood_ratio(now, trial)
    return min(alone, beside) > ENTRY.unchanged * max(alone, beside)


def is_significant(
    fitter: HypothesisFitter,
    now: Hypothesis,
    trial: Hypothesis,
    kinds: int,
    level: float | None = None,
    index: int = -1,
) -> bool:
    """Tell whether a member is significant among so many kinds, and large enough to matter."""
    if level is None:
        rare = _acts_rarely(trial, index)
        level = ENTRY.further_level if now.members else ENTRY.event_level if rare else ENTRY.level
    hurdle = np.log(level) - np.log(max(kinds, 1))
    chance = log_p(now, trial, bounded_likelihood_ratio(now, trial, index), index)
    return bool(chance < hurdle) and _is_large(fitter, now, trial, index)


def _acts_rarely(trial: Hypothesis, index: int) -> bool:
    """Tell whether a member acts on few rows only, so that one burst of noise may resemble it."""
    if trial.members[index].cause.traits.transient:
        return True
    own = trial.columns_of(index)
    acting = [part.of(own).any(axis=1) for part in trial.fit.joints]
    return all(float(rows.mean()) < ENTRY.rare for rows in acting if rows.any())


def passes_holdout(fitter: HypothesisFitter, now: Hypothesis, trial: Hypothesis) -> bool:
    """Tell whether a new member helps on held-out rows as far as it acts there.

    A transient cause is judged where it happens: a fit to half its span says little of the rest.
    """
    if trial.members[-1].cause.traits.transient:
        return True
    expected = holdout_share(fitter, trial) * min(
        wald_statistic(trial, len(trial.members) - 1), likelihood_ratio(now, trial)
    )
    deviation = 2.0 * float(np.sqrt(max(expected, 1.0)))
    return holdout_likelihood_ratio(fitter, now, trial) >= min(
        HOLDOUT.share * expected, expected - HOLDOUT.deviations * deviation
    )


def with_candidate(fitter: HypothesisFitter, now: Hypothesis, scored: ScoredCandidate) -> Hypothesis:
    """Add a candidate with refined scalars, without their deviations, and fit everything again.

    What was fitted in a member's place for a swap is not fitted again for a comparison.
    """
    kept, key = fitter.at.trials.get(now, {}), scored.candidate.column_key
    if key not in kept:
        kept[key] = fitter.fit_with(now, refine_scalars(fitter, now, scored.candidate, on_trial=True))
    return kept[key]


def _is_large(fitter: HypothesisFitter, now: Hypothesis, trial: Hypothesis, index: int) -> bool:
    """Tell whether a member explains enough, and on one of its joints more than the positions' noise is.

    The columns hold that noise, too: what resembles it may explain up to all of it.
    """
    brings, member = likelihood_ratio_by_joint(now, trial), trial.members[index]
    rows = min((len(joint.torque) for joint in trial.fit.joints if len(joint.torque)), default=1)
    if -np.expm1(-brings.sum() / rows) <= ENTRY.least_share:
        return False
    if not member.cause.traits.like_position_noise:
        return True
    own = [joint - 1 for joint in member.site] or slice(None)
    return bool(np.any((brings > position_noise_by_joint(fitter, trial))[own]))
