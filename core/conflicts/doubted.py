"""Search what robot and logs disagree in where something is in doubt: in all logs together, then in each."""

from dataclasses import replace
from itertools import takewhile

import numpy as np

from ..estimate.problem import Problem
from .check import Conflicts
from .path import FoundConflict, Path
from .samples import sampled
from .search import find_conflicts
from .setup import Setup
from .steps import least_squares_gain
from .thresholds import DECISION, DOUBT
from .time_offset import time_offset
from .trial import Trials


def search_conflicts(
    problem: Problem, terms: tuple[str, ...] | None, factors: tuple[float | None, ...]
) -> Conflicts:
    """Search conflicts in logs whose stamps' steps are too long by such factors."""
    trials = Trials(sampled(problem.motions, problem.held_out), terms)
    described = Setup(problem.base.model.robot, trials.samples.as_measured)
    factor = next((factor for factor in factors if factor is not None), None)
    if factor is None:
        found = find_conflicts(described, trials)
        return _logs_alone(problem, Conflicts(found, factors), described, trials)
    by_velocity = find_conflicts(described.with_clock(1.0 / factor), trials)
    found = _alike(find_conflicts(described, trials), by_velocity) if by_velocity else ()
    return Conflicts(found, factors)


def _logs_alone(problem: Problem, conflicts: Conflicts, described: Setup, trials: Trials) -> Conflicts:
    """Ask of each log alone what all together do not show: a clock, or a conflict that others have not."""
    found = conflicts.found
    copies = tuple(step for step in found if step.hypothesis.is_shown)
    setup = copies[-1].hypothesis.setup if copies else described
    if _fails(found[len(copies) :], setup, trials):
        offsets = tuple(time_offset(motion, setup, trials.terms) for motion in problem.motions)
        if any(offsets):
            return replace(conflicts, found=copies, offsets=offsets)
        of_logs = _of_logs(problem, described, trials.terms)
        if any(of_logs):
            return replace(conflicts, found=(), of_logs=of_logs)
    return replace(conflicts, promising=_promising(found, described, trials))


def _fails(found: Path, setup: Setup, trials: Trials) -> bool:
    """Tell whether the model fails on a joint and no correction surely helps."""
    if any(step.confidence > DECISION.most_where_unsure for step in found):
        return False
    present = trials.outcome(setup)
    used = setup.uses_torque
    return present is not None and float(np.max(present.errors[used], initial=0.0)) > DOUBT.unexplained


def _of_logs(problem: Problem, described: Setup, terms: tuple[str, ...] | None) -> tuple[Path, ...]:
    """Search each of several logs; nothing where none is right, or what is wrong is the description."""
    if len(problem.motions) == 1:
        return ()
    paths = tuple(_of_log(problem, number, described, terms) for number in range(len(problem.motions)))
    return () if all(paths) else paths


def _of_log(problem: Problem, number: int, described: Setup, terms: tuple[str, ...] | None) -> Path:
    """Search one log; nothing where a correction is unsure, or is one of the description.

    A log that is held out as a whole is not searched: nothing of it may decide.
    """
    motion = problem.motions[number]
    held_out = frozenset((0, block) for log, block in problem.held_out if log == number)
    if len(held_out) == motion.blocks:
        return ()
    found = find_conflicts(described, Trials(sampled((motion,), held_out), terms))
    sure = all(step.confidence > DECISION.most_where_unsure for step in found)
    return found if sure and all(step.hypothesis.channel for step in found) else ()


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
