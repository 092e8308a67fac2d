"""Hold what a filter learned of a problem's parameters as the equations that are fitted."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Indices, JointVector
from ...regressor.block_scores import BlockScores
from ...regressor.factor import Factor
from ...regressor.memory import Memory
from ..system import LEAST_SQUARES, Criterion, ordinary
from .filtering import Followed
from .innovations import Innovations


@dataclass(frozen=True, eq=False)
class FollowedProblem:
    """Give the equations of a filter: all joints together, over all base parameters."""

    followed: Followed
    criterion: Criterion = LEAST_SQUARES

    @property
    def size(self) -> int:
        """Count the base parameters."""
        return len(self.followed.start.values)

    @property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give all base parameters, for all joints together."""
        return (np.arange(self.size),)

    @property
    def block_factors(self) -> tuple[tuple[Factor, ...], ...]:
        """Give the factor of every fitted block."""
        return tuple((factor,) for factor in self.followed.factors)

    @property
    def factors(self) -> tuple[Factor, ...]:
        """Give the factor of all fitted blocks."""
        first, *others = self.followed.factors
        return (first.merged(*others),)

    @property
    def innovations(self) -> Innovations:
        """Say how well the filter foresaw."""
        start, whole = self.followed.start, self.followed.whole
        (blocks,), (merged,) = self.memory, self.factors
        best = ordinary((merged,), self.columns_of, self.size).solved()
        return Innovations(
            self.followed.position_noise,
            start.options.torque_noise * start.system.noise,
            self.followed.innovation,
            whole.shortened / whole.samples,
            float(blocks.autocovariance(best)[0] / blocks.rows),
            start.options.start_scale,
        )

    @property
    def memory(self) -> tuple[Memory, ...]:
        """Tell how far the blocks agree."""
        return (BlockScores(tuple(self.followed.factors)),)

    @property
    def reversal_weights(self) -> JointVector:
        """Give one per joint: friction at rest is simulated, and no row is in doubt."""
        return np.ones(len(self.followed.innovation))
