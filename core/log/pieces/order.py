"""Tell a clock that starts anew from rows that are out of order, by the stamps and by the motion.

After a new start the stamps stay behind for long, and each run is in order. Rows that were shuffled, or
overtook each other on a network, are put in order by their stamps, and the motion becomes smoother by it.
Sorting several runs by their stamps would weave them into a motion that never was. A row that does not fit
where its stamp belongs has a broken stamp.
"""

from bisect import bisect_right
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
FEW = 0.01
"""Up to this share of a run's rows may be out of order, or have broken stamps."""
FITTING = 4.0
"""A row fits where its stamp belongs if it lengthens the joints' way by so many mean steps at most."""
BROKEN_STAMPS = 2
"""So many stamps that are far ahead do not make all that follows a new start."""


@dataclass(frozen=True, eq=False)
class Order:
    """Say where runs begin, and which rows have to be read in which order."""

    starts: tuple[int, ...] = (0,)
    """First row of every run, among those that are read."""
    rows: Indices | None = None
    """Row numbers in the order of time; None where the file's order holds."""
    moved: int = 0
    """How many rows are not where their stamp belongs."""
    broken: int = 0
    """How many rows with a stamp that is not theirs are left out."""


def order_of(time: Samples, position: JointSeries) -> Order:
    """Judge the order of rows with finite stamps; that of the file where no explanation holds.

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
        return _of_runs(time, position, _new_starts(time, back))
    sorting = np.argsort(time, kind="stable")
    if len(back) == len(time) - 1 or _way(position[sorting]) < SMOOTHER * _way(position):
        return Order((0,), sorting, int(np.count_nonzero(sorting != np.arange(len(time)))))
    return Order()


def _of_runs(time: Samples, position: JointSeries, starts: tuple[int, ...]) -> Order:
    """Put every run in order by itself."""
    edges = [*starts, len(time)]
    runs = [start + _tidied(time[start:stop], position[start:stop]) for start, stop in pairwise(edges)]
    rows = np.concatenate(runs)
    if np.array_equal(rows, np.arange(len(time))):
        return Order(starts)
    firsts = tuple(int(first) for first in np.cumsum([0, *map(len, runs)])[:-1])
    moved = sum(int(np.count_nonzero(np.diff(run) < 0)) for run in runs)
    return Order(firsts, rows, moved, len(time) - len(rows))


def _tidied(time: Samples, position: JointSeries) -> Indices:
    """Sort rows that overtook each other, or leave out those that do not fit where their stamps belong."""
    every = np.arange(len(time))
    if np.all(np.diff(time) >= 0.0):
        return every
    kept = _longest_in_order(time)
    removed = len(time) - len(kept)
    if removed > FEW * len(time):
        return every
    sorting = np.argsort(time, kind="stable")
    mean_step = _way(position[kept]) / len(kept)
    fits = _way(position[sorting]) - _way(position[kept]) <= FITTING * removed * mean_step
    return sorting if fits else kept


def _longest_in_order(time: Samples) -> Indices:
    """Give the most rows whose stamps do not decrease, by patience sorting."""
    ends: list[float] = []
    last: list[int] = []
    before = np.full(len(time), -1)
    for row, stamp in enumerate(time.tolist()):
        place = bisect_right(ends, stamp)
        before[row] = last[place - 1] if place else -1
        ends[place : place + 1] = [stamp]
        last[place : place + 1] = [row]
    found = []
    row = last[-1]
    while row >= 0:
        found.append(row)
        row = int(before[row])
    return np.array(found[::-1])


def _new_starts(time: Samples, back: Indices) -> tuple[int, ...]:
    """Keep the backward steps after which the stamps stay behind."""
    starts = [0]
    for row in back:
        run = time[starts[-1] : row]
        ahead = float(np.sort(run)[-1 - BROKEN_STAMPS] if len(run) > RECOVERY_ROWS else run.max())
        if float(time[row : row + RECOVERY_ROWS].max()) <= ahead:
            starts.append(int(row))
    return tuple(starts)


def _way(position: JointSeries) -> float:
    """Give the way of all joints together, each in shares of its range."""
    span = np.maximum(np.ptp(position, axis=0), np.finfo(float).tiny)
    return float(np.sum(np.abs(np.diff(position, axis=0)) / span))
