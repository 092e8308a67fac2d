"""Give the share of a residual that a prediction explains on held-out blocks, with its interval.

Predictions from trees are noisy: on a residual of noise alone they would only make it larger. So each block's
prediction is scaled by the factor, between 0 and 1, that fits the *other* blocks best. Where nothing is
predictable, the factor and the share approach 0. The interval comes from the scatter between blocks.
Sources: Stone, J. R. Stat. Soc. B 36(2), 1974; Cochran, Sampling Techniques (1977), ch. 6 (ratios).
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...arrays import Indices, Vector
from ...numerics.distributions import student_quantile
from ..dataset.dataset import Dataset
from ..thresholds.residual import PREDICTION


@dataclass(frozen=True, eq=False)
class Share:
    """Hold the share of a variance that a prediction explains on held-out blocks, with its 95 % interval.

    The prediction is `prediction` times a factor per row; NaN where the row was not judged. Share and
    interval lie within 0 and 1.
    """

    share: float
    interval: tuple[float, float]
    prediction: Vector


def row_blocks(dataset: Dataset, blocks: int | None = None) -> Indices:
    """Cut the rows into contiguous blocks of nearly equal length, numbered from 0; none spans a gap."""
    wanted = PREDICTION.blocks if blocks is None else blocks
    label = np.zeros(len(dataset.time), dtype=int)
    borders = np.append(np.flatnonzero(dataset.starts), len(dataset.time))
    done = 0
    for start, stop in pairwise(borders):
        count = max(1, round(wanted * float(stop - start) / len(dataset.time)))
        label[start:stop] = done + np.arange(stop - start) * count // (stop - start)
        done += count
    return label


def share_on_blocks(prediction: Vector, residual: Vector, block: Indices) -> Share:
    """Evaluate a prediction of held-out rows; rows where it is NaN are left out.

    Examples
    --------
    A prediction that is right on every block explains all:

    >>> wave = np.tile([1.0, -1.0], 20)
    >>> share_on_blocks(wave, wave, np.arange(40) // 10).interval
    (1.0, 1.0)
    """
    judged = np.flatnonzero(np.isfinite(prediction))
    guess, truth = prediction[judged], residual[judged]
    _, number = np.unique(block[judged], return_inverse=True)
    both, own, power = (np.bincount(number, series) for series in (guess * truth, guess**2, truth**2))
    if len(both) < 2 or power.sum() <= 0.0:
        return Share(0.0, (0.0, 0.0), np.where(np.isfinite(prediction), 0.0, np.nan))
    others = own.sum() - own
    factor = np.divide(both.sum() - both, others, out=np.zeros(len(own)), where=others > 0.0).clip(0.0, 1.0)
    gain = 2.0 * factor * both - factor**2 * own
    share = float(gain.sum() / power.sum())
    missed = (gain - share * power) / power.sum()
    deviation = float(np.sqrt(len(gain) / (len(gain) - 1) * np.sum(missed**2)))
    reach = student_quantile(PREDICTION.quantile, len(gain) - 1) * deviation
    scaled = np.full(len(prediction), np.nan)
    scaled[judged] = factor[number] * guess
    return Share(_clip(share), (_clip(share - reach), _clip(share + reach)), scaled)


def _clip(share: float) -> float:
    return float(np.clip(share, 0.0, 1.0))
