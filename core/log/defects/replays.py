"""Find blocks of rows whose efforts are those of earlier rows, one after the other: a buffer was sent again.

Noise never repeats a sequence. A log without noise, or made of one period again and again, may do so
throughout, and a coarse effort by chance: these are not judged. Nor are blocks where the motion itself came
back: the efforts of a controller that counts come back with it.
"""

import numpy as np

from ...arrays import Indices, Series
from ..channels import EFFORTS
from ..model import Defect
from .filled import FEWEST_FILLED, MOST_FILLED
from .repeats import Rows, joined
from .runs import KEPT, is_no_chance
from .stretch import STRETCH_ROWS, Facts, Stretch, count_text

CAME_BACK = 0.01
"""Distance of a joint from where it was, as a share of its way in between, up to which the motion came back.
Periods of a measured servo axis differ by 1e-6 of its way. Set by hand."""
FEWEST = FEWEST_FILLED
"""A shorter block, or one that repeats what stood so few rows before, may be a coarse effort's."""


class Replays:
    """Follow the efforts of all joints together, as numbers that stand for them."""

    def __init__(self) -> None:
        self._keys = np.zeros(0, dtype=np.uint64)
        self._positions = np.zeros((0, 0))
        self._blocks: list[tuple[int, int]] = []
        self._stamps: dict[int, float] = {}
        self._again = self._rows = 0
        self._effort = EFFORTS[0]

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account, as it was measured: a median repeats nothing."""
        self._effort = stretch.effort
        new = _keys(stretch.channels[self._effort][:, stretch.context :])
        keys = np.append(self._keys, new)
        fresh = stretch.channels["position"][:, stretch.context :]
        positions = np.hstack([self._positions.reshape(len(fresh), -1), fresh])
        lags = _lags(keys)[len(self._keys) :]
        edges = np.flatnonzero(np.diff(lags, prepend=-1, append=-1))
        first, time = stretch.first + stretch.context, stretch.time[stretch.context :]
        starts, stops = edges[:-1], edges[1:]
        long = (stops - starts > FEWEST) & (lags[starts] > FEWEST)
        for begin, stop in zip(starts[long].tolist(), stops[long].tolist(), strict=True):
            known = len(self._keys)
            if _came_back(positions, known + begin, known + stop, int(lags[begin])):
                continue
            self._blocks.append((first + begin, first + stop))
            self._stamps[first + begin], self._stamps[first + stop] = (
                float(time[begin]),
                float(time[stop - 1]),
            )
        self._again += int(np.count_nonzero(lags > FEWEST))
        self._rows += len(new)
        self._keys, self._positions = keys[-STRETCH_ROWS:], positions[:, -STRETCH_ROWS:]

    def rows(self) -> Rows:
        """Give the rows that were sent again."""
        blocks = np.reshape(self._blocks, (-1, 2)).astype(int)
        lasted = blocks[:, 1] - blocks[:, 0]
        others = self._rows - int(lasted.sum())
        if others <= MOST_FILLED * self._rows:
            return ()
        clear = is_no_chance(lasted, (self._again - int(lasted.sum())) / others, self._rows)
        return joined([(int(begin), int(stop)) for begin, stop in blocks[clear]])

    def defects(self, facts: Facts) -> list[Defect]:
        """State where rows were sent again, once for all joints."""
        found = self.rows()
        if not found:
            return []
        count = sum(stop - begin for begin, stop in found)
        longest = sorted(sorted(found, key=lambda rows: rows[0] - rows[1])[:KEPT])
        statement = (
            f"{count} of {facts.samples} rows repeat the {self._effort}s of earlier rows exactly, in "
            f"{count_text(len(found), 'block')}: they were sent again and not measured. The log is cut there."
        )
        spans = tuple((self._stamps[begin], self._stamps[stop]) for begin, stop in longest)
        return [Defect("replayed_rows", self._effort, None, count, spans, statement)]


def _came_back(positions: Series, begin: int, stop: int, lag: int) -> bool:
    """Tell whether the motion about a block is that about the earlier one: what is sent again is alone."""
    first, last = max(begin - FEWEST, lag), min(stop + FEWEST, positions.shape[1])
    own, earlier = positions[:, first:last], positions[:, first - lag : last - lag]
    way = np.ptp(positions[:, begin - lag : stop], axis=1)
    return last - first > stop - begin and bool(np.all(np.abs(own - earlier).max(axis=1) <= CAME_BACK * way))


def _keys(efforts: Series) -> np.ndarray:
    """Give a number for the efforts of every row: equal for equal ones, and hardly ever for others."""
    odd = np.random.default_rng(0).integers(1, 2**63, len(efforts), dtype=np.uint64) * np.uint64(2)
    bits = np.ascontiguousarray(efforts).view(np.uint64)
    return np.asarray(np.sum((bits ^ (bits >> np.uint64(29))) * (odd + np.uint64(1))[:, None], axis=0))


def _lags(keys: np.ndarray) -> Indices:
    """Give how many rows before each one the last equal row is; 0 where there is none."""
    lags, ranked = np.zeros(len(keys), dtype=int), np.sort(keys)
    if not np.any(ranked[1:] == ranked[:-1]):
        return lags  # to sort the numbers alone takes a fifth of the time
    order = np.argsort(keys, kind="stable")
    same = keys[order[1:]] == keys[order[:-1]]
    lags[order[1:][same]] = (order[1:] - order[:-1])[same]
    return lags
