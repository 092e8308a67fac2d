"""Select causes stepwise: forward, with exits and swaps, each step judged under its own noise.

Greedy order is the weak point of forward selection, because the first cause chosen may stand for two others.
So after every step each member is tested for exit and against a swap with every other candidate.
Source: Miller, Subset Selection in Regression (2002), ch. 3.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..thresholds.search import MASKING, SEARCH, SELECTION
from .confounding import is_masked
from .entry_test import best_entry, is_significant, passes_exit_test, with_candidate
from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis
from .joint_refinement import refine_jointly
from .likelihood_ratio import bic_gain, likelihood_ratio
from .state import Keys, SearchState, Step


def search_stepwise(
    fitter: HypothesisFitter, progress: Callable[[float], None] | None = None, start: Sequence[Candidate] = ()
) -> SearchState:
    """Search for the causes that explain the rows, from known ones if there are any."""
    return continue_search(_start(fitter, start), progress)


def confirm(
    fitter: HypothesisFitter, found: SearchState, progress: Callable[[float], None] | None = None
) -> SearchState | None:
    """Search on from what was found under another noise; None where not all of that stays."""
    if not found.chosen.members:
        return None
    begun = _start(fitter, found.chosen.members)
    if _exit_or_swap(begun) is not None:
        return None
    begun = replace(begun, steps=(*found.steps, *begun.steps), through=frozenset({found.keys}))
    more = continue_search(begun, progress)
    return more if found.keys <= more.keys else None


def continue_search(
    so_far: SearchState, progress: Callable[[float], None] | None = None, *, known: Collection[Keys] = ()
) -> SearchState:
    """Search for more causes than those found so far, until no more enter.

    Parameters
    ----------
    known
        Sets of causes from which another search went on: one that comes to them would go the same way.
    """
    state = so_far
    for number in range(SEARCH.causes * state.fitter.dataset.joints):
        if _counted(state.chosen.members, state.fitter.dataset.joints) >= SEARCH.causes:
            break
        if progress is not None:
            progress(number / (number + SEARCH.causes))
        better = best_entry(state.fitter, state.chosen, state.excluded)
        if better is None:
            break
        entered, statistic = better.members[-1], likelihood_ratio(state.chosen, better)
        before = state.recorded("added", entered, statistic)
        larger = refine_jointly(before.at(state.fitter, better))
        if before.chosen.members and before.chosen.admissible and not larger.chosen.admissible:
            # Beside it what was found before would be inadmissible.
            before = before.linearised_at(before.chosen).recorded("dropped", entered, statistic)
            state = before.excluding(entered.key)
            continue
        through = state.through
        for changed in _exits_and_swaps(larger):
            through |= {changed.keys}
            state = replace(changed, through=through)
            if state.keys in known:
                return state
    return state


def _counted(members: Sequence[Candidate], joints: int) -> int:
    """Count members; a cause that acts on most joints is one property of the robot."""
    number = Counter(member.cause.id for member in members)
    return sum(1 if 2 * own > joints else own for own in number.values())


def _start(fitter: HypothesisFitter, start: Sequence[Candidate]) -> SearchState:
    """Start a search with causes that are known; with none, from the standard model."""
    none = fitter.fit(())
    state = SearchState(fitter.linearised_at(none), none, none)
    if start:
        state = refine_jointly(state.at(state.fitter, state.fitter.fit(tuple(start))))
    return replace(state, steps=tuple(Step("kept", candidate, 0.0) for candidate in start))


def start_with(state: SearchState, cause: str) -> SearchState | None:
    """Add one cause of the whole robot to a hypothesis; None where it is not significant."""
    fitter, now, kinds = state.fitter, state.chosen, state.fitter.kinds
    scans = fitter.scan(now, fitter.at.of_kind((cause, ())))
    trials = [with_candidate(fitter, now, scored) for scored in scans]
    clear = (trial for trial in trials if trial.admissible and is_significant(fitter, now, trial, kinds))
    first = next(clear, None)
    return None if first is None else refine_jointly(state.at(fitter, first))


def _exits_and_swaps(state: SearchState) -> Iterator[SearchState]:
    """Test every member for exit and for a swap, and give each state that this leads through.

    Two causes can each fit better than the other where the model is linearised at the other. A swap that
    leads back to an earlier set of causes ends the search.
    """
    yield state
    earlier = [state.keys]
    for _ in range(2 * max(SEARCH.causes, len(state.chosen.members))):
        changed = _exit_or_swap(state)
        if changed is None:
            return
        fitter, chosen = state.fitter, changed.chosen
        if len(chosen.members) == len(state.chosen.members):
            # The operating point is without what was swapped out, even where the new one is not refined.
            fitter = fitter.linearised_at(fitter.fit(chosen.members[:-1], chosen))
            state = refine_jointly(changed.at(fitter, chosen))
        else:
            state = changed.linearised_at(chosen)
        yield state
        if state.keys in earlier:
            return
        earlier.append(state.keys)


def _exit_or_swap(state: SearchState) -> SearchState | None:
    """Give the state after one exit or one swap, not yet refined; None where all members stay."""
    fitter, now = state.fitter, state.chosen
    smaller = fitter.fit_without_each(now)
    brings = [likelihood_ratio(without, now) for without in smaller]
    weak = [
        index
        for index, without in enumerate(smaller)
        if not passes_exit_test(fitter, without, now, index) or is_masked(fitter, now, index, without)
    ]
    if not weak:
        return _swap(state, smaller, brings)
    least = min(weak, key=lambda index: brings[index])
    member = now.members[least]
    return state.at(fitter, smaller[least]).recorded("dropped", member, brings[least]).excluding(member.key)


def _swap(state: SearchState, smaller: Sequence[Hypothesis], brings: Sequence[float]) -> SearchState | None:
    """Give the state with the first member swapped that another cause improves on; None where none does."""
    fitter, now = state.fitter, state.chosen
    for index, member in enumerate(now.members):
        closed = {**state.excluded, member.key: np.inf}
        if not member.cause.traits.transient:
            # A transient cause does not take the place of one that acts all the time.
            closed |= {other.key: np.inf for other in fitter.candidates if other.cause.traits.transient}
        hurdle = bic_gain(smaller[index], now, index) + SELECTION.undecided
        swapped = best_entry(fitter, smaller[index], closed, SEARCH.swaps, hurdle)
        if swapped is not None:
            after = state.at(fitter, swapped)
            after = after.recorded("swapped", swapped.members[-1], likelihood_ratio(now, swapped))
            return after.excluding(member.key, MASKING.kept * brings[index])
    return None
