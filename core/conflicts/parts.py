"""Ask whether corrections predict every part of the samples from the others.

Rows that judge lie between those that are fitted, so that a wrong set-up may predict them by the freedom that
it adds. A part in which the robot is elsewhere it does not: what it gains there is chance.
"""

import numpy as np

from ..arrays import Indices, JointMarks, Vector
from .reduced import mean_log
from .samples import Samples
from .setup import Setup
from .thresholds import DECISION, DOUBT
from .trial import Trials


def holds_in_parts(before: Setup, after: Setup, trials: Trials) -> bool:
    """Tell whether what a correction gains is more than its scatter from part to part, and no part is missed.

    Where few independent values judge, it has to leave no part in doubt.
    """
    used = np.array(after.assignment.torque.factor) != 0.0
    present, corrected = (_scores(setup, used, trials) for setup in (before, after))
    gains = present - corrected
    error = float(np.std(gains, ddof=1)) / np.sqrt(DECISION.parts)
    steady = float(np.mean(gains)) > DECISION.more_than_scatter * error
    few = trials.samples.independent * after.joints < DECISION.few
    return steady and bool(np.max(corrected) < np.log(DOUBT.unexplained if few else DECISION.left_in_part))


def _scores(setup: Setup, used: JointMarks, trials: Trials) -> Vector:
    """Give the mean logarithm of the errors in each part, fitted to the others; NaN where no fit is."""
    part = _parts(trials.samples)
    outcomes = [trials.judged_by(part == place).outcome(setup) for place in range(DECISION.parts)]
    return np.array([np.nan if own is None else mean_log(own.errors[used]) for own in outcomes])


def _parts(samples: Samples) -> Indices:
    """Give the part of every row: where joints move one after the other, each has its own in every part.

    A row is counted among those in which the same joint moves most, beside its own largest speed.
    """
    speed = np.abs(samples.velocity)
    most = np.argmax(speed / np.maximum(speed.max(axis=0), np.finfo(float).tiny), axis=1)
    part = np.empty(len(most), dtype=int)
    for joint in np.unique(most):
        rows = np.flatnonzero(most == joint)
        part[rows] = np.arange(len(rows)) * DECISION.parts // len(rows)
    return part
