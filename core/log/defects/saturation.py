"""Find torques that stop at a limit: many samples at exactly the largest value, few at the next.

A smooth peak, even a coarsely quantised one, spends about as long on its second highest level as on its
highest; a limited signal spends all the time at the limit that it would have spent above. Where steps are
coarse, other peaks end at the second level, too. But no peak comes to a plateau faster than it stays there:
what is beside a limit's plateaus takes little of the time.
"""

import numpy as np

from ...arrays import SampleMask, Samples
from ..model import Defect
from .runs import Runs
from .stretch import Facts, Stretch

SHORTEST_PLATEAU = 5
FEWEST_ROWS = 10
CROWDING = 5.0
"""The limit must hold this many times more samples than the next level, or its plateaus than what is beside
them. A peak of fourth order holds 5.3 times more at most, a parabola 2.4."""
PARABOLA = 1.0 + 2.0**0.5
"""What a parabola that fills its highest level has there, over the next level: less is any signal's peak."""
NEAR_LARGEST = 0.9
"""A limit is as far from zero as the torque ever gets, apart from a small asymmetry; zero itself is none."""


class Beside:
    """Count the samples of the runs of one value before and after every plateau on the highest level."""

    def __init__(self) -> None:
        self.top, self.rows = -np.inf, 0
        self._levels, self._lengths = np.zeros(0), np.zeros(0, dtype=int)

    def feed(self, values: Samples) -> None:
        """Take the next values; they follow on those fed before."""
        starts = np.flatnonzero(np.r_[True, values[1:] != values[:-1]])
        levels, lengths = values[starts], np.diff(np.r_[starts, len(values)])
        if len(self._levels) and levels[0] == self._levels[-1]:
            lengths[0] += self._lengths[-1]
            self._levels, self._lengths = self._levels[:-1], self._lengths[:-1]
        self._levels, self._lengths = np.r_[self._levels, levels], np.r_[self._lengths, lengths]
        self._count()
        # The last run is open, and the one before it lacks what follows.
        self._levels, self._lengths = self._levels[-3:], self._lengths[-3:]

    def close(self) -> None:
        """End the run that is still open: nothing follows."""
        self._levels, self._lengths = np.r_[self._levels, -np.inf, -np.inf], np.r_[self._lengths, 0, 0]
        self._count()
        self._levels, self._lengths = self._levels[:0], self._lengths[:0]

    def _count(self) -> None:
        """Count beside all plateaus but those at the ends: the next run may be open yet."""
        top = float(self._levels.max())
        if top > self.top:
            self.top, self.rows = top, 0
        plateau = (self._levels == self.top) & (self._lengths >= SHORTEST_PLATEAU)
        inner = np.flatnonzero(plateau[1:-2]) + 1
        self.rows += int((self._lengths[inner - 1] + self._lengths[inner + 1]).sum())


class Limit:
    """Follow the two highest levels of one signal and the plateaus on the highest."""

    def __init__(self) -> None:
        self.top = self.second = -np.inf
        self.top_rows = self.second_rows = self.moving_rows = 0
        self.runs, self.beside = Runs(SHORTEST_PLATEAU), Beside()

    def update(self, values: Samples, moves: SampleMask, time: Samples) -> None:
        """Take the next values into account, and where the joint moves."""
        self.beside.feed(values)
        highest = float(values.max())
        if highest < self.second:
            self.runs.close()
            return
        if highest > self.top:
            self.second, self.second_rows = self.top, self.top_rows
            self.top, self.top_rows, self.moving_rows = highest, 0, 0
            self.runs = Runs(SHORTEST_PLATEAU)
        at_top = values == self.top
        self.top_rows += int(np.count_nonzero(at_top))
        self.moving_rows += int(np.count_nonzero(at_top & moves))
        self.runs.feed(at_top, time)
        self._second(values[~at_top])

    def _second(self, values: Samples) -> None:
        level = float(values.max(initial=-np.inf))
        if level > self.second:
            self.second, self.second_rows = level, 0
        if level == self.second and len(values):
            self.second_rows += int(np.count_nonzero(values == level))

    def holds(self) -> bool:
        """Tell whether the highest level is a limit."""
        self.runs.close()
        self.beside.close()
        varied = self.second > -np.inf
        crowding = self.top_rows / max(self.second_rows, 1)
        stays = crowding > PARABOLA and self.runs.rows > CROWDING * self.beside.rows
        crowded = varied and (crowding > CROWDING or stays)
        return crowded and self.runs.rows >= FEWEST_ROWS and self.moving_rows > 0.1 * self.top_rows


class Saturation:
    """Find limits at both ends of every joint's torque."""

    def __init__(self, joints: int) -> None:
        self._limits = [(Limit(), Limit()) for _ in range(joints)]

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        if stretch.torque is None:
            return
        new = slice(stretch.context, None)
        for (above, below), torque, position in zip(
            self._limits, stretch.torque, stretch.position, strict=True
        ):
            moves = np.ones(len(position), dtype=bool)
            moves[1:] = position[1:] != position[:-1]
            above.update(torque[new], moves[new], stretch.time[new])
            below.update(-torque[new], moves[new], stretch.time[new])

    def defects(self, facts: Facts) -> list[Defect]:
        """State the limits that hold."""
        found = []
        for joint, pair in enumerate(self._limits):
            far = NEAR_LARGEST * max(limit.top for limit in pair)
            for sign, limit in zip((1.0, -1.0), pair, strict=True):
                if limit.top < far or not limit.holds():
                    continue
                runs = limit.runs
                statement = (
                    f"Joint {joint + 1}'s torque stays at exactly {sign * limit.top:.4g} "
                    f"{facts.units['torque'][joint]} for {runs.rows} of {facts.samples} samples, as a "
                    "limited or clipped signal does."
                )
                found.append(
                    Defect(
                        "saturation",
                        "torque",
                        joint + 1,
                        runs.rows,
                        runs.intervals,
                        statement,
                        level=sign * limit.top,
                    )
                )
        return found
