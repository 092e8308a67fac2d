"""Find where a joint rests, by how far it gets within a tenth of a second.

At rest friction is whatever holds the joint, not a function of its velocity, so these samples would mislead a
fit.
"""

import numpy as np

from ...arrays import Indices, SampleMask, Samples, Series
from ...numerics.marked_runs import marked_runs
from ..model import Defect
from .runs import KEPT
from .stretch import Facts, Stretch, count_text

BLOCK_SECONDS = 0.1
MOST_BLOCKS = 100_000
SHORTEST_SECONDS = 0.5
RANGE_SHARE = 2e-4
"""Within a block a joint that moves less than this share of its range rests."""
LSB_SHARE = 1.5
FROZEN_SPAN = 1e-5
"""A joint whose whole range is below this, in rad or m, never moves."""


class Rest:
    """Reduce the log to the range that each joint covers in each short block."""

    def __init__(self, samples: int) -> None:
        self._samples = samples
        self._block = 0
        self._spans: list[Series] = []
        self._starts: list[Samples] = []
        self._stops: list[Samples] = []
        self._rows: list[Indices] = []

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        time, position = stretch.time[stretch.first_new :], stretch.position[:, stretch.first_new :]
        if not self._block:
            step = float(np.median(np.diff(time)))
            self._block = max(round(BLOCK_SECONDS / step), -(-self._samples // MOST_BLOCKS), 2)
        steps = max(len(time) - 1, 1)
        starts = np.arange(0, steps, self._block)
        stops = np.minimum(starts + self._block, len(time) - 1)
        # A block shares its last sample with the next, so that motion between blocks is not lost.
        bounds = np.ravel(np.column_stack([starts, np.minimum(stops + 1, len(time) - 1)]))
        highest = np.maximum.reduceat(position, bounds, axis=1)[:, ::2]
        lowest = np.minimum.reduceat(position, bounds, axis=1)[:, ::2]
        self._spans.append(highest - lowest)
        self._rows.append(stops - starts)
        self._starts.append(time[starts])
        self._stops.append(time[stops])

    def defects(self, facts: Facts) -> list[Defect]:
        """State the rests of each joint."""
        spans = np.hstack(self._spans)
        starts, stops, rows = (np.concatenate(kept) for kept in (self._starts, self._stops, self._rows))
        found = []
        for joint, row in enumerate(spans):
            span = float(facts.span("position")[joint])
            limit = max(RANGE_SHARE * span, LSB_SHARE * float(facts.position_lsb[joint]), FROZEN_SPAN / 10.0)
            rests, count = _rests(row <= limit, starts, stops, rows)
            seconds = sum(stop - start for start, stop in rests)
            if span < FROZEN_SPAN or seconds > 0.99 * facts.duration:
                statement = (
                    f"Joint {joint + 1} never moves: this log cannot identify what depends on its own motion."
                )
                whole = ((facts.start, facts.start + facts.duration),)
                found.append(Defect("standstill", "position", joint + 1, facts.samples, whole, statement))
            elif rests:
                statement = (
                    f"Joint {joint + 1} rests for {seconds:.3g} s of {facts.duration:.3g} s, in "
                    f"{count_text(len(rests), 'pause')} of {SHORTEST_SECONDS:g} s or more."
                )
                longest = tuple(sorted(sorted(rests, key=lambda rest: rest[0] - rest[1])[:KEPT]))
                found.append(Defect("standstill", "position", joint + 1, count, longest, statement))
        return found


def _rests(
    still: SampleMask, starts: Samples, stops: Samples, rows: Indices
) -> tuple[list[tuple[float, float]], int]:
    """Join neighbouring blocks at rest, keep the long ones, and count their rows."""
    first, stop = marked_runs(still).T
    begin, end = starts[first], stops[stop - 1]
    long = end - begin >= SHORTEST_SECONDS
    before = np.concatenate([[0], np.cumsum(rows)])
    count = int(np.sum((before[stop] - before[first])[long]))
    return [(float(t0), float(t1)) for t0, t1 in zip(begin[long], end[long], strict=True)], count
