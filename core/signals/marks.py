"""Mark samples: those at a limit, those beside a change of direction, and those of a long run."""

import numpy as np

from ..arrays import JointMask, JointSeries, JointVector, SampleMask, Samples

ROUNDING = 1e-9
"""Share of a limit by which a value at it may be off after conversion of units."""


def at_limit(effort: Samples, level: float) -> SampleMask:
    """Mark the samples at a limit with its sign, in the unit of the effort."""
    return np.asarray(effort / level > 1.0 - ROUNDING)


def changes_sign(velocity: JointSeries, still: JointVector) -> JointMask:
    """Mark the samples that are still, and both between which the sign changes."""
    marks = np.abs(velocity) <= still
    turned = np.sign(velocity[1:]) != np.sign(velocity[:-1])
    marks[1:] |= turned
    marks[:-1] |= turned
    return np.asarray(marks)


def long_runs(mask: JointMask, run: int) -> JointMask:
    """Keep the stretches of a mask that last at least `run` samples: those that some full window covers."""
    if len(mask) < run:
        return np.asarray(mask & mask.all(axis=0))
    full = _window_sums(mask, run) == run
    return np.asarray(_window_sums(np.pad(full, ((run - 1, run - 1), (0, 0))), run) > 0)


def _window_sums(mask: JointMask, run: int) -> np.ndarray:
    """Count the marks in every window of `run` samples."""
    sums = np.cumsum(np.pad(mask, ((1, 0), (0, 0))), axis=0)
    return np.asarray(sums[run:] - sums[:-run])
