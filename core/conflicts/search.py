"""Find the corrections under which description and logs agree.

The best correction is applied and the search goes on from it, until none is better than chance and their
number explain. Where several are best, it goes on from each, and the fewest corrections are preferred.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from .conflict import Hypothesis
from .copies import only_real_copies, without_copies
from .kinds.gear_ratio import GearRatio
from .kinds.other_signal import OtherSignal
from .kinds.unit import Unit
from .parts import holds_in_parts, judges_the_same
from .path import FoundConflict, Margins, Path, cost, unsure
from .position_forces import beside_forces
from .reduced import mean_log
from .refinement import refined
from .rival import only_needed, score_with_forces
from .setup import Setup
from .steps import Steps, first_steps
from .thresholds import DECISION, DOUBT, TRIAL
from .trial import Outcome, Trials


def find_conflicts(setup: Setup, trials: Trials) -> Path:
    """Search for corrections of a set-up, one after the other; the last one's set-up holds them all."""
    copies = without_copies(setup, trials)
    first = copies[-1].hypothesis.setup if copies else setup
    present = trials.outcome(first)
    path = () if present is None else _Search(trials).path(first, present, TRIAL.most_corrections)
    path = _as_sure_as_steady(only_needed(refined(path, first, trials), first, trials), first, trials)
    return _as_sure_as_they_fit(only_real_copies(copies + path, trials), trials)


def _as_sure_as_steady(path: Path, before: Setup, trials: Trials) -> Path:
    """Limit the confidence of corrections that do not hold in every part, beside such forces either.

    So too where what they gain is an error of other data.
    """
    if all(step.hypothesis.expected for step in path):
        return path
    after = path[-1].hypothesis.setup
    ways = (trials, beside_forces(trials, after))
    holds = any(holds_in_parts(before, after, way) for way in ways)
    return path if holds and judges_the_same(before, after, trials.samples) else unsure(path)


def _as_sure_as_they_fit(path: Path, trials: Trials) -> Path:
    """Limit the confidence of corrections after which the model still fails on a joint.

    So too where they leave more than half of an error that is still in doubt, also beside forces that follow
    the positions: the true correction is another. And so where they take an offset for gravity.
    """
    if not path:
        return path
    before, last = path[0].before, path[-1]
    used = last.hypothesis.setup.uses_torque
    score = float(mean_log(last.after.errors[used]))
    most = max(np.log(DOUBT.unexplained), float(mean_log(before.errors[used])) + np.log(DECISION.least_share))
    fails = float(np.max(last.after.errors[used], initial=0.0)) > DECISION.failed
    fails = fails or (score > most and score_with_forces(last.hypothesis.setup, trials, used) > most)
    fails = fails or _needs_offset(path[0].before, last.after)
    return unsure(path) if fails else tuple(_as_sure_as_absent(step) for step in path)


def _needs_offset(before: Outcome, after: Outcome) -> bool:
    """Tell whether a joint needs an offset as large as its torque after corrections, and needed less before.

    Under a wrong direction of gravity, a slide's weight is an offset of its force.
    """
    large = after.offsets > DECISION.offset
    return bool(np.any(large & (after.offsets > before.offsets)))


def _as_sure_as_absent(step: FoundConflict) -> FoundConflict:
    """Limit the confidence that what is not predicted is no torque: it may be one of an unknown cause."""
    is_absent = step.hypothesis.conflict == OtherSignal.name and not step.hypothesis.is_shown
    return unsure((step,))[0] if is_absent else step


