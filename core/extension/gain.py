"""Measure what an extension gained per joint on held-out blocks, with an interval from whole blocks.

Both models were fitted without these blocks. Blocks are drawn with replacement; the interval is that of the
improvement, not of either error. Source: Kuensch, Ann. Stat. 17, 1989.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters, Matrix, Vector
from ..regressor.observe import Observation

DRAWS = 1000
SEED = 0
FEWEST_BLOCKS = 4


@dataclass(frozen=True)
class JointGain:
    """Compare a joint's residual on held-out blocks before and after; RMS in N m or N.

    `interval_95` is that of the improvement in percent; None with fewer than four blocks.
    """

    joint: int
    rms_before: float
    rms_after: float
    improvement_percent: float
    interval_95: tuple[float, float] | None


def gains(
    before: tuple[Observation, BaseParameters],
    after: tuple[Observation, Vector],
    held: tuple[int, ...],
) -> tuple[JointGain, ...]:
    """Compare two identified models, the second with parameters of its own, on their held-out blocks."""
    old, rows = _squares(*before, held)
    new, _ = _squares(*after, held)
    found = []
    for joint in range(old.shape[1]):
        one, other = (
            float(np.sqrt(squares[:, joint].sum() / max(rows[:, joint].sum(), 1.0))) for squares in (old, new)
        )
        found.append(
            JointGain(joint + 1, one, other, _percent(one, other), _interval(old[:, joint], new[:, joint]))
        )
    return tuple(found)


def _squares(observation: Observation, base: BaseParameters, held: tuple[int, ...]) -> tuple[Matrix, Matrix]:
    """Give the sum of squared residuals and the number of rows, blocks x joints."""
    blocks = [observation.blocks[place] for place in held]
    squares = [
        [
            factor.residual_square(base[columns])
            for factor, columns in zip(block.factors, observation.columns_of, strict=True)
        ]
        for block in blocks
    ]
    rows = [[float(factor.rows) for factor in block.factors] for block in blocks]
    return np.array(squares).reshape(len(held), -1), np.array(rows).reshape(len(held), -1)


def _interval(old: np.ndarray, new: np.ndarray) -> tuple[float, float] | None:
    if len(old) < FEWEST_BLOCKS:
        return None
    drawn = np.random.default_rng(SEED).integers(0, len(old), (DRAWS, len(old)))
    sums = np.sqrt(old[drawn].sum(axis=1)), np.sqrt(new[drawn].sum(axis=1))
    improved = 100.0 * (1.0 - sums[1] / np.maximum(sums[0], 1e-300))
    return float(np.percentile(improved, 2.5)), float(np.percentile(improved, 97.5))


def _percent(before: float, after: float) -> float:
    return 100.0 * (1.0 - after / before) if before > 0.0 else 0.0
