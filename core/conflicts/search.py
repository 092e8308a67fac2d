"""Find the corrections under which description and logs agree.

Every hypothesis is one set-up. Least squares bounds how well it can fit. Those that can still fit as well as
the best are fitted with the constraints, best bound first, and judged on rows that were not fitted. The best
is applied and the search goes on from it, until none is better than chance and their number explain.
"""

from dataclasses import dataclass

import numpy as np

from .conflict import Hypothesis
from .registry import CONFLICTS
from .setup import Setup
from .thresholds import DECISION, TRIAL
from .trial import Equations, Outcome, Trials


@dataclass(frozen=True, eq=False)
class FoundConflict:
    """Hold a conflict that was found, and what it was compared with."""

    hypothesis: Hypothesis
    before: Outcome
    after: Outcome
    confidence: float
    """Probability that it, or one of those it cannot be told apart from, is the right correction."""
    equivalents: tuple[Hypothesis, ...]
    """Hypotheses of other kinds or joints that predict as well."""


@dataclass(frozen=True, eq=False)
class _Tried:
    hypothesis: Hypothesis
    outcome: Outcome


def find_conflicts(setup: Setup, trials: Trials) -> tuple[FoundConflict, ...]:
    """Search for corrections of a set-up, one after the other; the last one's set-up holds them all."""
    found: list[FoundConflict] = []
    present = trials.outcome(trials.equations(setup))
    while present is not None and len(found) < TRIAL.most_corrections:
        conflict = _best(_bounded(setup, trials), present, trials)
        if conflict is None:
            break
        found.append(conflict)
        setup, present = conflict.hypothesis.setup, conflict.after
    return tuple(found)


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
            listed.append(_Bounded(hypothesis, equations, trials.bound(equations)))
    return listed


def _best(listed: list[_Bounded], present: Outcome, trials: Trials) -> FoundConflict | None:
    """Choose the hypothesis that predicts best, the most usual of those that predict alike."""
    independent = trials.samples.independent * len(present.errors)
    margin, equal = (0.5 * decided / independent for decided in (DECISION.undecided, DECISION.equal))
    tried = _tried(listed, present, trials)
    best = min((candidate.outcome.score for candidate in tried), default=present.score)
    chance = margin + np.log(max(len(listed), 1)) / independent
    if present.score - best < max(DECISION.least_gain, chance):
        return None
    near = [candidate for candidate in tried if candidate.outcome.score < best + margin]
    chosen = next(candidate for candidate in near if candidate.outcome.score <= best + equal)

    def likelihood(outcome: Outcome) -> float:
        return float(np.exp(independent * (best - outcome.score)))

    others = sum(likelihood(candidate.outcome) for candidate in tried if candidate not in near)
    confidence = 1.0 / (1.0 + others + len(listed) * likelihood(present))
    equivalents = tuple(
        candidate.hypothesis for candidate in near if candidate.hypothesis.key != chosen.hypothesis.key
    )
    return FoundConflict(chosen.hypothesis, present, chosen.outcome, confidence, equivalents)


def _tried(listed: list[_Bounded], present: Outcome, trials: Trials) -> list[_Tried]:
    """Fit those that can still win, best bound first; give them in order of preference."""
    tried: list[tuple[int, _Tried]] = []
    best = present.fitted
    for place, candidate in sorted(enumerate(listed), key=lambda pair: pair[1].bound):
        if candidate.bound > best + DECISION.least_gain:
            break
        outcome = trials.outcome(candidate.equations)
        if outcome is not None:
            tried.append((place, _Tried(candidate.hypothesis, outcome)))
            best = min(best, outcome.fitted)
    return [candidate for _, candidate in sorted(tried, key=lambda pair: pair[0])]
