"""Draw contiguous blocks with replacement: intervals for samples that depend on their neighbours.

Neighbouring rows share noise and motion, so whole blocks are drawn, never rows. Source: Kuensch, Ann. Stat.
17, 1989.
"""

import numpy as np

from ..arrays import BlockDraws

FEWEST_BLOCKS = 4
"""With fewer blocks an interval says nothing."""


def block_draws(blocks: int, draws: int, seed: int) -> BlockDraws:
    """Draw the indices of as many blocks as there are, one row per draw.

    Examples
    --------
    >>> block_draws(4, 2, seed=0)
    array([[3, 2, 2, 1],
           [1, 0, 0, 0]])
    """
    return np.random.default_rng(seed).integers(0, blocks, (draws, blocks))


def resampled_sums(per_block: np.ndarray, draws: int, seed: int) -> np.ndarray:
    """Sum what the blocks hold (first axis) over every draw of them; one row per draw."""
    return np.asarray(per_block[block_draws(len(per_block), draws, seed)].sum(axis=1))


def interval_95(values: np.ndarray) -> np.ndarray:
    """Give the 2.5 and 97.5 % points over the draws (first axis), as the last axis.

    Examples
    --------
    >>> interval_95(np.arange(1001.0))
    array([ 25., 975.])
    """
    return np.asarray(np.percentile(values, [2.5, 97.5], axis=0).T)
