"""Collect where something holds, as runs of samples that may cross from one stretch into the next.

A log can hold a million runs; the count and total are exact, and only the twenty longest are kept.
"""

import numpy as np

from ...arrays import EquationRows, Mask, SampleMask, Samples
from ...numerics.marked_runs import marked_runs
from ..model import STANDING_ROWS

KEPT = 20
BY_CHANCE = 1e-6
"""A run is longer than chance makes one in a log with this probability."""


class Runs:
    """Count runs of marked samples.

    Parameters
    ----------
    shortest
        Runs of fewer samples are passed over.

    Examples
    --------
    >>> runs = Runs(shortest=2)
    >>> runs.feed(np.array([True, True, False, True]), np.array([0.0, 0.1, 0.2, 0.3]))
    >>> runs.close()
    >>> runs.rows, runs.intervals
    (2, ((0.0, 0.1),))
    """

    def __init__(self, shortest: int = 1) -> None:
        self.shortest = shortest
        self.rows = 0
        self.seconds = 0.0
        self._kept: list[tuple[float, float, int]] = []
        self._open: tuple[float, float, int] | None = None

    def feed(self, mask: SampleMask, time: Samples) -> None:
        """Take the next samples; they follow on those fed before."""
        if not mask.any():
            self.close()
            return
        starts, stops = marked_runs(mask).T
        begin, end, rows = time[starts], time[stops - 1], stops - starts
        if self._open is not None and starts[0] == 0:
            begin[0] = self._open[0]
            rows[0] += self._open[2]
            self._open = None
        self.close()
        if stops[-1] == len(mask):
            self._open = float(begin[-1]), float(end[-1]), int(rows[-1])
            begin, end, rows = begin[:-1], end[:-1], rows[:-1]
        long = np.flatnonzero(rows >= self.shortest)
        self.rows += int(rows[long].sum())
        self.seconds += float((end[long] - begin[long]).sum())
        longest = long[np.argsort(-rows[long], kind="stable")[:KEPT]]
        self._keep([(float(begin[i]), float(end[i]), int(rows[i])) for i in longest])

    def close(self) -> None:
        """End the run that is still open."""
        if self._open is not None and self._open[2] >= self.shortest:
            self.rows += self._open[2]
            self.seconds += self._open[1] - self._open[0]
            self._keep([self._open])
        self._open = None

    def _keep(self, runs: list[tuple[float, float, int]]) -> None:
        self._kept = sorted([*self._kept, *runs], key=lambda run: -run[2])[:KEPT]

    @property
    def intervals(self) -> tuple[tuple[float, float], ...]:
        """Give (start, end) of the longest runs in s, in the order of time."""
        return tuple(sorted((start, end) for start, end, _ in self._kept))


class LongRuns:
    """Keep what was known at both ends of every run of more than so many marked rows.

    Examples
    --------
    >>> runs = LongRuns(1)
    >>> runs.feed(np.arange(40) > 9, np.arange(40.0)[None])
    >>> runs.feed(np.arange(40) < 9, 40.0 + np.arange(40.0)[None])
    >>> runs.ended.tolist()
    [[[10.0], [49.0]]]
    """

    def __init__(self, values: int, longer_than: int = STANDING_ROWS) -> None:
        self._longer_than = longer_than
        self._kept = [np.zeros((0, 2, values))]
        self._open: np.ndarray | None = None
        self._last = np.zeros(values)

    def feed(self, marks: SampleMask, known: EquationRows) -> None:
        """Take the next rows; they follow on those fed before.

        Parameters
        ----------
        known
            What is known of each row, values x rows; the first value is its number.
        """
        self._last = known[:, -1].copy()
        if self._open is None and not marks.any():
            return
        before = np.concatenate([[self._open is not None], marks[:-1]])
        edges = known[:, marks != before].T
        if self._open is not None:
            edges = np.vstack([self._open, edges])
        whole = len(edges) // 2 * 2
        self._open = edges[-1] if len(edges) > whole else None
        self._keep(edges[:whole].reshape(-1, 2, len(known)))

    def _keep(self, pairs: np.ndarray) -> None:
        self._kept.append(pairs[pairs[:, 1, 0] - pairs[:, 0, 0] > self._longer_than])

    def close(self) -> None:
        """End the run that is still open, with what was known of the last row."""
        if self._open is not None:
            end = self._last.copy()
            end[0] += 1.0
            self._keep(np.array([[self._open, end]]))
            self._open = None

    @property
    def ended(self) -> np.ndarray:
        """Give what was known at each run's first row and at the first after it, runs x ends x values."""
        return np.concatenate(self._kept)


def is_no_chance(lasted: np.ndarray, share: float, rows: int) -> Mask:
    """Tell which runs are longer than chance makes any in so many rows, a share of which is marked elsewhere.

    Examples
    --------
    >>> is_no_chance(np.array([5.0, 6.0]), 0.01, 10_000)
    array([False,  True])
    """
    chance = np.log(max(share, 1.0 / rows))
    return np.asarray(lasted * chance + np.log(rows) < np.log(BY_CHANCE))
