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
