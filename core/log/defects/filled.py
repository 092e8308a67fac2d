"""Find efforts that follow a straight line, as a recorder writes them that fills in what it has missed.

Noise bends every three samples: where it does not while the joint moves, nothing was measured. At rest a
controller may be quiet. An effort without noise, one that is coarse, or one that was sampled more slowly than
it is logged has straight lines everywhere, and is not judged.
"""

import numpy as np

from ...arrays import Samples, Vector
from ..channels import EFFORTS
from ..model import Defect
from .clock import Clock
from .repeats import Rows, joined
from .runs import KEPT, LongRuns, is_no_chance
from .stretch import Facts, Stretch, count_text
from .stuck import MOVES, OFTEN, net_travel

FEWEST_FILLED = 5
"""Fewer samples in a row may lie on a line by chance."""
STRAIGHT = 1e-3
"""Of the effort's usual bend: noise is seldom below it, the rounding of a filled line seldom above."""
_EVERY = 8
"""Of so many samples one is enough to tell what bend is usual."""
MOST_FILLED = 0.5
"""Of all samples: a larger share is how the effort was recorded."""


class Filled:
    """Follow every joint's torque, or current where no torque is logged.

    Parameters
    ----------
    clock
        Knows the gaps that are bridged; a line over less is as good.
    """

    def __init__(self, joints: int, clock: Clock) -> None:
        self._clock = clock
        self._lines = [_Lines() for _ in range(joints)]
        self._effort = EFFORTS[0]

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account: its first bend is that at the last sample of the one before."""
        self._effort, begin = stretch.effort, max(stretch.context - 2, 0)
        time = stretch.time[begin:]
        if len(time) < 3:
            return
        effort, position = stretch.channels[self._effort][:, begin:], stretch.position[:, begin:]
        for lines, values, moved in zip(self._lines, effort, position, strict=True):
            lines.update(values, moved, time, stretch.first + begin)

    def rows(self) -> Rows:
        """Give the rows that were filled in."""
        return joined([rows for rows, _ in self._found()])

    def defects(self, facts: Facts) -> list[Defect]:
        """State where rows were filled in, once for all joints."""
        found, stamps = self.rows(), {}
        for (begin, stop), (first, end) in self._found():
            stamps[begin], stamps[stop] = first, end
        if not found:
            return []
        count = sum(stop - begin for begin, stop in found)
        longest = sorted(found, key=lambda rows: rows[0] - rows[1])[:KEPT]
        statement = (
            f"{count} of {facts.samples} rows lie on straight lines of the {self._effort}, in "
            f"{count_text(len(found), 'run')}, though it carries noise: they were filled in and not "
            "measured. The log is cut there."
        )
        spans = tuple((stamps[begin], stamps[stop]) for begin, stop in sorted(longest))
        return [Defect("filled_rows", self._effort, None, count, spans, statement)]

    def _found(self) -> list[tuple[tuple[int, int], tuple[float, float]]]:
        """Give rows and stamps of every line that is longer than a gap that is bridged."""
        runs = np.concatenate([lines.exceptional() for lines in self._lines])
        long = runs[runs[:, 1, _TIME] - runs[:, 0, _BEFORE] > self._clock.bridge]
        return [
            ((int(begin), int(stop)), (float(first), float(end)))
            for (begin, stop), (first, end) in zip(long[:, :, _ROW], long[:, :, _TIME], strict=True)
        ]


_ROW, _TIME, _BEFORE, _WAY = _KNOWN = range(4)
"""Known at a line's first sample and at the one behind it: the row, its stamp and that of the row before, and
the joint's way."""


class _Lines:
    """Follow one effort."""

    def __init__(self) -> None:
        self._runs = LongRuns(len(_KNOWN), longer_than=FEWEST_FILLED)
        self._rows = self._straight = self._turns = 0
        self._way = 0.0

    def update(self, values: Samples, position: Samples, time: Samples, first: int) -> None:
        """Take the next samples, of which all but the first and last have a bend."""
        changes = np.diff(values)
        bends = _bends(values, time)
        some = bends[::_EVERY]
        usual = float(np.median(some[some > 0.0])) if some.any() else 0.0
        straight = (bends <= STRAIGHT * usual) & (changes[1:] != 0.0)
        rows = first + 1.0 + np.arange(len(straight))
        way = self._way + net_travel(position[1:])
        self._way = float(way[-1])
        self._runs.feed(straight, np.vstack([rows, time[1:-1], time[:-2], way[:-1]]))
        self._rows += len(straight)
        self._straight += int(np.count_nonzero(straight))
        self._turns += int(np.count_nonzero(changes[1:] * changes[:-1] < 0.0))

    def exceptional(self) -> np.ndarray:
        """Give the lines of an effort that follows none elsewhere, runs x ends x what is known."""
        self._runs.close()
        runs = self._runs.ended
        lasted, way = (runs[:, 1, value] - runs[:, 0, value] for value in (_ROW, _WAY))
        others = self._rows - float(lasted.sum())
        if others <= MOST_FILLED * self._rows or self._turns <= OFTEN * others:
            return runs[:0]
        clear = is_no_chance(lasted, (self._straight - float(lasted.sum())) / others, self._rows)
        moves = way * self._rows > MOVES * self._way * lasted
        return np.asarray(runs[moves & clear])


def _bends(values: Samples, time: Samples) -> Vector:
    """Give by how much a sample departs from the line between its neighbours, by stamps or by rows."""
    share = (time[1:-1] - time[:-2]) / (time[2:] - time[:-2])
    ends = values[:-2], values[2:]
    departures = [values[1:-1] - ((1.0 - part) * ends[0] + part * ends[1]) for part in (share, 0.5)]
    return np.asarray(np.minimum(*np.abs(departures)))
