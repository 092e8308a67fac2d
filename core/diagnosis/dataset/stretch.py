"""Hold one contiguous stretch of motion of a data set, with the filter that turns its series into rows."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Indices, KeptSeries, Series
from ...signals.parallel import ParallelFilter
from ...signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Stretch:
    """Carry one contiguous stretch of motion with the parallel filter at its thinned rate."""

    state: MotionState
    """The motion at the thinned rate, the filter's reach included."""
    parallel: ParallelFilter
    first: int
    rows: slice
    """Where the first decimated sample lies in `state`, and the rows of all of them in the data set."""

    @property
    def kept(self) -> int:
        """Count the decimated samples."""
        return int(self.rows.stop - self.rows.start)

    @property
    def instants(self) -> Indices:
        """Say where the decimated samples lie in `state`."""
        return self.first + self.parallel.decimation * np.arange(self.kept)

    def filtered(self, series: Series) -> KeptSeries:
        """Filter series of this stretch and keep its instants."""
        return self.parallel.apply(np.ascontiguousarray(series), self.first, self.kept)

    def filtered_part(self, series: Series, begin: int) -> tuple[int, KeptSeries]:
        """Filter series that begin at a sample of this stretch and are zero before and beyond.

        Give the first decimated sample that sees them, and what all those that do keep.
        """
        reach = self.parallel.reach
        low, high = self._kept_from(begin - reach), self._kept_from(begin + series.shape[1] + reach)
        return low, self._kept_of(series, begin, low, high)

    def begun(self, series: Series, filtered: KeptSeries, begin: int) -> KeptSeries:
        """Filter series as if they were zero before a sample, from what filtering all of them gave.

        Only instants that see samples of both kinds are filtered anew.
        """
        reach = self.parallel.reach
        low, high = self._kept_from(begin - reach), self._kept_from(begin + reach)
        out = filtered.copy()
        out[:, :low] = 0.0
        out[:, low:high] = self._kept_of(series[:, begin:], begin, low, high)
        return out

    def _kept_from(self, sample: int) -> int:
        """Give the first decimated sample that lies at a sample or behind it."""
        return min(max(-(-(sample - self.first) // self.parallel.decimation), 0), self.kept)

    def _kept_of(self, series: Series, begin: int, low: int, high: int) -> KeptSeries:
        """Filter series that begin at a sample, and keep some of this stretch's instants."""
        return self.parallel.apply(series, self.first + low * self.parallel.decimation - begin, high - low)
