"""Pass over a file's rows once: which lack a value or say nothing, whether stamps step back, and turns."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Indices, SampleMask, Samples
from ..channels import TIME
from ..model import LogRows, LogSource
from .idle import IdleRows
from .turns import Turns

BLOCK_ROWS = 32_768
LARGEST = 1e15
"""A number beyond this is no measured value."""
FIRST_ROWS = 5
Column = tuple[str, int]
"""Channel, and joint from 0."""


@dataclass(eq=False)
class Survey:
    """Carry what the rows of a source show before any is chosen.

    A value is missing that is absent, not finite or beyond any size.
    """

    samples: int
    marks: SampleMask | None = None
    """Rows that lack one of their values; None where there are none."""
    backwards: bool = False
    """Whether a stamp is smaller than one before it."""
    shared: bool = False
    """Whether a stamp is that of the row before."""
    counts: dict[Column, int] = field(default_factory=dict)
    first_rows: dict[Column, list[int]] = field(default_factory=dict)
    """Numbers of the first rows, from 1."""
    by_channel: dict[str, int] = field(default_factory=dict)
    """How many rows lack a value of a channel."""
    idle: IdleRows = field(default_factory=IdleRows)
    """Rows that say nothing."""
    turns: Turns = field(default_factory=lambda: Turns(()))
    """Whole turns by which angles leap."""
    _last: float = -np.inf

    @property
    def rows(self) -> Indices:
        """Give the numbers of the rows that lack a value, from 0."""
        return np.zeros(0, dtype=int) if self.marks is None else np.flatnonzero(self.marks)

    @property
    def ends(self) -> tuple[int, int]:
        """Count the rows of either end that all lack a value; none where no row is whole."""
        if self.marks is None or self.marks.all():
            return 0, 0
        return int(np.argmin(self.marks)), int(np.argmin(self.marks[::-1]))

    @property
    def inside(self) -> tuple[int, int]:
        """Count the rows between the ends that lack a value, and all there."""
        return len(self.rows) - sum(self.ends), self.samples - sum(self.ends)

    @property
    def worst(self) -> list[Column]:
        """Give the columns that lack values, the worst first."""
        return sorted(self.counts, key=lambda column: -self.counts[column])

    def take(self, rows: LogRows, first: int) -> None:
        """Take the next rows, the first of which has this number."""
        missing = np.zeros(len(rows.time), dtype=bool)
        for name, values in ((TIME, rows.time[:, None]), *rows.channels().items()):
            most = np.inf if name == TIME else LARGEST
            if np.max(values, initial=0.0) < most and np.min(values, initial=0.0) > -most:
                continue  # a comparison with NaN is false
            bad = ~(np.abs(values) < most)
            own = bad.any(axis=1)
            missing |= own
            self.by_channel[name] = self.by_channel.get(name, 0) + int(np.count_nonzero(own))
            for joint in np.flatnonzero(bad.any(axis=0)):
                self._count((name, int(joint)), bad[:, joint], first)
        if self.marks is None and missing.any():
            self.marks = np.zeros(self.samples, dtype=bool)
        if self.marks is not None:
            self.marks[first : first + len(missing)] = missing
        self._order(rows.time)
        self.idle.take(rows, first)
        self.turns.take(rows, first)

    def _order(self, stamps: Samples) -> None:
        known = stamps[np.isfinite(stamps)]
        if len(known):
            steps = np.diff(known, prepend=self._last)
            self.backwards = self.backwards or bool(np.any(steps < 0.0))
            self.shared = self.shared or bool(np.any(steps == 0.0))
            self._last = float(known[-1])

    def _count(self, column: Column, bad: SampleMask, first: int) -> None:
        self.counts[column] = self.counts.get(column, 0) + int(np.count_nonzero(bad))
        known = self.first_rows.setdefault(column, [])
        known += [first + int(row) + 1 for row in np.flatnonzero(bad)[: FIRST_ROWS - len(known)]]


def survey(source: LogSource, units: Sequence[str]) -> Survey:
    """Read a source once, with the SI unit of each joint's position.

    Examples
    --------
    >>> from veritorque.core.log.model import ArraySource
    >>> position = np.array([[0.0], [np.nan], [1.0]])
    >>> survey(ArraySource(LogRows(np.arange(3.0), position)), ["rad"]).counts
    {('position', 0): 1}
    """
    found = Survey(source.samples, turns=Turns(units))
    for start in range(0, source.samples, BLOCK_ROWS):
        found.take(source.rows(start, min(start + BLOCK_ROWS, source.samples)), start)
    return found
