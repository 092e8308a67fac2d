"""Hold what a filter learned of a problem's parameters as the equations that are fitted."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Indices, JointVector, Parameters
from ..regressor.block_scores import BlockScores
from ..regressor.factor import Factor, Weigh
from ..regressor.memory import Memory
from .filtering import Followed
from .innovations import Innovations
from .methods.method import FitData
from .system import LEAST_SQUARES, Criterion, ordinary


@dataclass(frozen=True, eq=False)
class FollowedProblem:
    """Give the equations of a filter: all joints together, over all base parameters."""

    measured: FitData
    """The problem as it is written with measured columns."""
    followed: Followed
    robust: bool = False
    criterion: Criterion = LEAST_SQUARES

    @property
    def size(self) -> int:
        """Count the base parameters."""
        return self.measured.size

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
        )

    @property
    def memory(self) -> tuple[Memory, ...]:
        """Tell how far the blocks agree."""
        return (BlockScores(tuple(self.followed.factors)),)

    @property
    def reversal_weights(self) -> JointVector:
        """Give one per joint: friction at rest is simulated, and no row is in doubt."""
        return np.ones(len(self.followed.innovation))

    def discounted(self) -> FitData:
        """Give the same."""
        return self

    def weighted(self, weigh: Weigh) -> FitData:
        """Weigh the rows with measured columns."""
        return self.measured.weighted(weigh)

    def simulated(self, at: Parameters) -> FitData:
        """Take simulated columns."""
        return self.measured.simulated(at)

    def instrumented(self, at: Parameters) -> FitData:
        """Take simulated columns as instruments."""
        return self.measured.instrumented(at)

    def filtered(self, at: Parameters, *, unscented: bool) -> tuple[FitData, Innovations]:
        """Filter again from other parameters."""
        return self.measured.filtered(at, unscented=unscented)
