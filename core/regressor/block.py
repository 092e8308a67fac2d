"""Hold one contiguous stretch of a log, condensed, and what gathers it tile by tile.

Per joint there are two factors: the rows in which the direction of its friction is known, and those beside a
reversal. So a weight of the latter needs no other pass over the log.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import JointVector, Rows, SampleMask, Samples
from .factor import Factor, Groups
from .memory import LaggedProducts


@dataclass(frozen=True, eq=False)
class Block:
    """Hold one contiguous stretch of one log, condensed."""

    log: int
    number: int
    start: float
    end: float
    moving: tuple[Factor, ...]
    turning: tuple[Factor, ...]
    """Per joint, over its non-zero columns and torque: the rows in which the direction of its friction is
    known, and those beside a reversal."""
    torque_range: tuple[tuple[float, float], ...]
    """Per joint, smallest and largest filtered torque, N m."""

    @cached_property
    def factors(self) -> tuple[Factor, ...]:
        """Give, per joint, the factor of all rows."""
        return self.discounted(np.ones(len(self.moving)))

    def discounted(self, weights: JointVector) -> tuple[Factor, ...]:
        """Give, per joint, the factor of all rows, those beside a reversal times a weight."""
        parts = zip(self.moving, self.turning, weights, strict=True)
        return tuple(moving.merged(turning.scaled(float(weight))) for moving, turning, weight in parts)


@dataclass(frozen=True, eq=False)
class Tail:
    """Hold the last rows of a joint, and which of them lie beside a reversal."""

    rows: Rows
    turning: SampleMask

    @property
    def none(self) -> "Tail":
        """Give no rows of this width."""
        return Tail(self.rows[:0], self.turning[:0])

    @property
    def last(self) -> "Tail":
        """Keep as many as lags reach."""
        return Tail(self.rows[-LaggedProducts.LAGS :], self.turning[-LaggedProducts.LAGS :])


class OpenBlock:
    """Gather a block's rows."""

    def __init__(self, groups: tuple[Groups, ...], start: float) -> None:
        """Start without rows, at a time in s; `groups` are those of every joint's columns."""
        self.start = self.end = start
        self.moving = [Factor.empty(sum(dict(own).values()), own) for own in groups]
        self.turning = list(self.moving)
        self.low = np.full(len(groups), np.inf)
        self.high = np.full(len(groups), -np.inf)

    def take(self, joint: int, parts: tuple[Rows, Rows], torque: Samples) -> None:
        """Take a joint's moving rows and those beside a reversal."""
        self.moving[joint] = self.moving[joint].extended(parts[0])
        self.turning[joint] = self.turning[joint].extended(parts[1])
        if len(torque):
            self.low[joint] = min(self.low[joint], float(torque.min()))
            self.high[joint] = max(self.high[joint], float(torque.max()))

    def closed(self, log: int, number: int) -> Block:
        """Give the block with its place."""
        ranges = tuple((float(low), float(high)) for low, high in zip(self.low, self.high, strict=True))
        return Block(log, number, self.start, self.end, tuple(self.moving), tuple(self.turning), ranges)
