"""Find a channel that keeps one value exactly while its joint moves, as one does whose sensor or link hangs.

A position that moved, stood still for a moment and is much farther on afterwards did not stand still; nor did
one that goes on with a step larger than any other. A torque that carries noise does not repeat a value many
times while the joint moves, unless it is clipped. A channel that does so again and again is coarse or held by
its maker: that is usual and no fault, but for a run far longer than all others.
"""

from collections import Counter

import numpy as np

from ...arrays import Samples
from ..channels import EFFORTS
from ..model import STANDING_ROWS, Defect
from .repeats import JUMP, Repeats, Rows
from .runs import KEPT, LongRuns, is_no_chance
from .stretch import Facts, Stretch, count_text

RARELY, OFTEN = 0.1, 0.05
"""A torque that carries noise repeats the value before in a smaller share of the samples than this, and turns
round in a larger one than that: simulated torque without noise may stay the same in a steady motion."""
GROUP = 10.0
"""Where it repeats values more often, it may do so in groups of so many: a run that is no chance is as many
times longer than one of independent repeats."""
OUTSTANDING = 2.5
"""A run that is so many times as long as the next one, or as the longest that is usual, stands out."""
LEVELS = 10
"""A coarse channel repeats more values than these; a clipped one two."""
MOVES = 0.05
"""A joint that covers this share of its usual way moves."""
MOVES_ON = 0.5
"""And one that covers this share moves as usual: slowly, it keeps a coarse torque for long."""
LONGEST_S = 1.0
"""A position that stays longer is a joint that rests."""
MOST_RUNS = 10
"""More runs than these are usual for the channel."""
MOST_VALUES = 10_000
"""More values than these that were ever repeated are not kept; such a channel is not judged."""
GAP_STEPS = 3.0
"""Over so many steps of time a joint may get anywhere."""


class Stuck:
    """Follow every joint's position and torque (or current, where no torque is logged).

    Parameters
    ----------
    repeats
        Knows the rows in which all channels stood still at once; they are reported there.
    """

    def __init__(self, joints: int, repeats: Repeats) -> None:
        self._repeats = repeats
        self._positions = [_Signal() for _ in range(joints)]
        self._efforts = [_Signal() for _ in range(joints)]
        self._effort = EFFORTS[0]

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        time, position = stretch.time[stretch.first_new :], stretch.position[:, stretch.first_new :]
        self._effort, row = stretch.effort, stretch.first + stretch.first_new
        for signal, own in zip(self._positions, position, strict=True):
            signal.update(own, own, time, row)
        effort = stretch.channels[self._effort][:, stretch.first_new :]
        for signal, own, moved in zip(self._efforts, effort, position, strict=True):
            signal.update(own, moved, time, row)

    def rows(self, facts: Facts) -> Rows:
        """Give the rows in which some channel was stuck; some may overlap."""
        found = (ends for _, _, runs in self._stuck(facts) for ends in runs[:, :, _ROW])
        return tuple((int(begin), int(stop)) for begin, stop in found)

    def defects(self, facts: Facts) -> list[Defect]:
        """State which channels were stuck, and when."""
        return [_defect(channel, joint, runs) for channel, joint, runs in self._stuck(facts)]

    def _stuck(self, facts: Facts) -> list[tuple[str, int, np.ndarray]]:
        """Give channel, joint (from 1) and runs, a pair of what was known at both ends each."""
        moved = [joint for joint in range(len(self._positions)) if facts.travels(joint)]
        pairs = [
            *(("position", joint + 1, self._positions[joint].runs_before_jumps()) for joint in moved),
            *((self._effort, joint + 1, self._efforts[joint].runs_while_moving()) for joint in moved),
        ]
        own = [(channel, joint, runs[~self._reported(runs)]) for channel, joint, runs in pairs]
        return [(channel, joint, runs) for channel, joint, runs in own if len(runs)]

    def _reported(self, runs: np.ndarray) -> np.ndarray:
        reported = np.zeros(len(runs), dtype=bool)
        for begin, stop in self._repeats.frozen:
            reported |= (runs[:, 0, _ROW] >= begin - 1) & (runs[:, 1, _ROW] <= stop + 1)
        return reported


_ROW, _TIME, _WAY, _VALUE, _STEP, _NEXT, _BEFORE, _ELAPSED = _KNOWN = range(8)
"""Known at a run's first and last sample: the row after it, its stamp, the joint's way and the value; by how
much the value changes to the next sample and to the one after that, and did from the one before; and the time
to the next."""


