"""Carry one stretch of conditioned motion, ready for the columns of a model and for the parallel filter."""

from dataclasses import dataclass

from ..arrays import InstantMask, Instants, JointSeries, KeptSeries, Series
from .parallel import ParallelFilter
from .state import MotionState


@dataclass(frozen=True, eq=False)
class Tile:
    """Carry a stretch of motion at the log's rate, with the parallel filter's kept instants inside it."""

    state: MotionState
    """Position, velocity, acceleration at the log's rate, the filter's reach included."""
    torque: JointSeries
    """Joint torque at the same instants, N m or N."""
    parallel: ParallelFilter
    first: int
    time: Instants
    """Sample at which the first kept instant lies, and the kept instants in s."""
    usable: InstantMask
    """Which kept instants may be used for which joint."""
    block: int
    """Number of the log's block that the tile belongs to."""
    follows: bool
    """Whether its first kept instant comes right after the last of the tile before, without a gap."""

    def filtered(self, series: Series) -> KeptSeries:
        """Apply the parallel filter to rows of samples and keep the tile's instants."""
        return self.parallel.apply(series, self.first, len(self.time))
