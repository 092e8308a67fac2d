"""Choose the causes: forward, with backward elimination and swaps, each step judged under its own noise.

Greedy order is the weak point of forward selection, because the first cause chosen may stand in for two
others; so after every step each chosen cause has to defend its place against being dropped and against every
rival. Source: Miller, Subset Selection in Regression (2002), ch. 3.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .confounding import BESIDE_SHARE, is_masked
from .entry_test import Key, best_entry, is_significant, passes_exit_test, with_candidate
from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis
from .joint_refinement import refine_jointly
from .likelihood_ratio import bic_gain, likelihood_ratio

Keys = frozenset[Key]
"""The kinds of a hypothesis's members."""
RIVALS, BETTER = 6, 6.0
"""Candidates fitted where one is to take a member's place, and by how much its criterion has to be better."""
MOST = 5
"""Causes looked for at most."""


@dataclass(frozen=True, eq=False)
class Step:
    """Record one decision of the search, for the report."""

    action: str
    candidate: Candidate
    statistic: float


@dataclass(frozen=True, eq=False)
class Selection:
    """Hold the hypothesis that was settled on, the empty one, and the way there.

    Attributes
    ----------
    steps, through
        What was decided on the way, and the sets of causes that it came through.
    """

    none: Hypothesis
    chosen: Hypothesis
    steps: tuple[Step, ...]
    through: frozenset[Keys] = frozenset()


def search_stepwise(
    fitter: HypothesisFitter, progress: Callable[[float], None] | None = None, start: Sequence[Candidate] = ()
) -> Selection:
    """Search for the causes that explain the rows, from those that other rows have shown if there are any."""
    return continue_search(fitter, _begun(fitter, start), {}, progress)


def confirm(
    fitter: HypothesisFitter, found: Selection, progress: Callable[[float], None] | None = None
) -> Selection | None:
    """Search on from what was found under another noise; None where not all of that holds its place."""
    if not found.chosen.members:
        return None
    begun, kept = _begun(fitter, found.chosen.members), frozenset(found.chosen.by_key)
    if _challenged(fitter, begun.chosen, [], {}) is not None:
        return None
    begun = replace(begun, steps=(*found.steps, *begun.steps), through=frozenset({kept}))
    more = continue_search(fitter, begun, {}, progress)
    return more if kept <= more.chosen.by_key.keys() else None


def continue_search(
    fitter: HypothesisFitter,
    so_far: Selection,
    excluded_kinds: dict[Key, float],
    progress: Callable[[float], None] | None = None,
    *,
    known: Collection[Keys] = (),
) -> Selection:
    """Search for more causes than those found so far, until no more are found.

    Parameters
    ----------
    known
        Sets of causes from which another search went on: one that comes to them would go the same way.
    """
    now, steps, through = so_far.chosen, list(so_far.steps), set(so_far.through)
    for number in range(len(now.members), MOST):
        if progress is not None:
            progress(number / MOST)
        better = best_entry(fitter, now, excluded_kinds)
        if better is None:
            break
        steps.append(Step("added", better.members[-1], likelihood_ratio(now, better)))
        larger = refine_jointly(fitter, better)
        if now.members and now.possible and not larger.possible:
            # Beside it nature would not allow what was found before.
            steps.append(Step("dropped", better.members[-1], likelihood_ratio(now, better)))
            excluded_kinds[better.members[-1].key] = np.inf
            fitter.believe(now)
            continue
        for now in _defended(fitter, larger, steps, excluded_kinds):
            through.add(frozenset(now.by_key))
            if frozenset(now.by_key) in known:
                return Selection(so_far.none, now, tuple(steps), frozenset(through))
    return Selection(so_far.none, now, tuple(steps), frozenset(through))


def _begun(fitter: HypothesisFitter, start: Sequence[Candidate]) -> Selection:
    """Begin a search with causes that are known; with none, from the standard model."""
    none = fitter.tried(())
    fitter.believe(none)
    now = refine_jointly(fitter, fitter.tried(tuple(start))) if start else none
    return Selection(none, now, tuple(Step("kept", one, 0.0) for one in start))


def start_with(fitter: HypothesisFitter, now: Hypothesis, cause: str) -> Hypothesis | None:
    """Give a hypothesis with one cause of the whole robot besides; None where it is not clear enough."""
    scans = fitter.scanned(now, fitter.suspicion.of_kind((cause, ())))
    trials = [with_candidate(fitter, now, one) for one in scans]
    clear = (one for one in trials if one.possible and is_significant(fitter, now, one, fitter.kinds))
    first = next(clear, None)
    return None if first is None else refine_jointly(fitter, first)


def _defended(
    fitter: HypothesisFitter, now: Hypothesis, steps: list[Step], excluded_kinds: dict[Key, float]
) -> Iterator[Hypothesis]:
    """Let every member defend its place against being dropped and against its rivals; give what that leaves.

    Two causes can each look better than the other where the other is believed: a swap that leads back to
    what was settled before ends the matter.
    """
    yield now
    settled_before = [now.by_key.keys()]
    for _ in range(2 * MOST):
        changed = _challenged(fitter, now, steps, excluded_kinds)
        if changed is None:
            return
        if len(changed.members) == len(now.members):
            # What was swapped out is not believed any more, even where the new one is left alone.
            fitter.believe(fitter.tried(changed.members[:-1], changed))
            now = refine_jointly(fitter, changed)
        else:
            fitter.believe(changed)
            now = fitter.tried(changed.members, changed)
        yield now
        if now.by_key.keys() in settled_before:
            return
        settled_before.append(now.by_key.keys())


def _challenged(
    fitter: HypothesisFitter, now: Hypothesis, steps: list[Step], excluded_kinds: dict[Key, float]
) -> Hypothesis | None:
    less = fitter.less(now)
    brings = [likelihood_ratio(without, now) for without in less]
    weak = [
        index
        for index, without in enumerate(less)
        if not passes_exit_test(fitter, without, now, index) or is_masked(fitter, now, index, without)
    ]
    if weak:
        least = min(weak, key=lambda index: brings[index])
        steps.append(Step("dropped", now.members[least], brings[least]))
        excluded_kinds[now.members[least].key] = np.inf
        return less[least]
    for index, member in enumerate(now.members):
        closed = {**excluded_kinds, member.key: np.inf}
        if not member.cause.traits.transient:
            # What acts at picked instants only does not take the place of what acts all the time.
            closed |= {one.key: np.inf for one in fitter.candidates if one.cause.traits.transient}
        hurdle = bic_gain(less[index], now, index) + BETTER
        rival = best_entry(fitter, less[index], closed, RIVALS, hurdle)
        if rival is not None:
            steps.append(Step("swapped", rival.members[-1], likelihood_ratio(now, rival)))
            excluded_kinds[member.key] = BESIDE_SHARE * brings[index]
            return rival
    return None
