"""Ask whether corrections predict every part of the samples from the others, and judge the same rows.

Rows that judge lie between those that are fitted, so that a wrong set-up may predict them by the freedom that
it adds. A part in which the robot is elsewhere it does not: what it gains there is chance.
A torque is judged where its joint moves. Where joints move one after the other, exchanged torques are other
data, whose errors do not compare.
"""

import numpy as np

from ..arrays import Indices, JointMarks, JointMask, Vector
from .reduced import mean_log
from .samples import Samples
from .setup import Setup
from .thresholds import DECISION, DOUBT
from .trial import Trials


def holds_in_parts(before: Setup, after: Setup, trials: Trials) -> bool:
    """Tell whether what a correction gains is more than its scatter from part to part, and no part is missed.

    Where few independent values judge, it has to leave no part in doubt.
    """
    present, corrected = (_scores(setup, after.uses_torque, trials) for setup in (before, after))
    gains = present - corrected
    error = float(np.std(gains, ddof=1)) / np.sqrt(DECISION.parts)
    steady = float(np.mean(gains)) > DECISION.more_than_scatter * error
    few = trials.samples.independent * after.joints < DECISION.few_values
    return steady and bool(np.max(corrected) < np.log(DOUBT.unexplained if few else DECISION.left_in_part))


def judges_the_same(before: Setup, after: Setup, samples: Samples) -> bool:
    """Tell whether most rows in which a torque is judged are those in which it was before."""
    was, now = (_judged_rows(setup, samples) for setup in (before, after))
    both = np.count_nonzero(was & now, axis=0)
    return bool(np.all(both >= DECISION.same_rows * np.count_nonzero(now, axis=0)))


def _judged_rows(setup: Setup, samples: Samples) -> JointMask:
    """Mark the rows in which each torque is judged, in the order of measurement."""
    usable = samples.moved(setup.assignment).usable
    rows = np.zeros_like(usable)
    rows[:, list(setup.assignment.torque.source)] = usable
    return rows


def _scores(setup: Setup, used: JointMarks, trials: Trials) -> Vector:
    """Give the mean logarithm of the errors in each part, fitted to the others; NaN where no fit is."""
    part = _parts(trials.samples)
    outcomes = [trials.judged_by(part == place).outcome(setup) for place in range(DECISION.parts)]
    return np.array([np.nan if own is None else mean_log(own.errors[used]) for own in outcomes])


def _parts(samples: Samples) -> Indices:
    """Give the part of every row: thirds of the time, or of the time of each joint where these move in turn.

    A row is then counted among those in which the same joint moves most, beside its own largest speed.
    """
    part = _in_order(len(samples.judged))
    rows = np.array([np.count_nonzero(samples.usable[part == place], axis=0) for place in np.unique(part)])
    if np.all(rows >= DECISION.least_in_part * rows.sum(axis=0)):
        return part
    speed = np.abs(samples.velocity)
    most = np.argmax(speed / np.maximum(speed.max(axis=0), np.finfo(float).tiny), axis=1)
    for joint in np.unique(most):
        part[most == joint] = _in_order(int(np.count_nonzero(most == joint)))
    return part


def _in_order(rows: int) -> Indices:
    return np.arange(rows) * DECISION.parts // rows
