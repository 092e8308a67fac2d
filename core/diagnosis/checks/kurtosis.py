"""Test the kurtosis of a residual: a torque that switches between levels by itself has a small one.

Noise has a kurtosis of three or more, and so has any sum of it over time; what stays between two levels has
as little as one. Its deviation comes from leaving out blocks in turn. Sources: Darlington, The American
Statistician 24(2), 1970, for kurtosis as bimodality; Kuensch, Ann. Stat. 17, 1989, for leaving out blocks.
"""

import numpy as np
from scipy.ndimage import uniform_filter1d

from ...arrays import Indices, JointSeries, Vector
from ...numerics.distributions import log_normal_tail
from ..dataset.dataset import Dataset
from ..residual.blocks import row_blocks
from ..result import UnnamedPattern
from ..thresholds.checks import UNNAMED
from ..thresholds.residual import PREDICTION

NORMAL = 3.0


def bounded_residual(dataset: Dataset, residual: JointSeries) -> UnnamedPattern | None:
    """Give the joint whose residual (rows x joints) has the most significantly small kurtosis, or None."""
    blocks = row_blocks(dataset)
    found = []
    for joint, (series, usable) in enumerate(zip(residual.T, dataset.usable.T, strict=True), start=1):
        if np.count_nonzero(usable) < PREDICTION.least_rows:
            continue
        smooth = uniform_filter1d(np.where(usable, series, 0.0), UNNAMED.level_rows)[usable]
        size, deviation = kurtosis(smooth, blocks[usable])
        found.append(((NORMAL - size) / max(deviation, 1e-12), joint, size))
    clearest, joint, size = max(found, default=(0.0, 0, NORMAL))
    if clearest < UNNAMED.level_deviations:
        return None
    chance = float(log_normal_tail(clearest) + np.log(len(found))) / float(np.log(10.0))
    statement = (
        f"The residual of joint {joint} is bounded, as of a torque that switches between levels by itself "
        f"(kurtosis {size:.2g}; noise has 3 or more)"
    )
    return UnnamedPattern(joint, statement, clearest**2, chance)


def kurtosis(series: Vector, block: Indices) -> tuple[float, float]:
    """Give the fourth central moment over the variance's square, and its deviation from leaving out blocks.

    Examples
    --------
    >>> levels = np.tile([1.0, 1.0, -1.0, -1.0], 10)
    >>> kurtosis(levels, np.arange(40) // 4)
    (1.0, 0.0)
    """
    _, number = np.unique(block, return_inverse=True)
    sums = np.array([np.bincount(number, series**power) for power in range(5)])
    whole = sums.sum(axis=1)
    size = float(_kurtosis(whole))
    without = _kurtosis(whole[:, None] - sums)
    count = sums.shape[1]
    mean = float(without.mean())
    deviation = float(np.sqrt((count - 1.0) / count * np.sum((without - mean) ** 2)))
    return count * size - (count - 1.0) * mean, deviation


def _kurtosis(sums: np.ndarray) -> np.ndarray:
    """Turn sums of the powers 0 to 4 into the kurtosis."""
    mean, second, third, fourth = sums[1:] / sums[0]
    spread = second - mean**2
    moment = fourth - 4.0 * mean * third + 6.0 * mean**2 * second - 3.0 * mean**4
    return np.asarray(moment / np.maximum(spread, 1e-300) ** 2)
