"""Choose the causes: forward, with backward elimination and swaps, each step judged under its own noise.

Greedy order is the weak point of forward selection, because the first cause chosen may stand in for two
others; so after every step each chosen cause has to defend its place against being dropped and against every
rival. Source: Miller, Subset Selection in Regression (2002), ch. 3.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.diagnosis.bench import Bench
from core.diagnosis.cause import Site
from core.diagnosis.hypothesis import Candidate, Hypothesis, Scored
from core.diagnosis.leftovers import BESIDE_SHARE, left_over
from core.diagnosis.rise import bounded_rise, log_p, merit, rise, weight
from core.diagnosis.scalars import refined
from core.diagnosis.settling import settled

Key = tuple[str, Site]
GivenUp = Mapping[Key, float]
"""Kinds that were chosen once, and the rise that brings each back: none (inf) what did not stand out."""
NOTHING: GivenUp = {}

LEVEL = 1e-4
"""Chance of naming anything in a log that hides nothing."""
FURTHER_LEVEL = 1e-7
"""The same beside another cause: no columns are exact, and what they leave is not luck,"""
UNCHANGED = 0.9
"""unless, on a joint of its own, it was as clear, within this share, before any other cause was known."""
TRIED = 16
"""Candidates of a scan that are fitted, with the noise learned anew where they act."""
RIVALS, BETTER = 6, 6.0
"""The same where one is to take another's place, and by how much its criterion has to be better."""
RAISED = 8.0
"""Noise learned anew with a candidate raises what a scan says of it by so much at most (six and a half times
were seen): what cannot come up to others so is fitted only where these do not hold."""
FITTED_WHOLE = 4
"""The best of them, fitted with the noise of all joints learned anew."""
MOST = 5
"""Causes looked for at most."""
UNSEEN_SHARE = 0.25
"""Share of the rise to be expected on held-out rows that has to be seen there,"""
UNLUCKY = 2.5
"""unless it is so small that luck, within so many of its deviations, can take it away."""
EVENT_LEVEL = 1e-6
"""The same for an event, which is looked for where noise is largest,"""
RARE = 0.1
"""and for what acts in less than this share of a joint's rows, as one burst of noise does."""
LEAST_SHARE = 0.004
"""Least share of a joint's whitened residual square that a cause has to explain."""


@dataclass(frozen=True, eq=False)
class Step:
    """Record one decision of the search, for the report."""

    action: str
    candidate: Candidate
    statistic: float


@dataclass(frozen=True, eq=False)
class Selection:
    """Hold the hypothesis that was settled on, the empty one, and the way there."""

    none: Hypothesis
    chosen: Hypothesis
    steps: tuple[Step, ...]


def select(
    bench: Bench, progress: Callable[[float], None] | None = None, start: Sequence[Candidate] = ()
) -> Selection:
    """Search for the causes that explain the rows, from those that other rows have shown if there are any."""
    none = bench.tried(())
    bench.believe(none)
    now = settled(bench, bench.tried(tuple(start))) if start else none
    kept = tuple(Step("kept", one, 0.0) for one in start)
    return continued(bench, Selection(none, now, kept), {}, progress)


def continued(
    bench: Bench,
    so_far: Selection,
    given_up: dict[Key, float],
    progress: Callable[[float], None] | None = None,
) -> Selection:
    """Search for more causes than those found so far."""
    now, steps = so_far.chosen, list(so_far.steps)
    for number in range(len(now.members), MOST):
        if progress is not None:
            progress(number / MOST)
        better = best_addition(bench, now, given_up)
        if better is None:
            break
        steps.append(Step("added", better.members[-1], rise(now, better)))
        larger = settled(bench, better)
        if now.members and now.possible and not larger.possible:
            # Beside it nature would not allow what was found before.
            steps.append(Step("dropped", better.members[-1], rise(now, better)))
            given_up[better.members[-1].key] = np.inf
            bench.believe(now)
            continue
        now = _defended(bench, larger, steps, given_up)
    return Selection(so_far.none, now, tuple(steps))


