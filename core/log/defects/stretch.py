"""Cut a log into stretches that fit the cache, each with a few samples of the one before.

All finders look at the same stretch before the next one is read, so that a file is decoded once, and what
they find does not depend on whether the log lies in memory or on disk.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool

from ...arrays import JointSeries, JointVector, Samples, Series
from ..model import Defect, LogSource

Mask = Bool[np.ndarray, " increments"]

STRETCH_ROWS = 32_768
CONTEXT_ROWS = 4
"""Samples seen before that are given again, as many as a median of five reaches over."""

LEAST_TRAVEL_STEPS = 50.0
LEAST_TRAVEL = 0.01
"""A joint within this many steps of its resolution, or this many rad or m, is held and not moved."""

SAMPLED_ROWS = 200_000
"""Rows that a statistic may keep which needs all samples at once."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """Carry consecutive samples, one row per joint.

    Attributes
    ----------
    first
        Row number of the first sample.
    context
        How many leading samples the stretch before gave already.
    """

    first: int
    context: int
    time: Samples
    position: Series
    torque: Series | None
    others: dict[str, Series]

    @property
    def seam(self) -> int:
        """Index of the sample from which new increments start: the last one seen before, if any."""
        return max(self.context - 1, 0)

    def channels(self) -> dict[str, Series]:
        """Give all channels by name, with the context cut off."""
        torque = {} if self.torque is None else {"torque": self.torque}
        everything = {"position": self.position, **torque, **self.others}
        return {name: values[:, self.context :] for name, values in everything.items()}


@dataclass(frozen=True, eq=False)
class Facts:
    """Carry what is known of the whole log when the finders state their defects.

    Attributes
    ----------
    step
        Median step of the stamps, s.
    position_lsb
        Resolution of each joint's position, 0 where none shows.
    """

    samples: int
    start: float
    duration: float
    step: float
    low: dict[str, JointVector]
    high: dict[str, JointVector]
    deviation: dict[str, JointVector]
    position_lsb: JointVector

    def travels(self, joint: int) -> bool:
        """Tell whether a joint (from 0) is moved at all, rather than held against its load."""
        least = max(LEAST_TRAVEL, LEAST_TRAVEL_STEPS * float(self.position_lsb[joint]))
        return bool(self.span("position")[joint] > least)

    def span(self, channel: str) -> JointVector:
        """Give high minus low of a channel, joint by joint."""
        span: JointVector = self.high[channel] - self.low[channel]
        return span


@runtime_checkable
@runtime_checkable
class Finder(Protocol):
    """Find one kind of defect."""

    def see(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        ...

    def defects(self, facts: Facts) -> list[Defect]:
        """State what was found."""
        ...


def stretches(source: LogSource) -> Iterator[Stretch]:
    """Read a log once, from its first row to its last."""
    samples = source.samples
    starts = list(range(0, samples, STRETCH_ROWS))
    if len(starts) > 1 and samples - starts[-1] < STRETCH_ROWS // 4:
        starts.pop()  # a stub tells too little of its own scale
    for start, stop in zip(starts, [*starts[1:], samples], strict=True):
        context = min(start, CONTEXT_ROWS)
        rows = source.rows(start - context, stop)
        optional = {"velocity": rows.velocity, "current": rows.current, "temperature": rows.temperature}
        yield Stretch(
            first=start - context,
            context=context,
            time=rows.time,
            position=_by_joint(rows.position),
            torque=None if rows.torque is None else _by_joint(rows.torque),
            others={name: _by_joint(values) for name, values in optional.items() if values is not None},
        )


def counted(number: int, noun: str) -> str:
    """Write a number with its noun.

    Examples
    --------
    >>> counted(1, "sample"), counted(3, "sample")
    ('1 sample', '3 samples')
    """
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def sampled_share(samples: int, at_most: int = SAMPLED_ROWS) -> float:
    """Tell which share of each stretch a bounded sample of the log may take."""
    return min(1.0, at_most / max(samples, 1))


def repeats_previous(values: Series) -> Mask:
    """Mark the samples, from the second on, in which every row equals the sample before exactly."""
    same: Mask = values[0, 1:] == values[0, :-1]
    for row in values[1:]:
        if not same.any():
            break
        same &= row[1:] == row[:-1]
    return same


def _by_joint(values: JointSeries) -> Series:
    return np.ascontiguousarray(values.T)
