"""Leave out torques that are copies of other signals, before anything else is asked.

A copy shows itself, whatever the model says. But the torque of a joint that has only drag may be its
velocity. So each is put back at the end, where all else is corrected: if the model predicts it then, and the
other joints no worse, it was no copy.
"""

from dataclasses import replace

import numpy as np

from .conflict import Hypothesis
from .kinds.other_signal import copied_signals
from .path import FoundConflict, Margins, Path
from .reduced import mean_log
from .refinement import judged_again
from .setup import Setup
from .thresholds import DOUBT
from .trial import Outcome, Trials


def without_copies(setup: Setup, trials: Trials) -> Path:
    """Leave out one torque after the other that is a copy; the last torque is kept."""
    path: list[FoundConflict] = []
    while copies := next(copied_signals(setup, trials), ()):
        before = trials.outcome(setup)
        fitted = [(own, trials.outcome(own.setup)) for own in copies]
        ranked = sorted(((own, after) for own, after in fitted if after is not None), key=_score_after)
        if not ranked or before is None or not any(ranked[0][0].setup.assignment.torque.factor):
            break
        path.append(_left_out(ranked, before, trials))
        setup = path[-1].hypothesis.setup
    return tuple(path)


def _score_after(pair: tuple[Hypothesis, Outcome]) -> float:
    return pair[1].score


def _left_out(ranked: list[tuple[Hypothesis, Outcome]], before: Outcome, trials: Trials) -> FoundConflict:
    """Leave out the first of some torques."""
    (own, after), *others = ranked
    margins = Margins.of(before, trials)
    worse = [(other, outcome.score - after.score) for other, outcome in others]
    alike = tuple(other for other, more in worse if more < margins.undecided)
    against = sum(margins.likelihood(more) for _, more in worse if more >= margins.undecided)
    return FoundConflict(own, _without(own, before), after, 1.0 / (1.0 + against), alike)


def _without(own: Hypothesis, outcome: Outcome) -> Outcome:
    """Take nothing for predicted of a torque that is left out, before as after."""
    errors = outcome.errors.copy()
    errors[[joint - 1 for joint in own.joints]] = 1.0
    return replace(outcome, errors=errors)


def only_real_copies(path: Path, trials: Trials) -> Path:
    """Put back the torques that the model predicts, beside the others, where all else is corrected."""
    for step in path:
        own = step.hypothesis
        if own.is_shown and _is_torque(own, path[-1], trials):
            others = [(other, _with_torque(other.hypothesis, own)) for other in path if other is not step]
            return only_real_copies(judged_again(others, trials) or (), trials)
    return path


def _is_torque(own: Hypothesis, last: FoundConflict, trials: Trials) -> bool:
    """Tell whether a torque that was left out is predicted, and the others beside it no worse."""
    back = trials.outcome(_with_torque(last.hypothesis, own).setup)
    if back is None:
        return False
    place = last.hypothesis.setup.assignment.torque.source.index(own.joints[0] - 1)
    needed = Margins.of(back, trials).needed(1)
    others = np.arange(len(back.errors)) != place
    worse = float(mean_log(back.errors[others]) - mean_log(last.after.errors[others]))
    gained = worse * float(np.mean(others))
    return bool(back.errors[place] <= DOUBT.unexplained and gained <= needed)


def _with_torque(changed: Hypothesis, own: Hypothesis) -> Hypothesis:
    """Put the torque that a hypothesis leaves out back into the set-up of another."""
    torque = changed.setup.assignment.torque
    place = torque.source.index(own.joints[0] - 1)
    factor = tuple(1.0 if joint == place else value for joint, value in enumerate(torque.factor))
    return replace(changed, setup=changed.setup.with_torque(replace(torque, factor=factor)))
