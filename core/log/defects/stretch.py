"""Cut a log into stretches that fit the cache, each with a few samples of the one before.

All finders process the same stretch before the next one is read, so that a file is decoded once, and what
they find does not depend on whether the log lies in memory or on disk.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from ...arrays import IncrementMask, JointMarks, JointVector, Samples, Series
from ..channels import EFFORTS
from ..model import Defect, LogSource

STRETCH_ROWS = 32_768
CONTEXT_ROWS = 4
"""Samples seen before that are given again, as many as a median of five reaches over."""
LEAST_TRAVEL_STEPS = 50.0
LEAST_TRAVEL = 0.01
"""A joint within this many steps of its resolution, or this many rad or m, is held and not moved."""
JUMP_FACTOR = 6.0
"""A jump is so many times the difference, first or second, that 99 % of the samples stay below. Noise of any
density stays below three times it, and a sine's largest difference equals it."""
USUAL_SHARE = 0.99
GRID_STEPS = 3.0
"""A jump is more than so many of the smallest steps of its channel."""
SAMPLED_ROWS = 200_000
"""Rows that a statistic may keep which needs all samples at once."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """Carry consecutive samples, one row per joint."""

    first: int
    """Row number of the first sample."""
    context: int
    """How many leading samples the stretch before gave already."""
    time: Samples
    channels: dict[str, Series]
    """By name, one row per joint."""

    @property
    def position(self) -> Series:
        """Give the positions."""
        return self.channels["position"]

    @property
    def torque(self) -> Series | None:
        """Give the torques, where they are logged."""
        return self.channels.get("torque")

    @property
    def effort(self) -> str:
        """Name the channel of what drives the joints: torque, or current where no torque is logged."""
        return next(name for name in EFFORTS if name in self.channels)

    @property
    def first_new(self) -> int:
        """Index of the sample from which new increments start: the last one seen before, if any."""
        return max(self.context - 1, 0)

    def new(self) -> dict[str, Series]:
        """Give all channels by name, with the context cut off."""
        return {name: values[:, self.context :] for name, values in self.channels.items()}


@dataclass(frozen=True, eq=False)
class Facts:
    """Carry what is known of the whole log when the finders state their defects."""

    samples: int
    start: float
    duration: float
    step: float
    """Median step of the stamps, s."""
    low: dict[str, JointVector]
    high: dict[str, JointVector]
    """Extremes of each channel, joint by joint, with medians in the place of spikes."""
    deviation: dict[str, JointVector]
    roughness: JointVector
    """Von Neumann's ratio of each joint's positions: mean square of the steps over the variance."""
    whole: dict[str, JointMarks]
    """By effort channel, the joints on which it comes in whole numbers only."""
    position_lsb: JointVector
    """Resolution of each joint's position, 0 where none shows."""
    units: Mapping[str, Sequence[str]]
    """SI unit of each channel, joint by joint."""

    def travels(self, joint: int) -> bool:
        """Tell whether a joint (from 0) is moved at all, rather than held against its load."""
        least = max(LEAST_TRAVEL, LEAST_TRAVEL_STEPS * float(self.position_lsb[joint]))
        return bool(self.span("position")[joint] > least)

    def span(self, channel: str) -> JointVector:
        """Give high minus low of a channel, joint by joint."""
        span: JointVector = self.high[channel] - self.low[channel]
        return span


@runtime_checkable
class Finder(Protocol):
    """Find one kind of defect."""

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""

    def defects(self, facts: Facts) -> list[Defect]:
        """State what was found."""


def stretches(source: LogSource) -> Iterator[Stretch]:
    """Read a log once, from its first row to its last."""
    samples = source.samples
    starts = list(range(0, samples, STRETCH_ROWS))
    if len(starts) > 1 and samples - starts[-1] < STRETCH_ROWS // 4:
        starts.pop()  # a stub is too short to estimate its own scale
    for start, stop in zip(starts, [*starts[1:], samples], strict=True):
        context = min(start, CONTEXT_ROWS)
        rows = source.rows(start - context, stop)
        yield Stretch(
            first=start - context,
            context=context,
            time=rows.time,
            channels={name: np.ascontiguousarray(values.T) for name, values in rows.channels().items()},
        )


def count_text(number: int, noun: str) -> str:
    """Write a number with its noun.

    Examples
    --------
    >>> count_text(1, "sample"), count_text(3, "sample")
    ('1 sample', '3 samples')
    """
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def sampled_share(samples: int, at_most: int = SAMPLED_ROWS) -> float:
    """Give the share of each stretch a bounded sample of the log may take."""
    return min(1.0, at_most / max(samples, 1))


def usual_step(steps: Samples) -> float:
    """Give the usual largest of the steps of one joint, or what its resolution makes of it."""
    taken = steps[steps > 0.0]
    if not len(taken):
        return 0.0
    return float(max(np.quantile(taken, USUAL_SHARE), GRID_STEPS / JUMP_FACTOR * taken.min()))


def repeats_previous(values: Series) -> IncrementMask:
    """Mark the samples, from the second on, in which every row equals the sample before exactly."""
    same: IncrementMask = values[0, 1:] == values[0, :-1]
    for row in values[1:]:
        if not same.any():
            break
        same &= row[1:] == row[:-1]
    return same
