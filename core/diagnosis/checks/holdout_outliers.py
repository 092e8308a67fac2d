"""Test whether held-out blocks are outliers: a short event may lie in them alone.

Held-out blocks are spread evenly, so that a lasting effect acts on fitted and held-out rows. What happened
once may fall into a held-out block. Then other blocks are held out: before the search where a plain fit shows
the outlier, and by a further search where only its result shows it.
Source: Stone, J. R. Stat. Soc. B 36(2), 1974, for exchanging the parts of a log.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...arrays import Indices, Vector
from ..dataset.dataset import Dataset
from ..regression.prewhitening import prewhitened_residual
from ..regression.rows import append_columns
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..thresholds.search import HOLDOUT

Explained = tuple[HypothesisFitter, Hypothesis]
"""A fitter and a hypothesis that it fitted."""


def has_holdout_outliers(fitter: HypothesisFitter, found: Hypothesis) -> bool:
    """Tell whether the error of a held-out block is far larger than that of any fitted one."""
    holdout = append_columns(fitter.rows.held_out, fitter.columns(found.members))
    for part, fitted, seen in zip(holdout, found.fit.joints, fitter.rows.fitted, strict=True):
        missed = part.left(found.fit.values)[:, None]
        left = prewhitened_residual(part, fitted.noise, missed)[:, 0]
        known = fitted.left(found.fit.values)
        new, old = (_powers(fitter.dataset, *pair) for pair in ((part.rows, left), (seen.rows, known)))
        if (
            len(new)
            and len(old)
            and new.max() > max(HOLDOUT.over_largest * old.max(), HOLDOUT.over_usual * old.mean())
        ):
            return True
    return False


def with_typical_holdout(dataset: Dataset, plain: Explained, fit: Callable[[Dataset], Explained]) -> Dataset:
    """Hold other blocks out from the first where those held out are outliers, and the others are not.

    Parameters
    ----------
    plain
        The data set's fitter without candidates, and its fit.
    fit
        Gives the same of other rows.
    """
    other = with_other_holdout(dataset) if has_holdout_outliers(*plain) else None
    return dataset if other is None or has_holdout_outliers(*fit(other)) else other


def with_other_holdout(dataset: Dataset) -> Dataset | None:
    """Hold other blocks out: those half-way to the next ones.

    None where whole logs are held out, or where the robot rests or reverses in the others.
    """
    held_out = np.zeros_like(dataset.held_out)
    for log in np.unique(dataset.log):
        own = dataset.log == log
        blocks = np.unique(dataset.block[own])
        held = np.unique(dataset.block[own & dataset.held_out])
        if len(held) == len(blocks) or not len(held):
            return None
        shift = max(len(blocks) // (2 * len(held)), 1)
        others = blocks[(np.searchsorted(blocks, held) + shift) % len(blocks)]
        held_out |= own & np.isin(dataset.block, others)
    now, then = (np.count_nonzero(dataset.clear[rows], axis=0) for rows in (dataset.held_out, held_out))
    return replace(dataset, held_out=held_out) if np.all(then >= HOLDOUT.as_many * now) else None


def _powers(dataset: Dataset, rows: Indices, left: Vector) -> np.ndarray:
    """Give the mean square of every block that has enough rows."""
    block = dataset.block_of_all[rows]
    counts = np.bincount(block)
    power = np.bincount(block, left**2)
    enough = counts >= HOLDOUT.least_rows
    return np.asarray(power[enough] / counts[enough])
