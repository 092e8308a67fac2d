"""Write down a set-up's equations: columns of its observation matrix, and which torque is whose."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import BaseParameters, JointVector, Series, Vector
from ..log.columns.assignment import Channels
from ..reduction.base import BaseModel
from ..regressor.columns import ColumnPlan
from .family import MotionProducts, family
from .reduced import Reduced
from .samples import Samples


@dataclass(frozen=True, eq=False)
class Rows:
    """Hold some rows of a set-up's observation matrix: per joint, columns x instants; and their samples."""

    columns: tuple[Series, ...]
    samples: Samples

    def torque(self, channels: Channels) -> tuple[Vector, ...]:
        """Give the torque of every row as it is assigned."""
        torque = channels.of(self.samples.torque)
        return tuple(torque[usable, joint] for joint, usable in enumerate(self.samples.usable.T))

    @property
    def measured(self) -> tuple[Series, ...]:
        """Give all torques as measured at every joint's rows: torques x instants."""
        return tuple(self.samples.torque[usable].T for usable in self.samples.usable.T)


@dataclass(frozen=True, eq=False)
class Regressor:
    """Hold the observation matrix of a set-up's motion."""

    base: BaseModel
    plan: ColumnPlan
    fitted: Rows
    judging: Callable[[], Rows]

    @cached_property
    def products(self) -> MotionProducts:
        """Give the products of the fitted rows."""
        return family([self.fitted.columns], self.plan.columns_of, self.fitted.measured).at(np.ones(1))

    @cached_property
    def judged(self) -> Rows:
        """Give the rows that judge."""
        return self.judging()


@dataclass(frozen=True, eq=False)
class Equations:
    """Hold a set-up's equations: its regressor, and which torque is whose."""

    regressor: Regressor
    channels: Channels

    @cached_property
    def reduced(self) -> Reduced:
        """Give the products of the fitted rows."""
        return self.regressor.products.read(self.channels)

    def errors(self, base: BaseParameters, *, judged: bool) -> JointVector:
        """Give the RMS residual over the RMS torque per joint; one for a joint without torque."""
        parts = self._left(base, judged=judged)
        return np.array([_relative(left, torque) for left, torque in parts])

    def unpredicted(self, base: BaseParameters) -> JointVector:
        """Give the RMS residual over how much the torque varies, per joint, on the rows that judge."""
        parts = self._left(base, judged=True)
        return np.array([_relative(left, torque - _mean(torque)) for left, torque in parts])

    def _left(self, base: BaseParameters, *, judged: bool) -> list[tuple[Vector, Vector]]:
        """Give what is left of the joints' torques, and these."""
        rows = self.regressor.judged if judged else self.regressor.fitted
        parts = zip(rows.columns, self.regressor.plan.columns_of, rows.torque(self.channels), strict=True)
        return [(base[columns] @ own - torque, torque) for own, columns, torque in parts]


def _relative(left: Vector, torque: Vector) -> float:
    whole = float(torque @ torque)
    return float(np.sqrt(left @ left / whole)) if whole > 0.0 else 1.0


def _mean(torque: Vector) -> float:
    return float(torque.mean()) if len(torque) else 0.0
