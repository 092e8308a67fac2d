"""Hold corrections to a rival: forces that follow the positions and that no model has, such as a hose's.

They leave large residuals as a wrong set-up does, and some correction then lowers the mean error although
the set-up is right. A true one predicts better than any smooth function of the positions beside the set-up
before it, which a spring's does not.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ..arrays import JointMarks
from .conflict import Hypothesis
from .path import FoundConflict, Margins, Path, price, unsure
from .position_forces import beside_forces
from .reduced import mean_log
from .refinement import judged_again
from .setup import Part, Setup
from .thresholds import DECISION
from .trial import Trials


def only_needed(path: Path, described: Setup, trials: Trials) -> Path:
    """Leave out corrections without which the set-up predicts better, if it has such forces.

    Where it then predicts as well, and clearly better than the corrected set-up does without them, the
    corrections are unsure. Nothing is left out that the log's numbers ask for by their size alone.
    """
    if not path:
        return path
    alone, beside = path[-1].after.score, score_with_forces(path[-1].hypothesis.setup, trials)
    clearly = Margins.of(path[0].before, trials).undecided
    fewer = [_Fewer.of(steps, described, trials) for steps in _choices(path, described)]
    better = [own for own in fewer if own.score < min(alone, beside) - clearly]
    if better:
        return min(better, key=_Fewer.cost).path(trials)
    as_good = min(alone - clearly, beside + DECISION.least_gain)
    return unsure(path) if any(own.score < as_good for own in fewer) else path


@dataclass(frozen=True, eq=False)
class _Fewer:
    """Hold some of the corrections of a path, each with the set-up to which it and those before it lead."""

    steps: list[tuple[FoundConflict, Hypothesis]]
    score: float
    """Mean logarithm of the errors with such forces."""

    @classmethod
    def of(cls, steps: list[tuple[FoundConflict, Hypothesis]], described: Setup, trials: Trials) -> "_Fewer":
        """Judge the set-up to which they lead."""
        return cls(steps, score_with_forces(steps[-1][1].setup if steps else described, trials))

    def cost(self) -> float:
        """Give the score, to which the corrections add what they have to gain."""
        return self.score + price([own for _, own in self.steps])

    def path(self, trials: Trials) -> Path:
        """Fit the corrections again, one after the other; none where one cannot be fitted."""
        return judged_again(self.steps, trials) or ()


def _choices(path: Path, described: Setup) -> Iterator[list[tuple[FoundConflict, Hypothesis]]]:
    """Give every choice of fewer corrections; those that change the same part of a set-up stay together."""
    befores = [described, *(step.hypothesis.setup for step in path)]
    changes = [step.hypothesis.setup.differing(before) for step, before in zip(path, befores, strict=False)]
    groups = _merged(changes)
    asked = [parts for step, parts in zip(path, changes, strict=True) if step.hypothesis.expected]
    for number in range(len(groups)):
        for kept in combinations(groups, number):
            parts = frozenset[Part]().union(*kept)
            if all(own <= parts for own in asked):
                yield [
                    (step, replace(step.hypothesis, setup=described.taking(parts, step.hypothesis.setup)))
                    for step, own in zip(path, changes, strict=True)
                    if own <= parts
                ]


def _merged(sets: list[frozenset[Part]]) -> list[frozenset[Part]]:
    """Join sets that have something in common."""
    out: list[frozenset[Part]] = []
    for own in sets:
        out = [
            *(other for other in out if not other & own),
            own.union(*(other for other in out if other & own)),
        ]
    return out


def score_with_forces(setup: Setup, trials: Trials, used: JointMarks | None = None) -> float:
    """Judge a set-up with these forces or with springs, on some joints; the worst where none can be fitted.

    Waves that are fitted in one place say nothing of another, as where joints move in turn; a spring does.
    """
    outcomes = [beside_forces(trials, setup, waves=waves).outcome(setup) for waves in (True, False)]
    fitted = [own.errors if used is None else own.errors[used] for own in outcomes if own is not None]
    return min((float(mean_log(errors)) for errors in fitted), default=np.inf)
