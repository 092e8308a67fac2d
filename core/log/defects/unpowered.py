"""Find where the drives are off while brakes stop the arm: what the brakes do is in no log.

From one row to the next the efforts of all joints are none, and the arm, which moved, soon stands. Until it
does a model sees a load that is gone. An arm that stood already when its drives went off shows nothing wrong,
because samples at rest are not used.
"""

import numpy as np

from ...arrays import JointVector, Samples
from ..channels import EFFORTS
from ..model import Defect
from .repeats import Rows
from .rest import SHORTEST_SECONDS
from .runs import KEPT, LongRuns
from .spikes import median_of_five
from .stretch import CONTEXT_ROWS, USUAL_SHARE, Facts, Stretch, count_text

NO_EFFORT = 0.1
"""RMS over the joints of their efforts, each as a share of what 99 % of its samples stay below: less moves no
arm, and noise of a few per cent stays below."""
SOME_EFFORT = 2.0 * NO_EFFORT
FALL_SECONDS = 0.02
"""So much as that was there so shortly before, and more than 99 % of the changes in such a time. A motor's
current is gone in a few milliseconds, and what a controller takes back it takes back more slowly."""
HARDLY = 0.25
"""Of its mean speed in the log, at most, with which any joint gets on meanwhile: brakes hold it."""


class Unpowered:
    """Follow the efforts of all joints together, as shares of the largest that were seen so far."""

    def __init__(self, joints: int) -> None:
        self._largest: JointVector = np.zeros(joints)
        self._runs = LongRuns(_POSITION + joints)
        self._way: JointVector = np.zeros(joints)
        self._rows = 0
        self._effort = EFFORTS[0]
        self._levels: Samples | None = None
        self._change = 0.0

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        self._effort = stretch.effort
        effort = np.abs(stretch.channels[self._effort])
        self._largest = np.maximum(self._largest, np.quantile(effort, USUAL_SHARE, axis=1))
        share = effort / np.where(self._largest > 0.0, self._largest, np.inf)[:, None]
        level = _smoothed(np.sqrt(np.mean(share**2, axis=0)))[stretch.context :]
        time, position = stretch.time[stretch.context :], stretch.new()["position"]
        if self._levels is None:
            self._levels = np.zeros(max(round(FALL_SECONDS / float(np.median(np.diff(time)))), CONTEXT_ROWS))
        levels = np.append(self._levels, level)
        self._levels = levels[len(level) :]
        before = levels[: len(level)]
        self._change = max(self._change, float(np.quantile(np.abs(before - level), USUAL_SHARE)))
        rows = stretch.first + stretch.context + np.arange(len(level))
        known = np.vstack([rows, time, before, position])
        self._runs.feed(level < NO_EFFORT, known)
        steps = np.abs(np.diff(stretch.position[:, stretch.first_new :], axis=1))
        self._way, self._rows = self._way + steps.sum(axis=1), self._rows + steps.shape[1]

    def rows(self, facts: Facts) -> Rows:
        """Give the rows in which the drives were off, with those in which their efforts fell."""
        fall = 0 if self._levels is None else len(self._levels)
        runs = self._found(facts)[:, :, _ROW]
        return tuple((max(int(begin) - fall, 0), int(stop)) for begin, stop in runs)

    def defects(self, facts: Facts) -> list[Defect]:
        """State when the drives were off, once for all joints."""
        runs = self._found(facts)
        if not len(runs):
            return []
        lasted = runs[:, 1, _ROW] - runs[:, 0, _ROW]
        longest = runs[np.sort(np.argsort(-lasted, kind="stable")[:KEPT])][:, :, _TIME]
        statement = (
            f"In {count_text(len(runs), 'run')} of {int(lasted.sum())} rows in all no joint has any "
            f"{self._effort} while the arm comes to rest: its drives are off and brakes, which no channel "
            "shows, stop it. The log is cut there."
        )
        spans = tuple((float(begin), float(end)) for begin, end in longest)
        return [Defect("unpowered", self._effort, None, int(lasted.sum()), spans, statement)]

    def _found(self, facts: Facts) -> np.ndarray:
        """Give the runs without effort in which the arm comes to rest, runs x ends x what is known."""
        self._runs.close()
        runs = self._runs.ended
        rows, seconds = (runs[:, 1, value] - runs[:, 0, value] for value in (_ROW, _TIME))
        way = np.abs(runs[:, 1, _POSITION:] - runs[:, 0, _POSITION:])
        usual = self._way / max(self._rows, 1)
        moved = np.any(way > usual, axis=1)
        held = np.all(way <= HARDLY * usual * rows[:, None], axis=1)
        fell = runs[:, 0, _BEFORE] > max(SOME_EFFORT, NO_EFFORT + self._change)
        return np.asarray(runs[fell & moved & held & (seconds >= SHORTEST_SECONDS - facts.step)])


_ROW, _TIME, _BEFORE, _POSITION = range(4)
"""Known at a run's first row and at the one behind it: its number, its stamp, the level of effort shortly
before, and from there on the positions."""


def _smoothed(level: Samples) -> Samples:
    """Give medians of five, so that noise does not end a run."""
    inner = median_of_five(level[None])[0] if len(level) > CONTEXT_ROWS else level[:0]
    return np.asarray(np.concatenate([level[:2], inner, level[-2:]])) if len(inner) else level
