"""State how the search treats a cause: nothing here is physics, and most causes take the defaults."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from ..thresholds.causes import LINEARISATION


def grid_size(grid: Sequence[Mapping[str, float]], scalars: Mapping[str, float]) -> float:
    """Count the points of a grid."""
    del scalars
    return float(len(grid))


@dataclass(frozen=True)
class SearchTraits:
    """State how the search treats the candidates of a cause."""

    transient: bool = False
    """Whether it acts in short spans only. Noise estimated before it is known contains it, so that a scan
    says little about it."""
    like_position_noise: bool = False
    """Whether position noise, propagated to the torque, resembles it a little."""
    linearisation_error: float = LINEARISATION.usual
    """Relative error of its first-order columns: no size is known better."""
    self_consistent: tuple[str, ...] = ()
    """Scalars that are the size itself: columns are linearised at the size that they yield. Causes that agree
    to first order differ in how their second order follows from it; a free scalar would lose that."""
    discrete: tuple[str, ...] = ()
    """Scalars that are taken from the grid as they are (a side, a sense), not refined."""
    onset: Mapping[str, slice] = field(default_factory=dict)
    """The scalar, if any, that is the instant (s) from which on its columns act, and the columns that show
    it. From minus infinity on they act all along."""
    trials: Callable[[Sequence[Mapping[str, float]], Mapping[str, float]], float] = grid_size
    """How many trials a point of the grid was picked from: what its p-value is corrected for."""
