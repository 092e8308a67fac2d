"""Measure what an extension gained per joint on held-out blocks, in torque and in simulated motion.

Both models were fitted without these blocks. Intervals are those of the improvement, not of either error.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters, Intervals, Matrix, Vector
from ..diagnosis.thresholds.checks import MOTION
from ..numerics.block_bootstrap import FEWEST_BLOCKS, interval_95, resampled_sums
from ..regressor.observe import Observation
from ..simulation.multistep import Comparison

DRAWS = 1000
SEED = 0


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
    before: tuple[Observation, BaseParameters], after: tuple[Observation, Vector], held: tuple[int, ...]
) -> tuple[JointGain, ...]:
    """Compare two identified models, the second with parameters of its own, on their held-out blocks."""
    old, rows = _squares(*before, held)
    new, _ = _squares(*after, held)
    found = []
    for joint in range(old.shape[1]):
        first, second = (
            float(np.sqrt(squares[:, joint].sum() / max(rows[:, joint].sum(), 1.0))) for squares in (old, new)
        )
        interval = _interval(old[:, joint], new[:, joint])
        found.append(JointGain(joint + 1, first, second, _percent(first, second), interval))
    return tuple(found)


def _squares(observation: Observation, base: BaseParameters, held: tuple[int, ...]) -> tuple[Matrix, Matrix]:
    """Give the sum of squared residuals and the number of rows, blocks x joints."""
    blocks = [observation.blocks[index] for index in held]
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
    sums = [np.sqrt(resampled_sums(squares, DRAWS, SEED)) for squares in (old, new)]
    low, high = interval_95(100.0 * (1.0 - sums[1] / np.maximum(sums[0], 1e-300)))
    return float(low), float(high)


def motion_intervals(comparison: Comparison) -> Intervals | None:
    """Give the 95 % interval per joint of `Comparison.total_gain_percent`; None below four blocks.

    Windows of one block share motion and noise, so blocks are drawn, never windows.
    """
    keys = sorted(set(comparison.before.keys))
    if len(keys) < FEWEST_BLOCKS:
        return None
    weights = np.array(comparison.before.horizons) ** -2.0
    block = np.array([keys.index(key) for key in comparison.before.keys])
    sums = [
        np.array(
            [weights @ (windows.position[block == number] ** 2).sum(axis=0) for number in range(len(keys))]
        )
        for windows in (comparison.before, comparison.after)
    ]
    old, new = (np.sqrt(resampled_sums(squares, DRAWS, SEED)) for squares in sums)
    return interval_95(100.0 * np.divide(old - new, old, out=np.zeros_like(old), where=old > 0.0))


def worsens_motion(comparison: Comparison) -> bool:
    """Tell whether a correction makes the simulated motion clearly worse: on some joint, and on the whole."""
    intervals = motion_intervals(comparison)
    if intervals is None:
        return False
    clearly = bool(np.any(intervals[:, 1] < -MOTION.clearly_worse_percent))
    return clearly and float(np.mean(comparison.total_gain_percent)) < 0.0


def _percent(before: float, after: float) -> float:
    return 100.0 * (1.0 - after / before) if before > 0.0 else 0.0
