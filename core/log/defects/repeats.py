"""Find rows that repeat the row before exactly, as a recorder writes them when it has missed a sample.

Positions and torques together carry noise, so that an exact repeat is a copy and not a coincidence. Many
copies in a row are a robot that stands still, or a recorder that does while the robot moves on.
"""

from collections.abc import Collection
from itertools import pairwise

import numpy as np

from ...arrays import JointVector
from ..model import Defect
from .runs import LongRuns, Runs
from .stretch import Facts, Stretch, count_text, repeats_previous

NOTICED = 1e-3
"""A smaller share of repeated rows is not reported."""
JUMP = 5.0
"""A joint that is farther on after a standstill, in mean increments, has not stood still."""
Rows = tuple[tuple[int, int], ...]
"""(start, stop) rows."""


class Repeats:
    """Count the rows whose positions and torques repeat the row before."""

    def __init__(self, joints: int) -> None:
        self._runs = Runs()
        self._long = LongRuns(1 + joints)
        self._travel: JointVector | float = 0.0
        self._rows = 0

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        position = stretch.position[:, stretch.first_new :]
        same = repeats_previous(position)
        if np.any(same):
            same &= repeats_previous(stretch.channels[stretch.effort][:, stretch.first_new :])
        self._runs.feed(same, stretch.time[stretch.first_new + 1 :])
        increments = np.abs(np.diff(position, axis=1))
        self._travel = self._travel + increments.sum(axis=1)
        self._rows += len(same)
        rows = stretch.first + stretch.first_new + 1.0 + np.arange(len(same))
        self._long.feed(same, np.vstack([rows, increments]))

    @property
    def frozen(self) -> Rows:
        """Give the rows that a recorder wrote while it stood still and the robot did not."""
        usual = JUMP * self._travel / max(self._rows, 1)
        runs = self._long.ended
        moved = np.any(runs[:, 1, 1:] > usual, axis=1)
        return tuple((int(begin), int(stop)) for begin, stop in runs[moved][:, :, 0])

    def defects(self, facts: Facts) -> list[Defect]:
        """State the share of repeated rows, and where the log is cut for them."""
        self._runs.close()
        rows, frozen = self._runs.rows, len(self.frozen)
        if rows <= NOTICED * facts.samples and not frozen:
            return []
        statement = (
            f"{rows} of {facts.samples} rows ({100.0 * rows / facts.samples:.2g} %) repeat the positions and "
            "torques of the row before exactly."
        )
        if frozen:
            statement += f" In {count_text(frozen, 'run')} of them the robot moved on: the log is cut there."
        return [Defect("repeated_rows", "position", None, rows, self._runs.intervals, statement)]


def cut(segments: Rows, frozen: Rows) -> Rows:
    """Take rows, which may overlap, out of segments.

    Examples
    --------
    >>> cut(((0, 50), (50, 100)), ((60, 70), (80, 100)))
    ((0, 50), (50, 60), (70, 80))
    >>> cut(((0, 50), (50, 100)), ((40, 60),))
    ((0, 40), (60, 100))
    >>> cut(((0, 50),), ((20, 30), (10, 40), (15, 20)))
    ((0, 10), (40, 50))
    """
    out, apart = [], joined(frozen)
    for start, stop in segments:
        inside = [min(max(edge, start), stop) for rows in apart for edge in rows]
        out += list(pairwise([start, *inside, stop]))[::2]
    return tuple((start, stop) for start, stop in out if stop > start)


def joined(rows: Collection[tuple[int, int]]) -> Rows:
    """Join what overlaps."""
    out: list[tuple[int, int]] = []
    for begin, stop in sorted(rows):
        if out and begin <= out[-1][1]:
            out[-1] = out[-1][0], max(out[-1][1], stop)
        else:
            out.append((begin, stop))
    return tuple(out)
