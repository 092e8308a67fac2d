"""Filter and thin many series at once: the parallel filter as one matrix product per tile.

Filtering both sides of a linear equation with the same linear filter leaves the equation true; so no delay,
no edge effect and no choice of cut-off can bias it. Only the decimated samples are computed. A tile is a
stretch of motion together with its filter. Source: Gautier 1997; Khalil & Dombre (2002), ch. 12.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import InstantMask, Instants, JointSeries, KeptSeries, Matrix, Samples, Series
from .state import MotionState

_ROWS = 32


@dataclass(frozen=True, eq=False)
class ParallelFilter:
    """Low-pass and decimate rows of samples."""

    response: Samples
    """Symmetric kernel of odd length."""
    decimation: int
    """Keep every n-th sample."""

    @property
    def reach(self) -> int:
        """Count the samples that the kernel sees on either side."""
        return len(self.response) // 2

    @cached_property
    def _band(self) -> Matrix:
        """Write `_ROWS` consecutive decimated samples as rows of a matrix over the samples they see."""
        span = (_ROWS - 1) * self.decimation + len(self.response)
        band = np.zeros((span, _ROWS))
        for row in range(_ROWS):
            band[row * self.decimation : row * self.decimation + len(self.response), row] = self.response
        return band

    @cached_property
    def _magnitude_band(self) -> Matrix:
        return np.asarray(np.abs(self._band) / np.abs(self.response).sum())

    def apply(self, series: Series, first: int, kept: int) -> KeptSeries:
        """Give `kept` filtered instants.

        The first lies at sample `first` of the series, beyond whose ends zeros are assumed.
        """
        return self._run(self._band, series, first, kept)

    def influence(self, marks: Series, first: int, kept: int) -> KeptSeries:
        """Give the share of the kernel's absolute mass that falls on marked samples (marks are 0 or 1)."""
        return self._run(self._magnitude_band, marks, first, kept)

    def _run(self, band: Matrix, series: Series, first: int, kept: int) -> KeptSeries:
        out = np.empty((len(series), kept))
        for begin in range(0, kept, _ROWS):
            rows = min(_ROWS, kept - begin)
            left = first + begin * self.decimation - self.reach
            right = left + (rows - 1) * self.decimation + len(self.response)
            inside = slice(max(left, 0), min(right, series.shape[1]))
            weights = band[inside.start - left : inside.stop - left, :rows]
            out[:, begin : begin + rows] = series[:, inside] @ weights
        return out


@dataclass(frozen=True, eq=False)
class Tile:
    """Carry a stretch of motion at the log's rate, with the parallel filter's decimated samples inside it."""

    state: MotionState
    """Position, velocity, acceleration at the log's rate, the filter's reach included."""
    torque: JointSeries
    """Joint torque at the same instants, N m or N."""
    parallel: ParallelFilter
    first: int
    time: Instants
    """Sample at which the first decimated sample lies, and the decimated samples in s."""
    usable: InstantMask
    """Which decimated samples may be used for which joint."""
    turning: InstantMask
    """Which of these lie so near a reversal that the direction of the joint's friction is in doubt."""
    block: int
    """Number of the log's block that the tile belongs to."""
    follows: bool
    """Whether its first decimated sample comes right after the last of the tile before, without a gap."""

    def filtered(self, series: Series) -> KeptSeries:
        """Apply the parallel filter to rows of samples and keep the tile's instants."""
        return self.parallel.apply(series, self.first, len(self.time))
