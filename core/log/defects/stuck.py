"""Find a channel that keeps one value exactly while its joint moves, as one does whose sensor or link hangs.

A position that stood still and is much farther on afterwards did not stand still. A torque that carries noise
does not repeat a value many times while the joint moves, unless it is clipped.
"""

import numpy as np

from core.arrays import Samples
from core.log.defects.repeats import JUMP, Repeats, Rows
from core.log.defects.runs import KEPT, LongRuns
from core.log.defects.stretch import Facts, Stretch, counted
from core.log.model import Defect

RARELY, OFTEN = 0.1, 0.05
"""A torque that carries noise repeats the value before in a smaller share of the samples than this, and turns
round in a larger one than that: simulated torque without noise may stay the same in a steady motion."""
MOVES = 0.05
"""A joint that covers this share of its usual way moves."""


class Stuck:
    """Follow every joint's position and torque (or current, where no torque is logged).

    Parameters
    ----------
    repeats
        Knows the rows in which all channels stood still at once; they are told there.
    """

    def __init__(self, joints: int, repeats: Repeats) -> None:
        self._repeats = repeats
        self._positions = [_Signal() for _ in range(joints)]
        self._efforts = [_Signal() for _ in range(joints)]
        self._effort = "torque"

    def see(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        time, position = stretch.time[stretch.seam :], stretch.position[:, stretch.seam :]
        effort, row = stretch.torque, stretch.first + stretch.seam
        if effort is None and "current" in stretch.others:
            self._effort, effort = "current", stretch.others["current"]
        for signal, own in zip(self._positions, position, strict=True):
            signal.see(own, own, time, row)
        if effort is not None:
            for signal, own, moved in zip(self._efforts, effort[:, stretch.seam :], position, strict=True):
                signal.see(own, moved, time, row)

    @property
    def rows(self) -> Rows:
        """Give the rows in which some channel was stuck; some may overlap."""
        return tuple(
            (int(begin), int(stop)) for _, _, one in self._stuck() for begin, stop in one[:, :, _ROW]
        )

    def defects(self, facts: Facts) -> list[Defect]:
        """State which channels were stuck, and when."""
        del facts
        return [_defect(channel, joint, runs) for channel, joint, runs in self._stuck()]

    def _stuck(self) -> list[tuple[str, int, np.ndarray]]:
        """Give channel, joint (from 1) and runs, a pair of what was known at both ends each."""
        pairs = [
            *(("position", joint, one.jumped()) for joint, one in enumerate(self._positions, 1)),
            *((self._effort, joint, one.hung()) for joint, one in enumerate(self._efforts, 1)),
        ]
        own = [(channel, joint, runs[~self._told(runs)]) for channel, joint, runs in pairs]
        return [one for one in own if len(one[2])]

    def _told(self, runs: np.ndarray) -> np.ndarray:
        told = np.zeros(len(runs), dtype=bool)
        for begin, stop in self._repeats.frozen:
            told |= (runs[:, 0, _ROW] >= begin - 1) & (runs[:, 1, _ROW] <= stop + 1)
        return told


_ROW, _TIME, _WAY, _VALUE, _STEP = _KNOWN = range(5)


class _Signal:
    """Follow one channel of one joint, and the way of the joint."""

    def __init__(self) -> None:
        self._runs = LongRuns(len(_KNOWN))
        self._rows = self._repeats = self._turns = 0
        self._way = self._change = 0.0
        self._low, self._high = np.inf, -np.inf

    def see(self, values: Samples, position: Samples, time: Samples, first: int) -> None:
        """Take the next samples; the first of them was the last of those before, if there were any."""
        changes = np.diff(values)
        steps, same = np.abs(changes), changes == 0.0
        way = self._way + np.concatenate([[0.0], np.cumsum(np.abs(np.diff(position)))])
        rows = first + 1.0 + np.arange(len(steps))
        self._runs.feed(same, np.vstack([rows, time[:-1], way[:-1], values[:-1], steps]))
        self._rows += len(steps)
        self._repeats += int(np.count_nonzero(same))
        self._turns += int(np.count_nonzero(changes[1:] * changes[:-1] < 0.0))
        self._change += float(steps.sum())
        self._way = float(way[-1])
        self._low, self._high = min(self._low, values.min()), max(self._high, values.max())

    def jumped(self) -> np.ndarray:
        """Give the runs after which a position is much farther on than it usually is when it changes."""
        runs = self._runs.ended
        usual = self._change / max(self._rows - self._repeats, 1)
        return np.asarray(runs[runs[:, 1, _STEP] > JUMP * usual])

    def hung(self) -> np.ndarray:
        """Give the runs of a noisy channel in which the joint moved on, one to the log's end among them."""
        self._runs.close()
        runs = self._runs.ended
        lasted, travelled = (runs[:, 1, one] - runs[:, 0, one] for one in (_ROW, _WAY))
        noisy = self._repeats - lasted.sum() < RARELY * self._rows and self._turns > OFTEN * self._rows
        value = runs[:, 1, _VALUE]
        clipped = (value == self._low) | (value == self._high)
        return np.asarray(runs[noisy & ~clipped & (travelled * self._rows > MOVES * self._way * lasted)])


def _defect(channel: str, joint: int, runs: np.ndarray) -> Defect:
    lasted = runs[:, 1, _ROW] - runs[:, 0, _ROW]
    longest = np.sort(np.argsort(-lasted, kind="stable")[:KEPT])
    rows = int(lasted.sum())
    return Defect(
        "stuck_channel",
        channel,
        joint,
        rows,
        tuple((float(begin), float(end)) for begin, end in runs[longest][:, :, _TIME]),
        f"Joint {joint}'s {channel} keeps one value exactly in {counted(len(runs), 'run')} of "
        f"{rows} rows in all while the joint moves on: the log is cut there.",
    )
