"""Check a set-up: whether the stamps agree with the velocities, and which correction a doubtful fit needs."""

from dataclasses import dataclass
from itertools import takewhile

import numpy as np

from ..estimate.problem import Problem
from ..log.model import JointLog
from .kinds.gear_ratio import GearRatio
from .path import FoundConflict
from .samples import sampled
from .search import find_conflicts
from .setup import Setup
from .steps import least_squares_gain
from .thresholds import DECISION, DOUBT
from .time_base import stamp_factor
from .time_offset import TimeOffset, time_offset
from .trial import Trials


@dataclass(frozen=True, eq=False)
class Conflicts:
    """Hold what was found to disagree."""

    found: tuple[FoundConflict, ...] = ()
    """Conflicts that corrections remove, in the order in which they were found."""
    stamp_factors: tuple[float | None, ...] = ()
    """Per log, the factor by which its stamps' steps are too long; None where nothing contradicts them."""
    offsets: tuple[TimeOffset | None, ...] = ()
    """Per log, by how much its torques come later than its positions; None where they do not."""
    applied: bool = False
    """Whether the corrections were applied before anything else was computed."""
    searched: bool = True
    """Whether anything was in doubt, so that corrections were searched."""
    promising: float = 0.0
    """By how much the mean logarithm of the joints' errors falls under the best other set-up, where too few
    rows judge it to call it a conflict, or forces that follow positions predict better; 0 where that is less
    than a conflict has to gain."""

    @property
    def is_open(self) -> bool:
        """Tell whether something disagrees that was not corrected."""
        return (bool(self.found) and not self.applied) or any(self.stamp_factors) or any(self.offsets)

    @property
    def estimates_a_factor(self) -> bool:
        """Tell whether a torque was multiplied by a factor that is an estimate."""
        return any(step.hypothesis.conflict == GearRatio.name for step in self.found)

    @property
    def setup(self) -> Setup | None:
        """Give the corrected set-up; None where nothing is to be corrected."""
        return self.found[-1].hypothesis.setup if self.found else None


def check(
    problem: Problem, logs: tuple[JointLog, ...], terms: tuple[str, ...] | None, *, doubted: bool
) -> Conflicts:
    """Look for conflicts where something is in doubt (see `is_doubtful`); stamps are always compared."""
    factors = tuple(stamp_factor(log) for log in logs)
    if not doubted:
        return Conflicts((), factors, searched=False)
    trials = Trials(sampled(problem.motions, problem.held_out), terms)
    described = Setup(problem.base.model.robot, trials.samples.as_measured)
    factor = next((factor for factor in factors if factor is not None), None)
    if factor is None:
        found = find_conflicts(described, trials)
        offsets = _offsets(problem, found, described, trials)
        found = () if any(offsets) else found
        return Conflicts(found, factors, offsets, promising=_promising(found, described, trials))
    by_velocity = find_conflicts(described.with_clock(1.0 / factor), trials)
    found = _alike(find_conflicts(described, trials), by_velocity) if by_velocity else ()
    return Conflicts(found, factors)


def _offsets(
    problem: Problem, found: tuple[FoundConflict, ...], described: Setup, trials: Trials
) -> tuple[TimeOffset | None, ...]:
    """Look for clocks that differ, log by log, where the model fails and no correction surely helps."""
    sure = any(step.confidence > DECISION.most_where_unsure for step in found)
    present = None if sure else trials.outcome(trials.equations(described))
    if present is None or float(np.max(present.errors)) <= DOUBT.unexplained:
        return ()
    return tuple(time_offset(motion, described, trials.terms) for motion in problem.motions)


def _promising(found: tuple[FoundConflict, ...], described: Setup, trials: Trials) -> float:
    """Give what the best set-up gains by least squares where no conflict was found, if enough for one."""
    gain = 0.0 if found else least_squares_gain(described, trials)
    return gain if gain > DECISION.least_gain else 0.0


def _alike(
    described: tuple[FoundConflict, ...], by_velocity: tuple[FoundConflict, ...]
) -> tuple[FoundConflict, ...]:
    """Keep what is found by the clock of the stamps and by that of the velocities: either may be wrong.

    A wrong clock makes inertias wrong, which another direction of gravity may seem to correct.
    """
    pairs = zip(described, by_velocity, strict=False)
    return tuple(
        own for own, _ in takewhile(lambda pair: pair[0].hypothesis.key == pair[1].hypothesis.key, pairs)
    )
