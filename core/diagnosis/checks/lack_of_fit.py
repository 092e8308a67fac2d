"""Look for what is in no list: beside what was found, and in the place of what was found.

A pattern without a name that explains much better than a named cause refutes the name; one that explains what
is left shows that something is left. Either must be as sure as a named cause has to be.
"""

from dataclasses import replace

from ..search.entry_test import clear_enough, holds_unseen
from ..search.fitter import Bench
from ..search.hypothesis import Candidate, Hypothesis
from ..search.likelihood_ratio import merit
from .unnamed_pattern import Unlisted

TRIED = 3
_UNLISTED = Unlisted()


def strangers(bench: Bench) -> tuple[Candidate, ...]:
    """Give the patterns that are looked for under the present belief."""
    return tuple(
        Candidate(_UNLISTED, site, scalars, _UNLISTED.trials(grid, scalars))
        for site in _UNLISTED.sites(bench.look, bench.believed)
        for grid in [tuple(_UNLISTED.grid(bench.look, bench.believed, site))]
        for scalars in grid
    )


def best_stranger(bench: Bench, now: Hypothesis, suspects: tuple[Candidate, ...]) -> Hypothesis | None:
    """Give a hypothesis with the pattern that explains most of what another leaves; None where none does."""
    scans = bench.scanned(now, suspects)[:TRIED]
    trials = [bench.added(now, _finest(bench, now, one.candidate)) for one in scans]
    clear = [trial for trial in trials if clear_enough(bench, now, trial, bench.look.joints)]
    whole = [bench.tried(trial.members, trial) for trial in clear]
    ranked = sorted(whole, key=lambda trial: -merit(now, trial))
    return next((trial for trial in ranked if holds_unseen(bench, now, trial)), None)


def _finest(bench: Bench, now: Hypothesis, found: Candidate) -> Candidate:
    """Give the likeliest of the patterns around one."""
    around = [replace(found, scalars=scalars) for scalars in _UNLISTED.finer(bench.look, found.scalars)]
    best = max(zip(bench.scored(now, around), around, strict=True), key=lambda one: one[0].statistic)[1]
    return replace(best, trials=found.trials * len(around))
