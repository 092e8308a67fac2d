"""Tell a clock that starts anew from rows that are out of order, by the stamps and by the motion.

After a new start the stamps stay behind for long, and each run is in order. Rows that were shuffled, or
overtook each other on a network, are put in order by their stamps, and the motion becomes smoother by it.
Sorting several runs by their stamps would weave them into a motion that never was.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...arrays import Indices, JointSeries, Samples

RECOVERY_ROWS = 20
"""Stamps that are ahead again within so many rows were overtaken; others started anew."""
RUN_ROWS = 100
"""Fewer rows than these on average between two backward steps are no runs."""
SMOOTHER = 0.9
"""Rows were shuffled if the joints' way is shorter than this share of what it is in the file's order."""


@dataclass(frozen=True, eq=False)
class Order:
    """Say where runs begin, and in which order the rows have to be read."""

    starts: tuple[int, ...] = (0,)
    """First row of every run, after sorting."""
    sorting: Indices | None = None
    """Row numbers in the order of time; None where the file's order holds."""
    moved: int = 0
    """How many rows are not where their stamp belongs."""


def order_of(time: Samples, position: JointSeries) -> Order:
    """Judge the order of rows with finite stamps; that of the file where neither explanation holds.

    Examples
    --------
    >>> time = np.arange(300) / 100.0
    >>> order_of(np.concatenate([time, time]), np.zeros((600, 1))).starts
    (0, 300)
    """
    back = np.flatnonzero(np.diff(time) < 0.0) + 1
    if not len(back):
        return Order()
    if len(back) * RUN_ROWS < len(time):
        starts = _new_starts(time, back)
        sorting = _sorted_within(time, starts)
        moved = int(np.count_nonzero(sorting != np.arange(len(time))))
        return Order(starts, sorting if moved else None, moved)
    sorting = np.argsort(time, kind="stable")
    if len(back) == len(time) - 1 or _way(position[sorting]) < SMOOTHER * _way(position):
        return Order((0,), sorting, int(np.count_nonzero(sorting != np.arange(len(time)))))
    return Order()


def _new_starts(time: Samples, back: Indices) -> tuple[int, ...]:
    """Keep the backward steps after which the stamps stay behind."""
    starts = [0]
    for row in back:
        ahead = float(time[starts[-1] : row].max())
        if float(time[row : row + RECOVERY_ROWS].max()) <= ahead:
            starts.append(int(row))
    return tuple(starts)


def _sorted_within(time: Samples, starts: tuple[int, ...]) -> Indices:
    edges = [*starts, len(time)]
    return np.concatenate(
        [start + np.argsort(time[start:stop], kind="stable") for start, stop in pairwise(edges)]
    )


def _way(position: JointSeries) -> float:
    """Give the way of all joints together, each in shares of its range."""
    span = np.maximum(np.ptp(position, axis=0), np.finfo(float).tiny)
    return float(np.sum(np.abs(np.diff(position, axis=0)) / span))
