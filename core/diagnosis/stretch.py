"""Carry one contiguous stretch of motion of a look, with the filter that turns its series into rows."""

from dataclasses import dataclass

import numpy as np

from core.arrays import KeptSeries, Series
from core.signals.parallel import ParallelFilter
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Stretch:
    """Carry one contiguous stretch of motion with the parallel filter at its thinned rate.

    Attributes
    ----------
    state
        The motion at the thinned rate, the filter's reach included.
    first, rows
        Where the first kept instant lies in `state`, and which rows of the look the kept instants are.
    """

    state: MotionState
    parallel: ParallelFilter
    first: int
    rows: slice

    @property
    def kept(self) -> int:
        """Count the kept instants."""
        return int(self.rows.stop - self.rows.start)

    def filtered(self, series: Series) -> KeptSeries:
        """Filter series of this stretch and keep its instants."""
        return self.parallel.apply(np.ascontiguousarray(series), self.first, self.kept)

    def filtered_part(self, series: Series, begin: int) -> tuple[int, KeptSeries]:
        """Filter series that begin at a sample of this stretch and are zero before and beyond.

        Give the first kept instant that sees them, and what all those that do keep.
        """
        parallel, end = self.parallel, begin + series.shape[1]
        low = -(-(begin - parallel.reach - self.first) // parallel.decimation)
        high = (end - 1 + parallel.reach - self.first) // parallel.decimation + 1
        low, high = (min(max(one, 0), self.kept) for one in (low, high))
        first = self.first + low * parallel.decimation - begin
        return low, parallel.apply(series, first, high - low)

    def begun(self, series: Series, filtered: KeptSeries, begin: int) -> KeptSeries:
        """Filter series as if they were zero before a sample, from what filtering all of them gave.

        Only instants that see samples of both kinds are filtered anew.
        """
        parallel = self.parallel
        low, high = (
            min(max(-(-(begin + side * parallel.reach - self.first) // parallel.decimation), 0), self.kept)
            for side in (-1, 1)
        )
        out = filtered.copy()
        out[:, :low] = 0.0
        first = self.first + low * parallel.decimation - begin
        out[:, low:high] = parallel.apply(series[:, begin:], first, high - low)
        return out
