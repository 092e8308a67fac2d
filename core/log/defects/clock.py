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
UNEVEN = 0.1
"""A step that differs from the median by more than this share is counted as uneven."""
EVEN_DEVIATION = 0.01
"""Steps whose standard deviation is below this share of the median are called even."""


class Clock:
    """Measure the steps of the stamps."""

    def __init__(self, samples: int) -> None:
        self._samples = samples
        self._share = sampled_share(samples)
        self._kept: list[Samples] = []
        self._long: list[tuple[int, float, float]] = []
        self._reference = 0.0
        self._counted = 0
        self._sum = 0.0
        self._squares = 0.0
        self._largest = 0.0
        self._uneven = Runs()

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        stamps = stretch.time[stretch.first_new :]
        steps = np.diff(stamps)
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

    def segments(self) -> tuple[tuple[int, int], ...]:
        """Give (start, stop) rows between the gaps."""
        borders = [0, *(row for row, before, after in self._gaps() if _splits(before, after)), self._samples]
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
            f"{_consequence(gaps)}."
        )
        intervals = tuple(sorted((t0, t1) for _, t0, t1 in longest))
        return [Defect("gap", "time", None, len(gaps), intervals, statement)]

    def _jitter_defect(self, step: float) -> list[Defect]:
        self._uneven.close()
        mean = self._sum / max(self._counted, 1)
        deviation = max(self._squares / max(self._counted, 1) - mean**2, 0.0) ** 0.5
        if deviation <= EVEN_DEVIATION * step:
            return []
        statement = (
            f"Steps vary by {deviation * 1e3:.3g} ms (standard deviation) about the median of "
            f"{step * 1e3:.4g} ms, the longest is {self._largest * 1e3:.4g} ms; "
            "the stamps are used as they are."
        )
        return [Defect("jitter", "time", None, self._uneven.rows, self._uneven.intervals, statement)]


def _splits(before: float, after: float) -> bool:
    return after - before > SHORT_GAP_S


def _consequence(gaps: list[tuple[int, float, float]]) -> str:
    split = sum(_splits(before, after) for _, before, after in gaps)
    if not split:
        return f"none is longer than {SHORT_GAP_S * 1e3:g} ms, so they are bridged"
    return f"the log is split at the {split} longer than {SHORT_GAP_S * 1e3:g} ms"
