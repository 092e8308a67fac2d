"""Find a size anew beside all corrections of a path: it was found beside errors that later steps correct."""

from dataclasses import replace

import numpy as np

from .conflict import Hypothesis
from .kinds.gear_ratio import GearRatio, factor_hypothesis, likeliest_factor, with_factor
from .kinds.mounting import Mounting, is_tilt
from .kinds.unit import Unit
from .path import FoundConflict, Margins, Path, cost
from .registry import CONFLICTS
from .setup import Setup
from .trial import Trials


def refined(path: Path, described: Setup, trials: Trials) -> Path:
    """Find the direction of gravity and the factors of torques anew where they are not the last step."""
    path = _with_gravity_refined(path, described, trials)
    own = [step.hypothesis for step in path if step.hypothesis.key[::2] == (GearRatio.name, "torque")]
    channels = {one.setup.assignment.torque.source[one.joints[0] - 1] for one in own}
    for channel in sorted(channels) if len(path) > 1 else ():
        path = _with_factors_refined(path, channel, described, trials)
    return path


def _with_gravity_refined(path: Path, described: Setup, trials: Trials) -> Path:
    """Put one direction in the place of all; none where they add up to a mere tilt of the described one."""
    mountings = [place for place, step in enumerate(path) if step.hypothesis.conflict == Mounting.name]
    if not mountings:
        return path
    last = path[-1].hypothesis.setup
    if is_tilt(last.robot.gravity, described.robot.gravity):
        return _with_gravity(path, described, None, trials)
    if mountings == [len(path) - 1]:
        return path
    equal = Margins.of(path[-1].after, trials).equal
    best = _best_mounting(last.with_gravity(described.robot.gravity), trials, equal)
    if best is None:
        return path
    again = _with_gravity(path, described, best, trials)
    return again if cost(again) <= cost(path) + equal else path


def _best_mounting(setup: Setup, trials: Trials, equal: float) -> Hypothesis | None:
    """Try every direction of gravity, and give the most usual of those that predict alike."""
    listed = list(CONFLICTS[Mounting.name].hypotheses(setup, trials))
    outcomes = [trials.outcome(hypothesis.setup) for hypothesis in listed]
    fitted = [(outcome.score, place) for place, outcome in enumerate(outcomes) if outcome is not None]
    alike = [place for score, place in fitted if score <= min(fitted)[0] + equal]
    return listed[alike[0]] if alike else None


def _with_gravity(path: Path, described: Setup, mounting: Hypothesis | None, trials: Trials) -> Path:
    """Put one mounting, or none, in the place of all of a path."""
    gravity, steps = described.robot.gravity, []
    for step in path:
        own = step.hypothesis
        if own.conflict == Mounting.name:
            if mounting is None:
                continue
            own, gravity, mounting = mounting, mounting.setup.robot.gravity, None  # later ones are part of it
        steps.append((step, replace(own, setup=step.hypothesis.setup.with_gravity(gravity))))
    judged = judged_again(steps, trials)
    return path if judged is None else judged


def _with_factors_refined(path: Path, channel: int, described: Setup, trials: Trials) -> Path:
    """Put one factor on a measured torque in the place of all, with what is missing at the end."""
    last = path[-1].hypothesis.setup
    missing = likeliest_factor(last, trials, _joint(last, channel))
    befores = [described, *(step.hypothesis.setup for step in path)]
    factors = [_factor(before, step.hypothesis, channel) for before, step in zip(befores, path, strict=False)]
    whole = missing * float(np.prod(factors))
    first = next(place for place, factor in enumerate(factors) if factor != 1.0)
    steps = []
    for place, step in enumerate(path):
        own = step.hypothesis
        if place == first:
            own = factor_hypothesis(befores[place], _joint(befores[place], channel), whole)
        elif place > first:
            change = whole / float(np.prod(factors[: place + 1]))
            own = replace(own, setup=with_factor(own.setup, _joint(own.setup, channel), change))
        if place == first or factors[place] == 1.0:
            steps.append((step, own))
    judged = judged_again(steps, trials)
    return path if judged is None else min(path, judged, key=cost)


def _factor(before: Setup, step: Hypothesis, channel: int) -> float:
    """Give the factor of a step that concerns the size of this torque alone; 1 of any other."""
    joint = _joint(before, channel)
    if step.conflict not in {GearRatio.name, Unit.name} or step.key[1:] != ((joint + 1,), "torque"):
        return 1.0
    return step.setup.assignment.torque.factor[joint] / before.assignment.torque.factor[joint]


def _joint(setup: Setup, channel: int) -> int:
    """Give the joint, from 0, that a measured torque belongs to."""
    return setup.assignment.torque.source.index(channel)


def judged_again(steps: list[tuple[FoundConflict, Hypothesis]], trials: Trials) -> Path | None:
    """Fit changed steps again, one after the other; None where one cannot be fitted."""
    out: list[FoundConflict] = []
    for step, own in steps:
        after = trials.outcome(own.setup)
        if after is None:
            return None
        out.append(replace(step, hypothesis=own, before=out[-1].after if out else step.before, after=after))
    return tuple(out)
