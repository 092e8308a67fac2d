"""See whether held-out rows hold something that the fitted rows never showed: a short event, mostly.

What is held out is spread evenly, so that any lasting effect shows on both sides; what happened once may lie
on the wrong one. Then other blocks are held out: before anything is searched where a plain fit shows it, and
where only what was found shows it the search begins anew. Source: Stone, J. R. Stat. Soc. B 36(2), 1974, for
exchanging the parts of a log.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...arrays import Indices, Vector
from ..dataset.dataset import Look
from ..regression.prewhitening import white_left
from ..regression.rows import extended
from ..search.fitter import Bench
from ..search.hypothesis import Hypothesis

Explained = tuple[Bench, Hypothesis]
"""A bench and a hypothesis that was fitted on it."""
OVER_LARGEST, OVER_USUAL = 2.5, 6.0
"""How many times the largest and the usual mean square of the fitted blocks a held-out one must have."""
LEAST_ROWS = 8
"""Of a block, to be judged."""
AS_MANY = 0.5
"""Other blocks hold out this share at least of each joint's rows clear of reversals: few judge nothing."""


def surprised(bench: Bench, found: Hypothesis) -> bool:
    """Tell whether a block that was held out is missed far worse than any that was fitted."""
    unseen = extended(bench.unseen, bench.columns(found.members))
    for part, fitted, seen in zip(unseen, found.fit.joints, bench.base, strict=True):
        missed = (part.torque - part.columns @ found.fit.values)[:, None]
        left = white_left(part, fitted.noise, missed)[:, 0]
        known = fitted.left(found.fit.values)
        new, old = (_powers(bench.look, *one) for one in ((part.rows, left), (seen.rows, known)))
        if len(new) and len(old) and new.max() > max(OVER_LARGEST * old.max(), OVER_USUAL * old.mean()):
            return True
    return False


def unsurprising(look: Look, plain: Explained, fit: Callable[[Look], Explained]) -> Look:
    """Hold other blocks out from the first where what is held out surprises, and those would not.

    Parameters
    ----------
    plain
        The look's rows with nothing suspected, and their fit.
    fit
        Gives the same of other rows.
    """
    other = turned(look) if surprised(*plain) else None
    return look if other is None or surprised(*fit(other)) else other


def turned(look: Look) -> Look | None:
    """Hold other blocks out: those half-way to the next ones.

    None where whole logs are held out, or where the robot rests or turns round in the others.
    """
    held_out = np.zeros_like(look.held_out)
    for log in np.unique(look.log):
        own = look.log == log
        blocks = np.unique(look.block[own])
        held = np.unique(look.block[own & look.held_out])
        if len(held) == len(blocks) or not len(held):
            return None
        shift = max(len(blocks) // (2 * len(held)), 1)
        others = blocks[(np.searchsorted(blocks, held) + shift) % len(blocks)]
        held_out |= own & np.isin(look.block, others)
    now, then = (np.count_nonzero(look.clear[one], axis=0) for one in (look.held_out, held_out))
    return replace(look, held_out=held_out) if np.all(then >= AS_MANY * now) else None


def _powers(look: Look, rows: Indices, left: Vector) -> np.ndarray:
    """Give the mean square of every block that has enough rows."""
    block = look.block_of_all[rows]
    counts = np.bincount(block)
    power = np.bincount(block, left**2)
    enough = counts >= LEAST_ROWS
    return np.asarray(power[enough] / counts[enough])
