"""See whether what is left is far larger for a while than at all other times: something happened then.

An event whose shape is on no list (a jerk, a blow, a stuck brake) fits no cause and follows no pattern of the
motion; a learner that predicts blocks it has not seen cannot foretell it. The median of a short stretch is
not moved by single spikes, and what is slow and large by itself stays within a few deviations of the rest.
"""

import numpy as np
from scipy.stats import norm

from ...arrays import Indices, JointSeries
from ..dataset.dataset import Dataset
from ..result import UnnamedPattern

SECONDS, APART = 0.3, 0.5
"""Length of a stretch, and how far from it `elsewhere` begins, s."""
CLEAR = 6.0
"""Times the RMS elsewhere that the median size within a stretch has to be."""
LEAST_ROWS, LEAST_ELSEWHERE = 8, 200


def burst(dataset: Dataset, residual: JointSeries) -> UnnamedPattern | None:
    """Give where a residual (rows x joints) stands out most, and on which joint; None where nowhere."""
    found = [one for joint in range(dataset.joints) for one in _stretches(dataset, residual, joint)]
    ratio, joint, begin = max(found, default=(0.0, 0, 0.0))
    if ratio < CLEAR:
        return None
    chance = float(norm.logsf(ratio) + np.log(2.0 * len(found))) / float(np.log(10.0))
    statement = (
        f"What is left on joint {joint + 1} is {ratio:.2g} times as large for a while about "
        f"{begin + 0.5 * SECONDS:.3g} s as at other times: something happened then that is on no list"
    )
    return UnnamedPattern(joint + 1, statement, ratio**2, chance)


def _stretches(dataset: Dataset, residual: JointSeries, joint: int) -> list[tuple[float, int, float]]:
    """Give, per stretch, how large the joint's residual is there over its RMS elsewhere."""
    rows = np.flatnonzero(dataset.usable[:, joint])
    size = np.abs(residual[rows, joint])
    return [
        (float(np.median(size[inside]) / max(elsewhere, 1e-300)), joint, begin)
        for log in np.unique(dataset.log[rows])
        for begin, inside, beside in _windows(dataset, rows, int(log))
        if len(size) - len(beside) >= LEAST_ELSEWHERE
        for elsewhere in [float(np.sqrt(np.mean(np.delete(size, beside) ** 2)))]
    ]


def _windows(dataset: Dataset, rows: Indices, log: int) -> list[tuple[float, Indices, Indices]]:
    """Give, per stretch of a log, when it begins, the places of its rows, and of those beside it as well."""
    own = np.flatnonzero(dataset.log[rows] == log)
    time = dataset.time[rows][own]
    begins = np.arange(time.min(), time.max(), 0.5 * SECONDS)
    found = []
    for begin in begins:
        after, before = time - begin, begin + SECONDS - time
        inside = own[(after >= 0.0) & (before >= 0.0)]
        if len(inside) >= LEAST_ROWS:
            found.append((float(begin), inside, own[(after > -APART) & (before > -APART)]))
    return found