class _Signal:
    """Follow one channel of one joint, and the way of the joint."""

    def __init__(self) -> None:
        self._runs = LongRuns(len(_KNOWN))
        self._again: Counter[float] = Counter()
        self._rows = self._repeats = self._turns = 0
        self._way = self._change = self._before = self._largest = 0.0
        self._low, self._high = np.inf, -np.inf

    def update(self, values: Samples, position: Samples, time: Samples, first: int) -> None:
        """Take the next samples; the first of them was the last of those before, if there were any."""
        changes = np.diff(values)
        steps, same = np.abs(changes), changes == 0.0
        after = np.append(np.abs(values[2:] - values[:-2]), steps[-1:])
        before = np.append(self._before, steps[:-1])
        rows = first + 1.0 + np.arange(len(steps))
        way = self._way + net_travel(position)
        known = (rows, time[:-1], way[:-1], values[:-1], steps, after, before, np.diff(time))
        self._runs.feed(same, np.vstack(known))
        self._rows += len(steps)
        self._repeats += int(np.count_nonzero(same))
        if len(self._again) < MOST_VALUES:
            again, counts = np.unique(values[1:][same], return_counts=True)
            self._again.update(dict(zip(again.tolist(), counts.tolist(), strict=True)))
        self._turns += int(np.count_nonzero(changes[1:] * changes[:-1] < 0.0))
        self._change += float(steps.sum())
        self._way = float(way[-1])
        self._largest = max(self._largest, float(np.max(steps[before > 0.0], initial=0.0)))
        self._before = float(steps[-1])
        self._low, self._high = min(self._low, values.min()), max(self._high, values.max())

    def runs_before_jumps(self) -> np.ndarray:
        """Give the runs before a position that is much farther on than it usually gets: see above."""
        runs = self._exceptional()
        begin, end = runs[:, 0], runs[:, 1]
        lasted = end[:, _ROW] - begin[:, _ROW]
        seconds = end[:, _TIME] - begin[:, _TIME]
        together = end[:, _ELAPSED] * lasted < GAP_STEPS * seconds
        moved = begin[:, _BEFORE] > MOVES * self._jump
        away = np.minimum(end[:, _STEP], end[:, _NEXT])
        moved |= away > self._largest
        return np.asarray(runs[together & moved & (away > self._jump) & (seconds < LONGEST_S)])

    def runs_while_moving(self) -> np.ndarray:
        """Give the runs of a noisy channel during which the joint moves, one to the log's end among them."""
        self._runs.close()
        return np.unique(np.concatenate([self._noisy_runs(), self._outstanding()]), axis=0)

    def _outstanding(self) -> np.ndarray:
        """Give the runs that stand out of a coarse channel's, during which the joint moves as it does."""
        runs = self._runs.ended
        lasted, way = (runs[:, 1, value] - runs[:, 0, value] for value in (_ROW, _WAY))
        longest = np.sort(lasted)[::-1]
        far = (longest > OUTSTANDING * np.append(longest[1:], STANDING_ROWS))[:MOST_RUNS]
        least = longest[np.flatnonzero(far)[-1]] if far.any() else np.inf
        moving = way * self._rows > MOVES_ON * self._way * lasted
        is_coarse = len(self._again) > LEVELS and self._turns > OFTEN * self._rows
        return self._from_jump(runs[(lasted >= least) & moving & is_coarse & ~self._clipped(runs)])

    def _noisy_runs(self) -> np.ndarray:
        """Give the runs of a value that a noisy channel keeps nowhere else."""
        runs = self._exceptional()
        lasted, way = (runs[:, 1, value] - runs[:, 0, value] for value in (_ROW, _WAY))
        others = self._rows - float(lasted.sum())
        share = (self._repeats - float(lasted.sum())) / max(others, 1.0)
        rare = (share < RARELY) | is_no_chance(lasted / GROUP, share, self._rows)
        noisy = rare & (self._turns > OFTEN * others)
        moving = way * self._rows > MOVES * self._way * lasted
        return np.asarray(runs[noisy & moving & ~self._clipped(runs)])

    def _clipped(self, runs: np.ndarray) -> np.ndarray:
        """Mark the runs at an end of the channel's range that was not jumped to."""
        value = runs[:, 1, _VALUE]
        reached = runs[:, 0, _BEFORE] <= self._jump
        return np.asarray(((value == self._low) | (value == self._high)) & reached)

    @property
    def _jump(self) -> float:
        """Give what a change of the value has to be to be none that is usual."""
        return JUMP * self._change / max(self._rows - self._repeats, 1)

    def _exceptional(self) -> np.ndarray:
        """Give the long runs of a value that is kept nowhere else, where they are few."""
        runs = self._runs.ended
        lasted = runs[:, 1, _ROW] - runs[:, 0, _ROW]
        kept = np.array([self._again[value] for value in runs[:, 0, _VALUE]], dtype=float)
        usual = len(runs) > MOST_RUNS or len(self._again) >= MOST_VALUES
        return self._from_jump(runs[:0] if usual else runs[kept <= lasted])

    def _from_jump(self, runs: np.ndarray) -> np.ndarray:
        """Begin runs whose value was jumped to at their first sample: it is wrong as well, else measured."""
        runs[:, 0, _ROW] -= runs[:, 0, _BEFORE] > self._jump
        return runs


def net_travel(position: Samples) -> Samples:
    """Give how far a joint has got at every sample, from one to one many later: noise averages out."""
    marks = np.arange(len(position)) // STANDING_ROWS
    marked = position[::STANDING_ROWS]
    along = np.append(0.0, np.cumsum(np.abs(np.diff(marked))))
    return np.asarray(along[marks] + np.abs(position - marked[marks]))


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
        f"Joint {joint}'s {channel} keeps one value exactly in {count_text(len(runs), 'run')} of "
        f"{rows} rows in all while the joint moves on: the log is cut there.",
    )