@dataclass(frozen=True, eq=False)
class _Search:
    """Go on from set-ups; from those that predict alike once, as they are the same robot said otherwise."""

    trials: Trials
    _known: list[tuple[Outcome, int, Path]] = field(default_factory=list)
    """What was gone on from, with how many corrections at most, and where it led."""

    def path(self, setup: Setup, present: Outcome, most: int, reach: float = np.inf) -> Path:
        """Give the corrections that lead on from a set-up; a last one has to come near a score to count.

        Several wrong ones may undo each other: a mirrored robot moves under mirrored gravity as the true one
        does. So paths are compared by their last error, to which each correction adds what one has to gain.
        """
        if not most:
            return ()
        for outcome, tried, path in self._known:
            if len(path) <= most <= tried and outcome.is_like(present):
                return path
        path = self._path(setup, present, most, reach)
        self._known.append((present, most, path))
        return path

    def _path(self, setup: Setup, present: Outcome, most: int, reach: float) -> Path:
        steps = first_steps(setup, present, self.trials, reach if most == 1 else np.inf)
        paths = list(self._best(steps, most, reach))
        if most == TRIAL.most_corrections:
            paths += self._alternatives(steps, paths)
        return _chosen(paths, len(steps.best), Margins.of(present, self.trials)) if paths else ()

    def _best(self, steps: Steps, most: int, reach: float) -> Iterator[Path]:
        """Go on from each of the best; only from the first where that is all."""
        for step in _apart(steps.best):
            path = self._from(step, most, reach)
            yield path
            if step is steps.best[0] and len(path) == 1 and not _is_poor(step.after):
                return

    def _alternatives(self, steps: Steps, paths: list[Path]) -> Iterator[Path]:
        """Go on from the next best where all paths leave a joint in doubt, or take several corrections."""
        unsure = all(len(path) > 1 or _is_poor(path[-1].after) for path in paths)
        for step in steps.alternatives(self.trials) if unsure and paths else ():
            yield self._from(step, TRIAL.most_corrections, min(map(cost, paths)))

    def _from(self, step: FoundConflict, most: int, reach: float) -> Path:
        left = reach - DECISION.least_gain * (not step.hypothesis.expected)
        return (step, *self.path(step.hypothesis.setup, step.after, most - 1, left))


def _apart(steps: Path) -> Path:
    """Leave out factors of channels that a unit corrects as well: both lead on alike, but it is exact."""
    units = {step.hypothesis.key[1:] for step in steps if step.hypothesis.conflict == Unit.name}
    return tuple(
        step
        for step in steps
        if step.hypothesis.conflict != GearRatio.name or step.hypothesis.key[1:] not in units
    )


def _is_poor(outcome: Outcome) -> bool:
    """Tell whether a joint's error is in doubt."""
    return float(np.max(outcome.errors)) > DOUBT.unexplained


def _chosen(paths: list[Path], best: int, margins: Margins) -> Path:
    """Choose the best path, the most usual of those alike, and name the first steps of the undecided ones.

    Those that predict as well as its first step are among them, unless they were followed and led elsewhere.
    A first step beyond those that predicted best is as sure as its path is before the others.
    """
    least = min(map(cost, paths))
    place = next(place for place, path in enumerate(paths) if cost(path) <= least + margins.equal)
    chosen = paths[place]
    others = [path for path in paths if _corrections(path) != _corrections(chosen)]
    worse = [cost(path) - cost(chosen) for path in others]
    undecided = [path for path, more in zip(others, worse, strict=True) if more < margins.undecided]
    against = sum(margins.likelihood(more) for more in worse if more >= margins.undecided)
    confidence = chosen[0].confidence if place < best else 1.0 / (1.0 + against)
    return (
        replace(chosen[0], equivalents=_alike(chosen, undecided, paths), confidence=confidence),
        *chosen[1:],
    )


def _alike(chosen: Path, undecided: list[Path], paths: list[Path]) -> tuple[Hypothesis, ...]:
    """Give the first steps of the undecided paths, and those as good as the chosen one that none follows.

    Of one kind and joint the first is given, and none of the chosen one's.
    """
    followed = {path[0].hypothesis for path in paths}
    beside = (own for own in chosen[0].equivalents if own not in followed)
    listed = (*(path[0].hypothesis for path in undecided), *beside)
    first = {chosen[0].hypothesis.key: chosen[0].hypothesis}
    for own in listed:
        first.setdefault(own.key, own)
    return tuple(first.values())[1:]


def _corrections(path: Path) -> set[str]:
    return {step.hypothesis.statement for step in path}
