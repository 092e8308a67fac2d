"""Find the corrections of a set-up that predict best, each by itself.

Every hypothesis is one set-up. Least squares bounds how well it can fit. Those that can still fit as well as
the best are fitted with the constraints, best bound first, and judged on rows that were not fitted.
"""

from dataclasses import dataclass

from .conflict import Hypothesis
from .path import FoundConflict, Margins, Path
from .registry import CONFLICTS
from .setup import Setup
from .thresholds import DECISION, TRIAL
from .trial import Equations, Outcome, Trials


@dataclass(frozen=True, eq=False)
class Steps:
    """Hold first steps."""

    best: Path
    """Those that predict best, first the most usual of those that predict alike."""
    alternatives: Path
    """The next best: one error may mask another, so that the right first step is not the best."""


def first_steps(setup: Setup, present: Outcome, trials: Trials) -> Steps:
    """Try every hypothesis, and sort those that predict better than the set-up by more than chance."""
    listed = _bounded(setup, trials)
    margins = Margins.of(present, trials)
    needed = margins.needed(len(listed))
    tried = [own for own in _tried(listed, present, trials, needed) if own.score <= present.score - needed]
    best = min((own.score for own in tried), default=present.score)
    limit = best + margins.undecided
    near = sorted(
        (own for own in tried if own.score < limit), key=lambda own: own.score > best + margins.equal
    )
    far = sorted((own for own in tried if own.score >= limit), key=lambda own: own.score)
    worse = [*(own.score for own in far), *[present.score] * len(listed)]
    confidence = 1.0 / (1.0 + sum(margins.likelihood(score - best) for score in worse))
    steps = [own.step(present, confidence, near) for own in (*near, *far[: TRIAL.alternatives])]
    return Steps(tuple(steps[: len(near)]), tuple(steps[len(near) :]))


@dataclass(frozen=True, eq=False)
class _Bounded:
    hypothesis: Hypothesis
    equations: Equations
    bound: float


def _bounded(setup: Setup, trials: Trials) -> list[_Bounded]:
    """List every hypothesis with its bound, in order of preference."""
    listed = []
    for conflict in CONFLICTS.values():
        for hypothesis in conflict.hypotheses(setup, trials):
            equations = trials.equations(hypothesis.setup)
            listed.append(_Bounded(hypothesis, equations, equations.normal.bound))
    return listed


@dataclass(frozen=True, eq=False)
class _Tried:
    hypothesis: Hypothesis
    outcome: Outcome
    score: float
    """Mean logarithm of the errors, less what an expected correction need not gain."""

    def step(self, before: Outcome, confidence: float, near: "list[_Tried]") -> FoundConflict:
        """Give the conflict, with those of the near ones that are of another kind or joint."""
        others = (other.hypothesis for other in near)
        equivalents = tuple(other for other in others if other.key != self.hypothesis.key)
        return FoundConflict(self.hypothesis, before, self.outcome, confidence, equivalents)


def _tried(listed: list[_Bounded], present: Outcome, trials: Trials, needed: float) -> list[_Tried]:
    """Fit those that can still win, best bound first; give them in order of preference."""
    tried: list[tuple[int, _Tried]] = []
    best = present.fitted
    for place, candidate in sorted(enumerate(listed), key=lambda pair: pair[1].bound):
        if candidate.bound > best + DECISION.least_gain:
            break
        outcome = trials.outcome(candidate.equations)
        if outcome is not None:
            score = outcome.score - needed * candidate.hypothesis.expected
            tried.append((place, _Tried(candidate.hypothesis, outcome, score)))
            best = min(best, outcome.fitted)
    return [candidate for _, candidate in sorted(tried, key=lambda pair: pair[0])]
