"""Carry one stretch of conditioned motion, ready for the columns of a model and for the parallel filter."""

from dataclasses import dataclass

from ..arrays import InstantMask, Instants, JointSeries, KeptSeries, Series
from .parallel import ParallelFilter
from .state import MotionState


@dataclass(frozen=True, eq=False)
class Tile:
    """Carry a stretch of motion at the log's rate, with the kept instants of the parallel filter inside it.

    Attributes
    ----------
    state
        Position, velocity, acceleration at the log's rate, the filter's reach included.
    torque
        Joint torque at the same instants, N m or N.
    first, time
        Sample at which the first kept instant lies, and the kept instants in s.
    usable
        Which kept instants may be used for which joint.
    block
        Number of the log's block that the tile belongs to.
    follows
        Whether its first kept instant comes right after the last one of the tile before, with no gap between.
    """

    state: MotionState
    torque: JointSeries
    parallel: ParallelFilter
    first: int
    time: Instants
    usable: InstantMask
    block: int
    follows: bool

    def filtered(self, series: Series) -> KeptSeries:
        """Apply the parallel filter to rows of samples and keep the tile's instants."""
        return self.parallel.apply(series, self.first, len(self.time))
