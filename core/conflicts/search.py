"""Find the corrections under which description and logs agree.

Every hypothesis is one set-up. Least squares bounds how good it can be. Those that can still win are fitted
with the constraints, best bound first, and judged on rows that were not fitted. The best is applied and the
search goes on from it, until none is better than chance and the number of hypotheses explain.
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
    """Choose the hypothesis that predicts best, the most usual of those that predict as well."""
    independent = trials.samples.independent * len(present.errors)
    margin = DECISION.undecided / (2.0 * independent)
    tried: list[tuple[int, _Tried]] = []
    best = present.score
    for place, candidate in sorted(enumerate(listed), key=lambda pair: pair[1].bound):
        if candidate.bound > best + margin:
            break
        outcome = trials.outcome(candidate.equations)
        if outcome is not None:
            tried.append((place, _Tried(candidate.hypothesis, outcome)))
            best = min(best, outcome.score)
    needed = max(DECISION.least_gain, margin + np.log(max(len(listed), 1)) / independent)
    if present.score - best < needed:
        return None
    near = [one for _, one in sorted(tried, key=lambda pair: pair[0]) if one.outcome.score < best + margin]
    chosen, others = near[0], near[1:]
    weights = np.exp(-independent * (np.array([one.outcome.score for _, one in tried]) - best))
    rest = (
        sum(weights)
        - sum(weight for weight, (_, one) in zip(weights, tried, strict=True) if one in near)
        + len(listed) * np.exp(-independent * (present.score - best))
    )
    return FoundConflict(
        chosen.hypothesis,
        present,
        chosen.outcome,
        float(1.0 / (1.0 + rest)),
        tuple(one.hypothesis for one in others),
    )
