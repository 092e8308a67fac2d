"""Find bursts: short spans in which the residual is far larger than at all other times.

A transient event of a shape that no cause has (a jerk, a blow, a stuck brake) follows no pattern of the
motion, and a learner cannot predict it on held-out blocks. The median of a short span is not moved by single
spikes, and slow disturbances stay within a few deviations of the rest.
"""

import numpy as np

from ...arrays import Indices, JointSeries
from ...numerics.distributions import log_normal_tail
from ..dataset.dataset import Dataset
from ..result import UnnamedPattern
from ..thresholds.checks import UNNAMED
from ..thresholds.residual import PREDICTION
from ..thresholds.search import HOLDOUT


def burst(dataset: Dataset, residual: JointSeries) -> UnnamedPattern | None:
    """Give the largest burst of a residual (rows x joints), N m or N; None where there is none."""
    found = [span for joint in range(dataset.joints) for span in _stretches(dataset, residual, joint)]
    ratio, joint, begin = max(found, default=(0.0, 0, 0.0))
    if ratio < UNNAMED.burst_ratio:
        return None
    chance = float(log_normal_tail(ratio) + np.log(2.0 * len(found))) / float(np.log(10.0))
    middle = begin + 0.5 * UNNAMED.burst_seconds
    statement = (
        f"Burst in the residual of joint {joint + 1} at {middle:.3g} s: {ratio:.2g} times the "
        "RMS at other times, of a shape that no listed cause has"
    )
    return UnnamedPattern(joint + 1, statement, ratio**2, chance)


def _stretches(dataset: Dataset, residual: JointSeries, joint: int) -> list[tuple[float, int, float]]:
    """Give, per span, the median size of the joint's residual over its RMS elsewhere.

    Rows at rest or beside a reversal are no measure: friction that may be anything has taken what they hold.
    """
    rows = np.flatnonzero(dataset.clear[:, joint])
    size = np.abs(residual[rows, joint])
    squares = np.append(0.0, np.cumsum(size**2)), np.append(np.cumsum(size[::-1] ** 2)[::-1], 0.0)
    return [
        (float(np.median(size[inside]) / max(elsewhere, 1e-300)), joint, begin)
        for log in np.unique(dataset.log[rows])
        for begin, inside, beside in _windows(dataset, rows, int(log))
        for others in [len(size) - (beside.stop - beside.start)]
        if others >= PREDICTION.least_rows
        for elsewhere in [float(np.sqrt((squares[0][beside.start] + squares[1][beside.stop]) / others))]
    ]


def _windows(dataset: Dataset, rows: Indices, log: int) -> list[tuple[float, slice, slice]]:
    """Give, per span of a log, its begin, its rows, and those of its neighbourhood too; rows rise in time."""
    own = np.flatnonzero(dataset.log[rows] == log)
    time = dataset.time[rows][own]
    begins = np.arange(time.min(), time.max(), 0.5 * UNNAMED.burst_seconds)
    found = []
    for begin in begins:
        after, behind = time - begin, time - (begin + UNNAMED.burst_seconds)
        first, last = np.searchsorted(after, 0.0), np.searchsorted(behind, 0.0, side="right")
        if last - first >= HOLDOUT.least_rows:
            low = np.searchsorted(after, -UNNAMED.burst_distance, side="right")
            high = np.searchsorted(behind, UNNAMED.burst_distance)
            around = slice(int(own[0] + low), int(own[0] + high))
            found.append((float(begin), slice(int(own[0] + first), int(own[0] + last)), around))
    return found
