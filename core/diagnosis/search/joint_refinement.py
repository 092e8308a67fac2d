"""Refine a hypothesis: operating point, scalars of all members and their sizes, by block coordinate descent.

A cause that enters changes the others. A corrected torque gain changes the torque at which an amplifier
saturates; a lag and a joint elasticity found beside it change each other. Source: Golub & Pereyra, SIAM J.
Numer. Anal. 10(2), 1973, on refining nonlinear parameters by turns.
"""

from dataclasses import replace

from ..thresholds.search import MASKING, REFINEMENT, SELECTION
from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis
from .likelihood_ratio import likelihood_ratio
from .profile_likelihood import refine_scalars, with_deviations
from .state import SearchState


def refine_jointly(state: SearchState) -> SearchState:
    """Linearise at the chosen hypothesis and refine it there, again and again as long as that helps.

    Columns are of first order, and the operating point may be wrong in what the rows do not determine. Where
    linearising at an effect makes it inadmissible, or takes most of what it brings, only the last member's
    scalars are refined, at the operating point as it is.
    """
    chosen = state.chosen
    now = _refine_once(state)
    inadmissible = chosen.admissible and not now.chosen.admits(-1)
    if inadmissible or _costs_too_much(state.fitter, chosen, now.chosen):
        return state.at(state.fitter, _refine_member(state.fitter, chosen, len(chosen.members) - 1))
    for _ in range(REFINEMENT.rounds - 1):
        again = _refine_once(now)
        gained = likelihood_ratio(now.chosen, again.chosen)
        if gained < SELECTION.undecided or (now.chosen.admissible and not again.chosen.admissible):
            break
        now = again
    return now


def _costs_too_much(fitter: HypothesisFitter, before: Hypothesis, after: Hypothesis) -> bool:
    """Tell whether linearising at a hypothesis loses most of what its last member brings."""
    if likelihood_ratio(before, after) > -SELECTION.undecided:
        return False
    without = fitter.fit(before.members[:-1], before)
    return likelihood_ratio(without, after) < MASKING.kept * likelihood_ratio(without, before)


def _refine_once(state: SearchState) -> SearchState:
    """Linearise at the chosen hypothesis, and refine all members' scalars there, the last one's first."""
    fitter = state.fitter.linearised_at(state.chosen)
    now, last = fitter.fit(state.chosen.members, state.chosen), len(state.chosen.members) - 1
    for index in (last, *range(last)):
        now = _refine_member(fitter, now, index)
    return state.at(fitter, now)


def _refine_member(fitter: HypothesisFitter, now: Hypothesis, index: int) -> Hypothesis:
    """Refine one member; where that would be inadmissible, leave it and only give its deviations."""
    member, without = now.members[index], fitter.fit_without(now, index)
    found = fitter.scan(without, [*fitter.at.of(member.cause, member.site), member])[0]
    moved = fitter.fit(_put(now.members, index, refine_scalars(fitter, without, found.candidate)), now)
    if moved.admissible or not now.admissible:
        return moved
    return replace(now, members=_put(now.members, index, with_deviations(fitter, without, member)))


def _put(members: tuple[Candidate, ...], index: int, member: Candidate) -> tuple[Candidate, ...]:
    return (*members[:index], member, *members[index + 1 :])
