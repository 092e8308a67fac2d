"""Measure what a finding gains on held-out rows, with an interval from a block bootstrap."""

import numpy as np

from ...arrays import JointSeries
from ...numerics.block_bootstrap import FEWEST_BLOCKS, interval_95, resampled_sums
from ..result import Gain
from ..thresholds.search import HOLDOUT

DRAWS = 400
SEED = 0


def gain(
    before: JointSeries, after: JointSeries, mask: np.ndarray, block: np.ndarray, joints: tuple[int, ...]
) -> Gain | None:
    """Compare two residuals on marked rows (rows x joints); None where there are too few.

    Parameters
    ----------
    block
        Per row, the contiguous block it belongs to.
    joints
        The finding's joints, from 0: the interval is theirs together.
    """
    counts = np.maximum(mask.sum(axis=0), 1)
    old, new = before**2 * mask, after**2 * mask
    groups = _groups(np.asarray(mask.any(axis=1)), block)
    if len(groups) < FEWEST_BLOCKS:
        return None
    scale = np.maximum(old.sum(axis=0) / counts, 1e-300)
    own = list(joints)
    sums = np.array([[(square[rows][:, own] / scale[own]).sum() for square in (old, new)] for rows in groups])
    totals = resampled_sums(sums, DRAWS, SEED)
    improvements = 100.0 * (1.0 - np.sqrt(totals[:, 1] / np.maximum(totals[:, 0], 1e-300)))
    low, high = interval_95(improvements)
    rms_old, rms_new = np.sqrt(old.sum(axis=0) / counts), np.sqrt(new.sum(axis=0) / counts)
    total = sums.sum(axis=0)
    return Gain(
        rms_old,
        rms_new,
        100.0 * (1.0 - rms_new / np.maximum(rms_old, 1e-300)),
        float(100.0 * (1.0 - np.sqrt(total[1] / max(total[0], 1e-300)))),
        (float(low), float(high)),
    )


def _groups(marked: np.ndarray, block: np.ndarray) -> list[np.ndarray]:
    """Cut the marked rows into contiguous groups of about half a second within their blocks."""
    rows = np.flatnonzero(marked)
    if not len(rows):
        return []
    cuts = np.flatnonzero((np.diff(rows) > 1) | (np.diff(block[rows]) != 0)) + 1
    return [
        part
        for run in np.split(rows, cuts)
        for part in np.array_split(run, max(1, len(run) // HOLDOUT.block_rows))
        if len(part)
    ]
