"""Give the rows of a log with the efforts of a little later: what a channel that lags shows only then."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline

from ..arrays import JointSeries, Samples
from .model import JointLog, LogRows, rows_at

NEIGHBOURS = 40
"""Rows on either side that a spline is laid through; further ones change nothing."""
FEWEST = 4
"""Rows of a stretch that can be shifted."""


def with_later_effort(log: JointLog, seconds: float) -> JointLog:
    """Give every row the torque or current of so many seconds later; constant beyond a stretch's end."""
    return log if seconds == 0.0 else replace(log, source=_ShiftedSource(log, seconds), sha256="")


@dataclass(frozen=True, eq=False)
class _ShiftedSource:
    log: JointLog
    seconds: float

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self.log.samples

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop, every stretch between gaps by itself."""
        reach = int(np.ceil(abs(self.seconds) * self.log.rate_hz)) + NEIGHBOURS
        low, high = max(0, start - reach), min(self.samples, stop + reach)
        read = self.log.source.rows(low, high)
        borders = {border - low for segment in self.log.segments for border in segment if low < border < high}
        cuts = sorted({0, high - low} | borders)
        parts = [rows_at(read, slice(*cut)) for cut in pairwise(cuts)]
        torque, current = (
            None if getattr(read, name) is None else np.vstack([self._later(part, name) for part in parts])
            for name in ("torque", "current")
        )
        return rows_at(replace(read, torque=torque, current=current), slice(start - low, stop - low))

    def _later(self, rows: LogRows, channel: str) -> JointSeries:
        values: JointSeries = getattr(rows, channel)
        fresh = _advances(rows.time)
        if np.count_nonzero(fresh) < FEWEST:
            return values
        time = rows.time[fresh]
        then = np.clip(rows.time + self.seconds, time[0], time[-1])
        return np.asarray(CubicSpline(time, values[fresh])(then))


def _advances(time: Samples) -> np.ndarray:
    """Mark the rows whose stamp is later than all before."""
    before = np.concatenate([[-np.inf], np.maximum.accumulate(time)[:-1]])
    return np.asarray(time > before)
