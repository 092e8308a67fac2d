"""Take the even clock of which a recorder rounded the stamps so far that rows share one.

A stamp written with two decimals is that of two or three rows of a log at 250 Hz. No derivative can be taken
between them. Where all stamps lie within their resolution of evenly spaced instants, these are the clock.
Where rows are missing or the clock is not even they do not, and the log is refused.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Samples
from ..model import Defect, LogRows, LogSource

BLOCK_ROWS = 32_768
WITHIN = 0.75
"""Of the resolution, by which a stamp may be off the even clock: half of it by rounding, and half of that
again for the line that is laid through all."""
EXACT = 0.01
"""Of the resolution, by which steps of rounded stamps may be off its multiples, as decimals are in binary."""


@dataclass(frozen=True, eq=False)
class EvenClock:
    """Give the samples of a source at evenly spaced instants."""

    source: LogSource
    start: float
    step: float
    """First instant and the time between two, s."""

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self.source.samples

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop."""
        start, stop, _ = slice(start, stop).indices(self.samples)
        return replace(self.source.rows(start, stop), time=self.start + self.step * np.arange(start, stop))


def with_even_clock(source: LogSource) -> tuple[LogSource, list[Defect]]:
    """Give the source with the even clock where rows share stamps that were rounded, and say so.

    Examples
    --------
    >>> from veritorque.core.log.model import ArraySource
    >>> stamps = np.round(np.arange(200) / 250.0, 2)
    >>> even, (rounded,) = with_even_clock(ArraySource(LogRows(stamps, np.zeros((200, 1)))))
    >>> round(even.step, 5), rounded.count
    (0.004, 119)
    """
    blocks = [source.rows(first, first + BLOCK_ROWS).time for first in range(0, source.samples, BLOCK_ROWS)]
    stamps = np.concatenate([np.zeros(0), *blocks])
    steps = np.diff(stamps)
    shared = int(np.count_nonzero(steps == 0.0))
    clock = _line(stamps) if shared and steps.min() == 0.0 < steps.max() else None
    if clock is None:
        return source, []
    start, step, resolution = clock
    statement = (
        f"{shared} rows have the stamp of the row before: stamps are rounded to {resolution:.3g} s. All are "
        f"within that of an even clock of {1.0 / step:.6g} Hz, which is used in their place."
    )
    defect = Defect("rounded_stamps", "time", None, shared, (), statement)
    return EvenClock(source, start, step), [defect]


def _line(stamps: Samples) -> tuple[float, float, float] | None:
    """Lay a line through rounded stamps: its start, its step and the resolution, s; None if one is off it.

    A stamp of a clock that resolves the rows occurs twice for another reason.
    """
    steps = np.diff(stamps)
    resolution = float(steps[steps > 0.0].min())
    numbers = np.arange(len(stamps))
    step, start = np.polyfit(numbers, stamps - stamps[0], 1)
    off = np.abs(stamps - stamps[0] - (start + step * numbers)).max()
    odd = np.abs(steps - resolution * np.round(steps / resolution)).max()
    is_coarse = step < (1.0 - EXACT) * resolution
    is_even = is_coarse and off <= WITHIN * resolution and odd <= EXACT * resolution
    return (float(stamps[0] + start), float(step), resolution) if is_even else None
