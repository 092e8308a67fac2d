"""Settle a hypothesis: what is believed, the scalars of all members, and their sizes, each on the others.

A cause that joins changes what the others look like: the torque at which another joint's amplifier clips is
another one once a scale is known to be wrong, and a lag moves an elasticity found beside it, and is moved by
it. Source: Golub & Pereyra, SIAM J. Numer. Anal. 10(2), 1973, on settling nonlinear parameters by turns.
"""

from dataclasses import replace

from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis
from .likelihood_ratio import likelihood_ratio
from .profile_likelihood import refine_scalars, with_deviations

REFINEMENTS = 8
"""Times that what is believed and what is found are settled on each other at most,"""
WORTH_REFINING = 6.0
"""as long as that raises twice the log-likelihood by as much."""
KEPT = 0.5
"""Share of what an effect brings that has to be left of it where it is believed."""


def refine_jointly(fitter: HypothesisFitter, better: Hypothesis) -> Hypothesis:
    """Believe what a hypothesis found and settle it under that, again and again as long as that helps.

    Columns are of first order, and what is believed may be wrong in what the rows do not tell: where
    believing an effect makes it larger than nature allows, or takes most of what it brings, it is left alone.
    """
    believe_first = fitter.remembered()
    now = _settled_once(fitter, better)
    impossible, believe_now = better.possible and not now.allows(-1), fitter.remembered()
    believe_first()
    if impossible or _costs_too_much(fitter, better, now):
        return _with_settled(fitter, better, len(better.members) - 1)
    believe_now()
    for _ in range(REFINEMENTS - 1):
        believe_before = fitter.remembered()
        again = _settled_once(fitter, now)
        if likelihood_ratio(now, again) < WORTH_REFINING or (now.possible and not again.possible):
            believe_before()
            break
        now = again
    return now


def _costs_too_much(fitter: HypothesisFitter, better: Hypothesis, now: Hypothesis) -> bool:
    """Tell whether most of what a hypothesis's last member brings is lost where it is believed."""
    if likelihood_ratio(better, now) > -WORTH_REFINING:
        return False
    without = fitter.tried(better.members[:-1], better)
    return likelihood_ratio(without, now) < KEPT * likelihood_ratio(without, better)


def _settled_once(fitter: HypothesisFitter, better: Hypothesis) -> Hypothesis:
    """Believe what a hypothesis found, and settle all scalars anew under that, the last member's first."""
    fitter.believe(better)
    now, last = fitter.tried(better.members, better), len(better.members) - 1
    for index in (last, *range(last)):
        now = _with_settled(fitter, now, index)
    return now


def _with_settled(fitter: HypothesisFitter, now: Hypothesis, index: int) -> Hypothesis:
    """Settle one member; where nature would not allow that, leave it and tell how well it is known."""
    member, beneath = now.members[index], fitter.beneath(now, index)
    found = fitter.scanned(beneath, [*fitter.suspicion.of(member.cause, member.site), member])[0]
    moved = fitter.tried(_put(now.members, index, refine_scalars(fitter, beneath, found.candidate)), now)
    if moved.possible or not now.possible:
        return moved
    return replace(now, members=_put(now.members, index, with_deviations(fitter, beneath, member)))


def _put(members: tuple[Candidate, ...], index: int, member: Candidate) -> tuple[Candidate, ...]:
    return (*members[:index], member, *members[index + 1 :])
