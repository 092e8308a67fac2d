"""Find the corrections of a set-up that predict best, each by itself.

Every hypothesis is one set-up. Least squares bounds how well it can fit. Those that can still fit as well as
the best are fitted with the constraints, best bound first, and judged on rows that were not fitted.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from .conflict import Hypothesis
from .equations import Equations
from .kinds.gear_ratio import GearRatio
from .kinds.unit import Unit
from .path import FoundConflict, Margins, Path
from .reduced import stacked
from .registry import CONFLICTS
from .setup import Setup
from .thresholds import DECISION, TRIAL
from .trial import Outcome, Trials


@dataclass(frozen=True)
class _Needed:
    """Hold what hypotheses have to gain."""

    alone: float
    """What one has to that least squares shows by itself."""
    among: float
    """What the best of all has to."""

    def by(self, own: Hypothesis) -> float:
        """Give what a hypothesis has to gain."""
        return self.alone if own.is_significant else self.among


@dataclass(frozen=True, eq=False)
class _Bounded:
    hypothesis: Hypothesis
    equations: Equations
    bound: float


@dataclass(frozen=True, eq=False)
class _Tried:
    hypothesis: Hypothesis
    outcome: Outcome
    score: float
    """Mean logarithm of the errors, less what an expected correction need not gain, and more by what several
    corrections in one have to."""

    def step(self, before: Outcome, confidence: float, near: "list[_Tried]") -> FoundConflict:
        """Give the conflict, with those of the near ones that are of another kind or joint."""
        others = (other.hypothesis for other in near)
        equivalents = tuple(other for other in others if other.key != self.hypothesis.key)
        return FoundConflict(self.hypothesis, before, self.outcome, confidence, equivalents)


@dataclass(frozen=True, eq=False)
class Steps:
    """Hold first steps."""

    best: Path
    """Those that predict best, first the most usual of those that predict alike."""
    _present: Outcome
    _listed: Sequence[_Bounded]
    _tried: Sequence[_Tried]
    _needed: _Needed

    def alternatives(self, trials: Trials) -> Path:
        """Give the next best, one of each kind and factor: one error may mask another.

        The right first step is then not the best, and need not have been fitted for the best to be found.
        """
        taken = {_subject(step.hypothesis) for step in self.best}
        others = [own for own in self._listed if _subject(own.hypothesis) not in taken]
        best = [self._best_of(kind, others, trials) for kind in CONFLICTS]
        ranked = sorted((own for own in best if own is not None), key=_score)[: TRIAL.alternatives]
        first = {_subject(own.hypothesis): own for own in reversed(ranked)}
        apart = [own for own in ranked if first[_subject(own.hypothesis)] is own]
        return tuple(own.step(self._present, self.best[0].confidence, []) for own in apart)

    def _best_of(self, kind: str, others: Sequence[_Bounded], trials: Trials) -> _Tried | None:
        """Give the hypothesis of one kind that predicts best, if better than the set-up."""
        fitted = {own.hypothesis: own for own in self._tried}
        some = [own for own in others if own.hypothesis.conflict == kind and _can_gain(own, self._present)]
        likeliest = sorted(some, key=_bound)[: TRIAL.of_kind]
        tried = [fitted.get(own.hypothesis) or _try(own, trials, self._needed) for own in likeliest]
        return min(_better(filter(None, tried), self._present, self._needed), key=_score, default=None)


def first_steps(setup: Setup, present: Outcome, trials: Trials, reach: float = np.inf) -> Steps:
    """Try every hypothesis, and sort those that predict better than the set-up by more than chance.

    Those that cannot come near the score that they have to reach are not fitted.
    """
    listed = _bounded(setup, trials)
    margins = Margins.of(present, trials)
    needed = _Needed(margins.undecided, margins.needed(len(listed)))
    tried = _tried(listed, present, trials, needed, reach)
    better = _better(tried, present, needed)
    best = min(map(_score, better), default=present.score)
    near = [own for own in better if own.score < best + margins.undecided]
    near.sort(key=lambda own: own.score > best + margins.equal)
    worse = [*(own.score for own in better if own not in near), *[present.score] * len(listed)]
    confidence = 1.0 / (1.0 + sum(margins.likelihood(score - best) for score in worse))
    steps = tuple(own.step(present, confidence, near) for own in near)
    return Steps(steps, present, listed, tried, needed)


def least_squares_gain(setup: Setup, trials: Trials) -> float:
    """Give by how much the mean logarithm of the joints' errors falls at best, on the fitted rows."""
    least = min((own.bound for own in _bounded(setup, trials)), default=np.inf)
    return max(float(trials.equations(setup).reduced.bound) - least, 0.0)


