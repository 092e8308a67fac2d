"""Say how sure a gain in simulated motion is, with an interval from whole blocks.

Windows of one block share motion and noise, so whole blocks are drawn with replacement, never windows.
Source: Kuensch, Ann. Stat. 17, 1989.
"""

import numpy as np

from ..arrays import Intervals
from ..simulation.multistep import Comparison
from .gain import DRAWS, FEWEST_BLOCKS, SEED


def motion_intervals(comparison: Comparison) -> Intervals | None:
    """Give the 95 % interval per joint of `Comparison.total_gain_percent`; None below four blocks."""
    keys = sorted(set(comparison.before.keys))
    if len(keys) < FEWEST_BLOCKS:
        return None
    weights = np.array(comparison.before.horizons) ** -2.0
    block = np.array([keys.index(key) for key in comparison.before.keys])
    sums = [
        np.array([weights @ (one.position[block == place] ** 2).sum(axis=0) for place in range(len(keys))])
        for one in (comparison.before, comparison.after)
    ]
    drawn = np.random.default_rng(SEED).integers(0, len(keys), (DRAWS, len(keys)))
    old, new = (np.sqrt(one[drawn].sum(axis=1)) for one in sums)
    improved = 100.0 * np.divide(old - new, old, out=np.zeros_like(old), where=old > 0.0)
    return np.asarray(np.percentile(improved, [2.5, 97.5], axis=0).T)
