"""Find rows that repeat the row before exactly, as a recorder writes them when it has missed a sample.

Positions and torques together carry noise, so that an exact repeat is a copy and not a coincidence. Many
copies in a row are a robot that stands still, or a recorder that does while the robot moves on.
"""

from itertools import pairwise

import numpy as np

from core.arrays import JointVector, SampleMask, Series
from core.log.defects.runs import Runs
from core.log.defects.stretch import Facts, Stretch, counted, repeats_previous
from core.log.model import STANDING_ROWS, Defect

NOTICED = 1e-3
"""A smaller share of repeated rows is not worth a word."""
JUMP = 5.0
"""A joint that is farther on after a standstill, in mean increments, has not stood still."""

Rows = tuple[tuple[int, int], ...]
"""(start, stop) rows."""


class Repeats:
    """Count the rows whose positions and torques repeat the row before."""

    def __init__(self) -> None:
        self._runs = Runs()
        self._begin: int | None = None
        self._long: list[tuple[int, int, JointVector]] = []
        self._travel: JointVector | float = 0.0
        self._rows = 0

    def see(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        position = stretch.position[:, stretch.seam :]
        same = repeats_previous(position)
        effort = stretch.others.get("current") if stretch.torque is None else stretch.torque
        if effort is not None and np.any(same):
            same &= repeats_previous(effort[:, stretch.seam :])
        self._runs.feed(same, stretch.time[stretch.seam + 1 :])
        increments = np.abs(np.diff(position, axis=1))
        self._travel = self._travel + increments.sum(axis=1)
        self._rows += len(same)
        self._note(same, increments, stretch.first + stretch.seam + 1)

    def _note(self, same: SampleMask, increments: Series, first: int) -> None:
        """Keep the long runs that end here, and how far the joints are when they do."""
        begun = [] if self._begin is None else [self._begin]
        before = np.concatenate([[bool(begun)], same[:-1]])
        begins = np.concatenate([begun, first + np.flatnonzero(same & ~before)]).astype(int)
        ends = np.flatnonzero(~same & before)
        rows = first + ends - begins[: len(ends)]
        for index in np.flatnonzero(rows > STANDING_ROWS):
            begin, end = int(begins[index]), int(ends[index])
            self._long.append((begin, first + end, increments[:, end]))
        self._begin = int(begins[-1]) if len(begins) > len(ends) else None

    @property
    def frozen(self) -> Rows:
        """Give the rows that a recorder wrote while it stood still and the robot did not."""
        usual = JUMP * self._travel / max(self._rows, 1)
        return tuple((begin, stop) for begin, stop, step in self._long if np.any(step > usual))

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
            statement += f" In {counted(frozen, 'run')} of them the robot moved on: the log is cut there."
        return [Defect("repeated_rows", "position", None, rows, self._runs.intervals, statement)]


def cut(segments: Rows, frozen: Rows) -> Rows:
    """Take rows out of segments.

    Examples
    --------
    >>> cut(((0, 50), (50, 100)), ((60, 70), (80, 100)))
    ((0, 50), (50, 60), (70, 80))
    >>> cut(((0, 50), (50, 100)), ((40, 60),))
    ((0, 40), (60, 100))
    """
    out = []
    for start, stop in segments:
        inside = [min(max(edge, start), stop) for rows in frozen for edge in rows]
        out += list(pairwise([start, *inside, stop]))[::2]
    return tuple((start, stop) for start, stop in out if stop > start)
