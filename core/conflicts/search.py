"""Find the corrections under which description and logs agree.

Every hypothesis is one set-up. Least squares bounds how well it can fit. Those that can still fit as well as
the best are fitted with the constraints, best bound first, and judged on rows that were not fitted. The best
is applied and the search goes on from it, until none is better than chance and their number explain. Where
several are best, the search goes on from each, and the fewest corrections are preferred.
"""

from dataclasses import dataclass, replace

import numpy as np

from .conflict import Hypothesis
from .path import FoundConflict, Path, cost
from .refinement import refined
from .registry import CONFLICTS
from .setup import Setup
from .thresholds import DECISION, DOUBT, TRIAL
from .trial import Equations, Outcome, Trials


@dataclass(frozen=True, eq=False)
class _Tried:
    hypothesis: Hypothesis
    outcome: Outcome

    def score(self, needed: float) -> float:
        """Give the error's mean logarithm; what an expected correction need not gain is in its favour."""
        return self.outcome.score - (needed if self.hypothesis.expected else 0.0)


def find_conflicts(setup: Setup, trials: Trials) -> Path:
    """Search for corrections of a set-up, one after the other; the last one's set-up holds them all."""
    present = trials.outcome(trials.equations(setup))
    path = () if present is None else _path(setup, present, trials, TRIAL.most_corrections)
    return refined(path, setup, trials)


def _path(setup: Setup, present: Outcome, trials: Trials, most: int) -> Path:
    """Give the corrections that lead on from a set-up.

    Where several predict alike and the first is not all, the search goes on from each of them. Several wrong
    ones may undo each other: a mirrored robot moves under mirrored gravity as the true one does. So
    paths are compared by their last error, to which each correction adds what one has to gain. Where all of
    them leave a joint in doubt, two errors may hide each other: the search goes on from the next best.
    """
    steps = _steps(_bounded(setup, trials), present, trials) if most else _Steps((), (), 0.0)
    paths: list[Path] = []

    def go_on(step: FoundConflict) -> Path:
        return (step, *_path(step.hypothesis.setup, step.after, trials, most - 1))

    for step in steps.best:
        paths.append(go_on(step))
        if len(paths[0]) == 1 and not _is_poor(step.after):
            return paths[0]
    ends = [path[-1].after for path in paths] or [present]
    for step in steps.others if most == TRIAL.most_corrections and all(map(_is_poor, ends)) else ():
        path = go_on(step)
        if len(path) > 1 and cost(path) <= present.score - steps.chance:
            paths.append(path)
            if not _is_poor(path[-1].after):
                break
    return _chosen(paths, len(steps.best), _Margins.of(present, trials)) if paths else ()


def _is_poor(outcome: Outcome) -> bool:
    """Tell whether a joint's error is in doubt."""
    return float(np.max(outcome.errors)) > 0.01 * DOUBT.unexplained_percent


def _chosen(paths: list[Path], best: int, margins: "_Margins") -> Path:
    """Choose the best path, the most usual of those alike, and name the first steps of the undecided ones.

    A first step beyond those that predicted best is as sure as its path is before the others.
    """
    least = min(map(cost, paths))
    place = next(place for place, path in enumerate(paths) if cost(path) <= least + margins.equal)
    chosen = paths[place]
    others = [path for path in paths if _corrections(path) != _corrections(chosen)]
    alike = [path for path in others if cost(path) < cost(chosen) + margins.undecided]
    confidence = chosen[0].confidence
    if place >= best:
        rivals = (margins.likelihood(cost(path) - cost(chosen)) for path in others if path not in alike)
        confidence = 1.0 / (1.0 + sum(rivals))
    equivalents = tuple(path[0].hypothesis for path in alike)
    return (replace(chosen[0], equivalents=equivalents, confidence=confidence), *chosen[1:])


def _corrections(path: Path) -> set[str]:
    return {step.hypothesis.statement for step in path}


@dataclass(frozen=True)
class _Margins:
    """Hold the differences of scores below which two are undecided, and alike."""

    independent: float
    """Independent values that judge."""

    @classmethod
    def of(cls, present: Outcome, trials: Trials) -> "_Margins":
        return cls(trials.samples.independent * len(present.errors))

    @property
    def undecided(self) -> float:
        return 0.5 * DECISION.undecided / self.independent

    @property
    def equal(self) -> float:
        return 0.5 * DECISION.equal / self.independent

    def likelihood(self, worse: float) -> float:
        """Give the likelihood of a score that is worse by this, over that of the other."""
        return float(np.exp(-self.independent * worse))


@dataclass(frozen=True, eq=False)
class _Steps:
    """Hold first steps."""

    best: Path
    """Those that predict best."""
    others: Path
    """The next best, which may hide behind an error that only another step corrects."""
    chance: float
    """Logarithm of the error by which a path has to gain beyond what its corrections cost."""


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


def _steps(listed: list[_Bounded], present: Outcome, trials: Trials) -> _Steps:
    """Give the hypotheses that predict best, first the most usual of those that predict alike."""
    margins = _Margins.of(present, trials)
    needed = max(DECISION.least_gain, margins.undecided + np.log(max(len(listed), 1)) / margins.independent)
    tried = [one for one in _tried(listed, present, trials) if one.score(needed) < present.score]
    best = min((candidate.score(needed) for candidate in tried), default=present.score)
    near = [one for one in tried if one.score(needed) < min(best + margins.undecided, present.score - needed)]
    near.sort(key=lambda candidate: candidate.score(needed) > best + margins.equal)
    far = sorted((one for one in tried if one not in near), key=lambda one: one.score(needed))
    rivals = sum(margins.likelihood(candidate.score(needed) - best) for candidate in far)
    confidence = 1.0 / (1.0 + rivals + len(listed) * margins.likelihood(present.score - best))

    def step(own: _Tried) -> FoundConflict:
        equivalents = tuple(other.hypothesis for other in near if other.hypothesis.key != own.hypothesis.key)
        return FoundConflict(own.hypothesis, present, own.outcome, confidence, equivalents)

    others = far[: TRIAL.detours]
    return _Steps(tuple(map(step, near)), tuple(map(step, others)), needed - DECISION.least_gain)


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