def begun_with(bench: Bench, now: Hypothesis, cause: str) -> Hypothesis | None:
    """Give a hypothesis with one cause of the whole robot besides; None where it is not clear enough."""
    scans = [one for one in bench.scanned(now) if one.candidate.key == (cause, ())]
    trials = [with_candidate(bench, now, one) for one in scans]
    clear = (one for one in trials if one.possible and clear_enough(bench, now, one, bench.kinds))
    first = next(clear, None)
    return None if first is None else settled(bench, first)


def best_addition(
    bench: Bench, now: Hypothesis, given_up: GivenUp = NOTHING, most: int = TRIED, least: float = 0.0
) -> Hypothesis | None:
    """Give the hypothesis with the cause that deserves it most, of so many tried; None where none does.

    Parameters
    ----------
    least
        What its criterion has to gain (see `merit`).
    """
    excluded = {name for one in now.members for name in one.cause.excludes}
    taken = {*now.by_key, *(key for key, brings in given_up.items() if brings == np.inf)}
    scans = [
        one
        for one in bench.scanned(now)
        if one.candidate.key not in taken and one.candidate.cause.id not in excluded
    ]
    tried = scans[:most] + [one for one in scans[most:] if one.candidate.cause.event]
    found, left = None, [one for one in tried if _may_reach(one, least)]
    while left and found is None:
        likely, left = _likely(bench, now, left, least, len(scans))
        found = _first_to_hold(bench, now, likely, given_up, least)
    return found


def _may_reach(scored: Scored, least: float) -> bool:
    """Tell whether a candidate may gain so much once it is fitted; a scan says little of an event."""
    return scored.candidate.cause.event or RAISED * scored.statistic > least


def _likely(
    bench: Bench, now: Hypothesis, scans: Sequence[Scored], least: float, kinds: int
) -> tuple[list[Hypothesis], list[Scored]]:
    """Fit the candidates of a scan, and give those that are clear enough, the best ones first.

    Those that cannot be better than others that were are not fitted, and given besides.
    """
    likely, left, best = [], [], least
    for one in scans:
        if not _may_reach(one, best):
            left.append(one)
            continue
        trial = with_candidate(bench, now, one)
        gains = merit(now, trial)
        if trial.possible and gains > least and _deserves(bench, now, trial, kinds):
            likely.append(trial)
            best = best if one.candidate.cause.event else max(best, gains)
    return sorted(likely, key=lambda trial: -merit(now, trial)), left


def _first_to_hold(
    bench: Bench, now: Hypothesis, likely: Sequence[Hypothesis], given_up: GivenUp, least: float
) -> Hypothesis | None:
    """Give the best of some trials that holds on unseen rows and is not what others leave."""
    # A shared parameter carries an effect to other joints: the last word has the noise of all of them.
    whole = [bench.tried(trial.members, trial) for trial in likely[:FITTED_WHOLE]]
    # What acts at picked instants only explains a little of anything, and comes after what acts all the time.
    ranked = sorted(whole, key=lambda trial: (trial.members[-1].cause.event, -merit(now, trial)))
    deserves = (
        trial
        for trial in ranked
        if trial.possible
        and merit(now, trial) > least
        and rise(now, trial) > given_up.get(trial.members[-1].key, 0.0)
        and holds_unseen(bench, now, trial)
        and not left_over(bench, trial, len(now.members), now)
    )
    return next(deserves, None)


def _deserves(bench: Bench, now: Hypothesis, trial: Hypothesis, kinds: int, index: int = -1) -> bool:
    """Tell whether a member is clear enough to join (the last one unless said otherwise; so below)."""
    return clear_enough(bench, now, trial, kinds, index=index) or _apart(bench, now, trial, kinds, index)


def _stays(bench: Bench, without: Hypothesis, now: Hypothesis, index: int) -> bool:
    """Tell whether a member still stands out; beside others it has to be clear enough to join them again."""
    if not without.members:
        return bool(weight(now, index) > -2.0 * np.log(LEVEL))
    return _deserves(bench, without, now, bench.kinds, index)


def _apart(bench: Bench, now: Hypothesis, trial: Hypothesis, kinds: int, index: int) -> bool:
    """Tell whether a member is as clear as a first one has to be, and owes nothing to the others."""
    member, others = trial.members[index], [set(one.site) for one in now.members]
    if not others or _at_picked_instants(trial, index):
        return False
    if not all(one and one.isdisjoint(member.site) for one in others):
        return False
    if not member.site or not clear_enough(bench, now, trial, kinds, LEVEL, index):
        return False
    none = bench.tried(())
    alone, beside = rise(none, bench.added(none, member)), rise(now, trial)
    return min(alone, beside) > UNCHANGED * max(alone, beside)


