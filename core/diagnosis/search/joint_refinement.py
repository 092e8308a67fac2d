"""Settle a hypothesis: what is believed, the scalars of all members, and their sizes, each on the others.

A cause that joins changes what the others look like: the torque at which another joint's amplifier clips is
another one once a scale is known to be wrong, and a lag moves an elasticity found beside it, and is moved by
it. Source: Golub & Pereyra, SIAM J. Numer. Anal. 10(2), 1973, on settling nonlinear parameters by turns.
"""

from dataclasses import replace

from .fitter import Bench
from .hypothesis import Candidate, Hypothesis
from .likelihood_ratio import rise
from .profile_likelihood import refined, told

SETTLINGS = 8
"""Times that what is believed and what is found are settled on each other at most,"""
WORTH_SETTLING = 6.0
"""as long as that raises twice the log-likelihood by as much."""
KEPT = 0.5
"""Share of what an effect brings that has to be left of it where it is believed."""


def settled(bench: Bench, better: Hypothesis) -> Hypothesis:
    """Believe what a hypothesis found and settle it under that, again and again as long as that helps.

    Columns are of first order, and what is believed may be wrong in what the rows do not tell: where
    believing an effect makes it larger than nature allows, or takes most of what it brings, it is left alone.
    """
    believe_first = bench.remembered()
    now = _settled_once(bench, better)
    impossible, believe_now = better.possible and not now.allows(-1), bench.remembered()
    believe_first()
    if impossible or _costs_too_much(bench, better, now):
        return _with_settled(bench, better, len(better.members) - 1)
    believe_now()
    for _ in range(SETTLINGS - 1):
        believe_before = bench.remembered()
        again = _settled_once(bench, now)
        if rise(now, again) < WORTH_SETTLING or (now.possible and not again.possible):
            believe_before()
            break
        now = again
    return now


def _costs_too_much(bench: Bench, better: Hypothesis, now: Hypothesis) -> bool:
    """Tell whether most of what a hypothesis's last member brings is lost where it is believed."""
    if rise(better, now) > -WORTH_SETTLING:
        return False
    without = bench.tried(better.members[:-1], better)
    return rise(without, now) < KEPT * rise(without, better)


def _settled_once(bench: Bench, better: Hypothesis) -> Hypothesis:
    """Believe what a hypothesis found, and settle all scalars anew under that, the last member's first."""
    bench.believe(better)
    now, last = bench.tried(better.members, better), len(better.members) - 1
    for index in (last, *range(last)):
        now = _with_settled(bench, now, index)
    return now


def _with_settled(bench: Bench, now: Hypothesis, index: int) -> Hypothesis:
    """Settle one member; where nature would not allow that, leave it and tell how well it is known."""
    member, beneath = now.members[index], bench.beneath(now, index)
    found = bench.scanned(beneath, [*bench.suspicion.of(member.cause, member.site), member])[0]
    moved = bench.tried(_put(now.members, index, refined(bench, beneath, found.candidate)), now)
    if moved.possible or not now.possible:
        return moved
    return replace(now, members=_put(now.members, index, told(bench, beneath, member)))


def _put(members: tuple[Candidate, ...], index: int, member: Candidate) -> tuple[Candidate, ...]:
    return (*members[:index], member, *members[index + 1 :])