def _bounded(setup: Setup, trials: Trials) -> list[_Bounded]:
    """List every hypothesis with its bound, in order of preference."""
    listed = [own for conflict in CONFLICTS.values() for own in conflict.hypotheses(setup, trials)]
    equations = [trials.equations(hypothesis.setup) for hypothesis in listed]
    bounds = np.zeros(len(listed))
    for alike in _by_motion(equations):
        bounds[alike] = stacked([equations[place].reduced for place in alike]).bound
    return [_Bounded(*parts) for parts in zip(listed, equations, bounds.tolist(), strict=True)]


def _by_motion(equations: list[Equations]) -> Iterable[list[int]]:
    """Give the places of those with one motion together."""
    places: dict[int, list[int]] = {}
    for place, own in enumerate(equations):
        places.setdefault(id(own.regressor), []).append(place)
    return places.values()


def _tried(
    listed: list[_Bounded], present: Outcome, trials: Trials, needed: _Needed, reach: float
) -> list[_Tried]:
    """Fit those that can still win, best bound first; give them in order of preference."""
    tried: list[tuple[int, _Tried]] = []
    best = min(present.fitted, reach)
    for place, candidate in sorted(enumerate(listed), key=lambda pair: pair[1].bound):
        if candidate.bound > best + DECISION.least_gain:
            break
        if not (candidate.hypothesis.expected or _can_gain(candidate, present)):
            continue
        found = _try(candidate, trials, needed)
        if found is not None:
            tried.append((place, found))
            best = min(best, found.outcome.fitted)
    return [candidate for _, candidate in sorted(tried, key=lambda pair: pair[0])]


def _can_gain(candidate: _Bounded, present: Outcome) -> bool:
    """Tell whether a hypothesis changes what least squares can do, or the constraints cost so much.

    Otherwise it is the same robot said otherwise, and no fit tells it from the set-up as it is.
    """
    changes = candidate.bound < present.bound and not np.isclose(candidate.bound, present.bound)
    return bool(changes or candidate.bound < present.fitted - DECISION.least_gain)


def _try(candidate: _Bounded, trials: Trials, needed: _Needed) -> _Tried | None:
    own, outcome = candidate.hypothesis, trials.outcome(candidate.hypothesis.setup)
    if outcome is None or _is_guessed(own, outcome):
        return None
    credit = needed.by(own) if own.expected else -DECISION.least_gain * (own.corrections - 1)
    return _Tried(own, outcome, outcome.score - credit)


def _is_guessed(own: Hypothesis, outcome: Outcome) -> bool:
    """Tell whether a factor is put on a torque of which hardly any variation is predicted: any is as good."""
    places = [joint - 1 for joint in own.joints]
    scales = own.channel == "torque" and _subject(own)[0] == "factor"
    return scales and bool(np.any(outcome.unpredicted[places] > DECISION.scaled))


def _better(tried: Iterable[_Tried], present: Outcome, needed: _Needed) -> list[_Tried]:
    """Give those that predict better than a set-up by more than chance."""
    return [own for own in tried if own.score <= present.score - needed.by(own.hypothesis)]


def _subject(hypothesis: Hypothesis) -> tuple[object, ...]:
    """Give what is corrected: whether by a unit or a ratio, a factor of a torque leads on alike."""
    factor = hypothesis.conflict in {Unit.name, GearRatio.name}
    return "factor" if factor else hypothesis.conflict, *hypothesis.key[1:]


def _bound(candidate: _Bounded) -> float:
    return candidate.bound


def _score(candidate: _Tried) -> float:
    return candidate.score