def clear_enough(
    bench: Bench,
    now: Hypothesis,
    trial: Hypothesis,
    kinds: int,
    level: float | None = None,
    index: int = -1,
) -> bool:
    """Tell whether a member is beyond luck among so many kinds, and large enough to matter."""
    if level is None:
        rare = _at_picked_instants(trial, index)
        level = FURTHER_LEVEL if now.members else EVENT_LEVEL if rare else LEVEL
    hurdle = np.log(level) - np.log(max(kinds, 1))
    chance = log_p(now, trial, bounded_rise(now, trial, index), index)
    return bool(chance < hurdle and _share(now, trial) > _least_share(bench, trial.members[index]))


def _at_picked_instants(trial: Hypothesis, index: int) -> bool:
    """Tell whether a member acts now and then only, so that one burst of noise may look like it."""
    if trial.members[index].cause.event:
        return True
    own = trial.columns_of(index)
    acting = [part.columns[:, own].any(axis=1) for part in trial.fit.joints]
    return all(float(rows.mean()) < RARE for rows in acting if rows.any())


def holds_unseen(bench: Bench, now: Hypothesis, trial: Hypothesis) -> bool:
    """Tell whether a new member helps on held-out rows as far as it acts there.

    An event is judged where it happens: what a fit knows of it from half its span says little of the rest.
    """
    if trial.members[-1].cause.event:
        return True
    expected = bench.unseen_share(trial) * min(weight(trial, len(trial.members) - 1), rise(now, trial))
    luck = 2.0 * float(np.sqrt(max(expected, 1.0)))
    return bench.unseen_rise(now, trial) >= min(UNSEEN_SHARE * expected, expected - UNLUCKY * luck)


def with_candidate(bench: Bench, now: Hypothesis, scored: Scored) -> Hypothesis:
    """Add a candidate with scalars refined roughly, and fit everything anew."""
    return bench.added(now, refined(bench, now, scored.candidate, on_trial=True))


def _share(now: Hypothesis, trial: Hypothesis) -> float:
    rows = min((len(one.torque) for one in trial.fit.joints if len(one.torque)), default=1)
    return rise(now, trial) / rows


def _least_share(bench: Bench, member: Candidate) -> float:
    if not member.cause.like_position_noise:
        return LEAST_SHARE
    return max(LEAST_SHARE, *(float(bench.look.position_share[joint - 1]) for joint in member.site))


def _defended(bench: Bench, now: Hypothesis, steps: list[Step], given_up: dict[Key, float]) -> Hypothesis:
    """Let every member defend its place against being dropped and against its rivals."""
    for _ in range(2 * MOST):
        changed = _challenged(bench, now, steps, given_up)
        if changed is None:
            return now
        if len(changed.members) == len(now.members):
            now = settled(bench, changed)
        else:
            bench.believe(changed)
            now = bench.tried(changed.members, changed)
    return now


def _challenged(
    bench: Bench, now: Hypothesis, steps: list[Step], given_up: dict[Key, float]
) -> Hypothesis | None:
    less = bench.less(now)
    brings = [rise(without, now) for without in less]
    weak = [
        index
        for index, without in enumerate(less)
        if not _stays(bench, without, now, index) or left_over(bench, now, index, without)
    ]
    if weak:
        least = min(weak, key=lambda index: brings[index])
        steps.append(Step("dropped", now.members[least], brings[least]))
        given_up[now.members[least].key] = np.inf
        return less[least]
    for index, member in enumerate(now.members):
        hurdle = merit(less[index], now, index) + BETTER
        rival = best_addition(bench, less[index], {**given_up, member.key: np.inf}, RIVALS, hurdle)
        # What acts at picked instants only does not take the place of what acts all the time.
        if rival is not None and (member.cause.event or not rival.members[-1].cause.event):
            steps.append(Step("swapped", rival.members[-1], rise(now, rival)))
            given_up[member.key] = BESIDE_SHARE * brings[index]
            return rival
    return None
