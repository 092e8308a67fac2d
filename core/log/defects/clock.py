"""Examine the stamps: how fast the log was sampled, where samples are missing, and how even the steps are.

Real stamps are used as they are; nothing is put on a uniform grid. A gap in which the motion is lost splits
the log, because no derivative holds across it; over a few milliseconds a spline is as good as a sample.
"""

from itertools import pairwise

import numpy as np

from ...arrays import Samples
from ..model import Defect
from .runs import KEPT, Runs
from .stretch import Facts, Stretch, count_text, sampled_share

GAP_STEPS = 3.0
"""A step of more than this many median steps is a gap."""
SHORT_GAP_S = 0.025
"""A gap up to this length (s) is bridged: arms do not move faster than a few hertz."""
BRIDGED_STEPS = 5.0
BRIDGED_PERIODS = 0.1
"""On a slow bus a gap of so many mean steps is bridged as well, up to this share of the motion's period: a
motion sampled ten times in a period is known between its samples."""
UNEVEN = 0.1
"""A step that differs from the median by more than this share is counted as uneven."""
RATE_SECONDS = 1.0
UNLIKE = 1.2
"""Stretches of so many seconds whose rates differ by more than this factor are said to be unlike."""
EVEN_DEVIATION = 0.01
"""Steps whose standard deviation is below this share of the median are called even."""


def longest_bridge(step: float, motion_hz: float) -> float:
    """Give the longest gap (s) over which a spline is as good as samples.

    Parameters
    ----------
    step
        Mean step of the stamps, s: where rows were lost, what is left is sampled more slowly.
    motion_hz
        Frequency up to which the motion reaches; 0 where it is not known.

    Examples
    --------
    >>> longest_bridge(0.004, 2.0), round(longest_bridge(0.03, 0.5), 6), longest_bridge(0.03, 0.0)
    (0.025, 0.15, 0.025)
    """
    slow = min(BRIDGED_STEPS * step, BRIDGED_PERIODS / motion_hz) if motion_hz > 0.0 else 0.0
    return max(SHORT_GAP_S, slow)


class Clock:
    """Measure the steps of the stamps."""

    def __init__(self, samples: int) -> None:
        self._samples = samples
        self.bridge = SHORT_GAP_S
        """The longest gap that is bridged, s; set once the motion is known."""
        self._share = sampled_share(samples)
        self._kept: list[Samples] = []
        self._long: list[tuple[int, float, float]] = []
        self._reference = 0.0
        self._counted = 0
        self._sum = 0.0
        self._squares = 0.0
        self._largest = 0.0
        self._uneven = Runs()
        self._start = self._stop = np.nan

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        stamps = stretch.time[stretch.first_new :]
        steps = np.diff(stamps)
        self._start = float(stamps[0]) if np.isnan(self._start) else self._start
        self._stop = float(stamps[-1])
        share = max(1, int(self._share * len(steps)))
        self._kept.append(steps[:share].copy())  # a view would keep every step of the log
        median = float(np.median(steps))
        self._reference = self._reference or median
        for index in np.flatnonzero(steps > 2.0 * median):
            row = stretch.first + stretch.first_new + int(index) + 1
            self._long.append((row, float(stamps[index]), float(stamps[index + 1])))
        ordinary = steps <= GAP_STEPS * median
        departure = np.abs(steps - self._reference)
        self._uneven.feed(ordinary & (departure > UNEVEN * self._reference), stamps[1:])
        kept = (steps - self._reference)[ordinary]
        self._counted += len(kept)
        self._sum += float(kept.sum())
        self._squares += float(kept @ kept)
        self._largest = max(self._largest, float(steps[ordinary].max(initial=0.0)))

    @property
    def step(self) -> float:
        """Median step in s."""
        return float(np.median(np.concatenate(self._kept)))

    @property
    def mean_step(self) -> float:
        """Mean step in s, in which a pause counts no more than the longest step that may be bridged."""
        steps = np.concatenate(self._kept)
        return float(np.mean(np.minimum(steps, BRIDGED_STEPS * np.median(steps))))

    def segments(self) -> tuple[tuple[int, int], ...]:
        """Give (start, stop) rows between the gaps."""
        borders = [
            0,
            *(row for row, before, after in self._gaps() if self._splits(before, after)),
            self._samples,
        ]
        return tuple(pairwise(borders))

    def _gaps(self) -> list[tuple[int, float, float]]:
        step = self.step
        return [
            (row, before, after) for row, before, after in self._long if after - before > GAP_STEPS * step
        ]

    def defects(self, facts: Facts) -> list[Defect]:
        """State gaps and jitter."""
        return [*self._gap_defect(facts.step), *self._jitter_defect(facts.step)]

    def _gap_defect(self, step: float) -> list[Defect]:
        gaps = self._gaps()
        if not gaps:
            return []
        lengths = [after - before for _, before, after in gaps]
        longest = sorted(gaps, key=lambda gap: gap[1] - gap[2])[:KEPT]
        statement = (
            f"{count_text(len(gaps), 'gap')}: steps of more than {GAP_STEPS:g} times the median of "
            f"{step * 1e3:.4g} ms, the longest {max(lengths):.4g} s, together {sum(lengths):.4g} s; "
            f"{self._consequence(gaps)}{self._rates(gaps)}."
        )
        intervals = tuple(sorted((t0, t1) for _, t0, t1 in longest))
        return [Defect("gap", "time", None, len(gaps), intervals, statement)]

    def _rates(self, gaps: list[tuple[int, float, float]]) -> str:
        """Say between which rates the stretches lie; empty where they are alike."""
        borders = [(0, self._start, self._start), *(gap for gap in gaps if self._splits(*gap[1:]))]
        ends = [*borders[1:], (self._samples, self._stop, self._stop)]
        found = [
            (stop - first - 1) / (before - after)
            for (first, _, after), (stop, before, _) in zip(borders, ends, strict=True)
            if before - after >= RATE_SECONDS
        ]
        if len(found) < 2 or max(found) < UNLIKE * min(found):
            return ""
        return f"; the stretches between them are sampled at {min(found):.3g} to {max(found):.3g} Hz"

    def _jitter_defect(self, step: float) -> list[Defect]:
        self._uneven.close()
        mean = self._sum / max(self._counted, 1)
        deviation = max(self._squares / max(self._counted, 1) - mean**2, 0.0) ** 0.5
        if deviation <= EVEN_DEVIATION * step:
            return []
        statement = (
            f"Steps vary by {deviation * 1e3:.3g} ms (standard deviation) about the median of "
            f"{step * 1e3:.4g} ms, the longest is {self._largest * 1e3:.4g} ms; "
            "they are used unless the positions show that the samples were taken evenly."
        )
        return [Defect("jitter", "time", None, self._uneven.rows, self._uneven.intervals, statement)]

    def _splits(self, before: float, after: float) -> bool:
        return after - before > self.bridge

    def _consequence(self, gaps: list[tuple[int, float, float]]) -> str:
        split = sum(self._splits(before, after) for _, before, after in gaps)
        if not split:
            return f"none is longer than {self.bridge * 1e3:.3g} ms, so they are bridged"
        return f"the log is split at the {split} longer than {self.bridge * 1e3:.3g} ms"
