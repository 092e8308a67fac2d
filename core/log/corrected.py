"""Give a log whose rows are corrected as they are read, every stretch between gaps by itself.

So a log's length costs no memory here either.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from .model import JointLog, LogRows, joined_rows, rows_at

NEIGHBOURS = 40
"""Rows on either side that a spline is laid through; further ones change nothing."""
FEWEST = 4
"""Rows of a stretch that a spline is laid through."""


@dataclass(frozen=True, eq=False)
class CorrectedSource:
    """Give the rows of a log as they were corrected."""

    log: JointLog
    correct: Callable[[LogRows], LogRows]
    """Corrects rows without a gap between them."""
    reach: int
    """Rows on either side that it needs."""

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self.log.samples

    def rows(self, start: int, stop: int) -> LogRows:
        """Read and correct the rows from start up to, not including, stop."""
        low, high = max(0, start - self.reach - NEIGHBOURS), min(self.samples, stop + self.reach + NEIGHBOURS)
        read = self.log.source.rows(low, high)
        borders = {border - low for segment in self.log.segments for border in segment if low < border < high}
        cuts = sorted({0, high - low} | borders)
        parts = [self.correct(rows_at(read, slice(*cut))) for cut in pairwise(cuts)]
        return rows_at(joined_rows(parts), slice(start - low, stop - low))
