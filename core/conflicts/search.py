"""Find the corrections under which description and logs agree.

Every hypothesis is one set-up. Least squares bounds how well it can fit. Those that can still fit as well as
the best are fitted with the constraints, best bound first, and judged on rows that were not fitted. The best
is applied and the search goes on from it, until none is better than chance and their number explain. Where
several are best, the search goes on from each, and the fewest corrections are preferred.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from .conflict import Hypothesis
from .kinds.mounting import Mounting, is_tilt
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


Path = tuple[FoundConflict, ...]


def find_conflicts(setup: Setup, trials: Trials) -> Path:
    """Search for corrections of a set-up, one after the other; the last one's set-up holds them all."""
    present = trials.outcome(trials.equations(setup))
    path = () if present is None else _path(setup, present, trials, TRIAL.most_corrections)
    return _with_gravity_refined(path, setup, trials) if len(path) > 1 else path


def _with_gravity_refined(path: Path, described: Setup, trials: Trials) -> Path:
    """Find the direction of gravity anew beside all other corrections: it was found beside what they correct.

    Directions found one after the other are one. If that is a mere tilt of the described one, none is left.
    """
    mountings = [place for place, step in enumerate(path) if step.hypothesis.conflict == Mounting.name]
    if mountings and is_tilt(path[-1].hypothesis.setup.robot.gravity, described.robot.gravity):
        return _with_gravity(path, described, None, trials)
    if not mountings or mountings == [len(path) - 1]:
        return path
    corrected = path[-1].hypothesis.setup.with_gravity(described.robot.gravity)
    tried = list(_tried_mountings(corrected, trials))
    if not tried:
        return path
    best = min(tried, key=lambda candidate: candidate.outcome.score).hypothesis
    return min(path, _with_gravity(path, described, best, trials), key=_cost)


def _tried_mountings(setup: Setup, trials: Trials) -> Iterator["_Tried"]:
    """Try every direction of gravity."""
    for hypothesis in CONFLICTS[Mounting.name].hypotheses(setup, trials):
        outcome = trials.outcome(trials.equations(hypothesis.setup))
        if outcome is not None:
            yield _Tried(hypothesis, outcome)


def _with_gravity(path: Path, described: Setup, mounting: Hypothesis | None, trials: Trials) -> Path:
    """Put one mounting, or none, in the place of all of a path."""
    out: list[FoundConflict] = []
    gravity = described.robot.gravity
    for step in path:
        own = step.hypothesis
        if own.conflict == Mounting.name:
            if mounting is None:
                continue
            own, gravity, mounting = mounting, mounting.setup.robot.gravity, None  # later ones are part of it
        own = replace(own, setup=step.hypothesis.setup.with_gravity(gravity))
        after = trials.outcome(trials.equations(own.setup))
        if after is None:
            return path
        before = out[-1].after if out else step.before
        out.append(replace(step, hypothesis=own, before=before, after=after))
    return tuple(out)


def _path(setup: Setup, present: Outcome, trials: Trials, most: int) -> Path:
    """Give the corrections that lead on from a set-up.

    Where several predict alike and the first is not all, the search goes on from each of them. Several wrong
    ones may undo each other: a mirrored robot moves under mirrored gravity as the true one does. So
    paths are compared by their last error, to which each correction adds what one has to gain.
    """
    steps = _steps(_bounded(setup, trials), present, trials) if most else ()
    paths: list[Path] = []
    for step in steps:
        paths.append((step, *_path(step.hypothesis.setup, step.after, trials, most - 1)))
        if len(paths[0]) == 1:
            return paths[0]
    return _cheapest(paths, *_margins(present, trials)) if paths else ()


def _cheapest(paths: list[Path], undecided: float, equal: float) -> Path:
    """Give the first of the paths that cost least, with those that cost about as much beside it."""
    least = min(map(_cost, paths))
    chosen = next(path for path in paths if _cost(path) <= least + equal)
    others = (path for path in paths if _corrections(path) != _corrections(chosen))
    alike = tuple(path[0].hypothesis for path in others if _cost(path) < _cost(chosen) + undecided)
    return (replace(chosen[0], equivalents=alike), *chosen[1:])


def _cost(path: Path) -> float:
    return path[-1].after.score + DECISION.least_gain * len(path)


def _corrections(path: Path) -> set[str]:
    return {step.hypothesis.statement for step in path}


def _margins(present: Outcome, trials: Trials) -> tuple[float, float]:
    """Give the differences of scores below which two are undecided, and alike."""
    independent = trials.samples.independent * len(present.errors)
    return 0.5 * DECISION.undecided / independent, 0.5 * DECISION.equal / independent


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


def _steps(listed: list[_Bounded], present: Outcome, trials: Trials) -> Path:
    """Give the hypotheses that predict best, first the most usual of those that predict alike."""
    independent = trials.samples.independent * len(present.errors)
    undecided, equal = _margins(present, trials)
    tried = _tried(listed, present, trials)
    scores = [candidate.outcome.score for candidate in tried]
    best = min(scores, default=present.score)
    chance = undecided + np.log(max(len(listed), 1)) / independent  # of the best of so many
    if present.score - best < max(DECISION.least_gain, chance):
        return ()
    near = [candidate for candidate in tried if candidate.outcome.score < best + undecided]
    chosen = next(place for place, candidate in enumerate(near) if candidate.outcome.score <= best + equal)
    worse = [candidate.outcome.score - best for candidate in tried if candidate not in near]
    others = sum(map(partial(_likelihood, independent), worse))
    confidence = 1.0 / (1.0 + others + len(listed) * _likelihood(independent, present.score - best))
    usual = [near[chosen], *near[:chosen], *near[chosen + 1 :]]
    return tuple(
        FoundConflict(own.hypothesis, present, own.outcome, confidence, _others(near, own)) for own in usual
    )


def _likelihood(independent: float, more: float) -> float:
    """Give the likelihood, over the best one's, of a score that is larger by so much."""
    return float(np.exp(-independent * more))


def _others(near: list[_Tried], own: _Tried) -> tuple[Hypothesis, ...]:
    """List the hypotheses of another kind or joint."""
    return tuple(other.hypothesis for other in near if other.hypothesis.key != own.hypothesis.key)


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
