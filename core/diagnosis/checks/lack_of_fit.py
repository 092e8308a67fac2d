"""Test for lack of fit: unnamed patterns beside the findings, and in the place of a finding.

An unnamed pattern that explains much more than a named cause refutes the name. One that explains what is left
shows lack of fit. Either must be as significant as a named cause.
"""

from dataclasses import replace

from ..causes.protocol import Setting, Site
from ..search.entry_test import is_significant, passes_holdout
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Candidate, Hypothesis, candidates_of
from ..search.likelihood_ratio import bic_gain
from ..thresholds.checks import UNNAMED
from .unnamed_pattern import UnnamedPatternCause

_UNLISTED = UnnamedPatternCause()


def unnamed_candidates(fitter: HypothesisFitter) -> tuple[Candidate, ...]:
    """Give the unnamed patterns as candidates at the operating point."""
    return tuple(
        candidate
        for site in _UNLISTED.sites(fitter.dataset)
        for candidate in candidates_of(_UNLISTED, Setting(fitter.dataset, fitter.operating_point, site))
    )


def loop_candidates(fitter: HypothesisFitter, site: Site) -> tuple[Candidate, ...]:
    """Give the loops in which a joint may lag behind the logged positions, at the operating point."""
    loops = _UNLISTED.loops(Setting(fitter.dataset, fitter.operating_point, site))
    return tuple(Candidate(_UNLISTED, site, scalars, float(len(loops))) for scalars in loops)


def smoothed_candidates(fitter: HypothesisFitter, seconds: float) -> tuple[Candidate, ...]:
    """Give, joint by joint, a torque that was smoothed by a moving mean of this length, s."""
    scalars = _UNLISTED.smoothed(seconds)
    return tuple(Candidate(_UNLISTED, site, scalars, 1.0) for site in _UNLISTED.sites(fitter.dataset))


def best_unnamed_pattern(
    fitter: HypothesisFitter, now: Hypothesis, unnamed: tuple[Candidate, ...]
) -> Hypothesis | None:
    """Give a hypothesis with the pattern that explains most of what another leaves; None where none does."""
    scans = fitter.scan(now, unnamed)[: UNNAMED.tried]
    trials = [fitter.fit_with(now, _refine_pattern(fitter, now, scan.candidate)) for scan in scans]
    clear = [trial for trial in trials if is_significant(fitter, now, trial, fitter.dataset.joints)]
    whole = [fitter.fit(trial.members, trial) for trial in clear]
    ranked = sorted(whole, key=lambda trial: -bic_gain(now, trial))
    return next((trial for trial in ranked if passes_holdout(fitter, now, trial)), None)


def _refine_pattern(fitter: HypothesisFitter, now: Hypothesis, found: Candidate) -> Candidate:
    """Refine a pattern: give the likeliest around one."""
    around = [replace(found, scalars=scalars) for scalars in _UNLISTED.finer(fitter.dataset, found.scalars)]
    best = max(zip(fitter.score(now, around), around, strict=True), key=lambda pair: pair[0].statistic)[1]
    return replace(best, trials=found.trials * len(around))
