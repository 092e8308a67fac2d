"""Hold a robot's log in SI, read piece by piece, so that its length never decides the memory a study needs.

A `JointLog` is what was measured plus what is known to be wrong with it; the samples stay in a `LogSource`
(arrays in memory or a file on disk) and are read in rows from start to stop.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from ..arrays import JointSeries, Samples
from .channels import JOINT_CHANNELS
from .columns.binding import Binding


@dataclass(frozen=True)
class Defect:
    """Name one thing that is wrong with usable data, where it is and how much of it there is.

    Attributes
    ----------
    kind
        ``rearranged, missing_values, doubled_rows, blank_rows, lost_values, bad_end, time_restarts,
        shuffled_rows, broken_stamps, rounded_stamps, wrapped_angle, gap, jitter, repeated_rows,
        stuck_channel, filled_rows, replayed_rows, unpowered, outliers, saturation, quantisation, standstill,
        short, slow_rate, one_direction, velocity_mismatch, position_is_reference, shared_position,
        unsigned_torque, unknown_sign, implausible_unit, missing_torque``.
    channel
        ``time, position, torque`` ...; ``file`` where it concerns the form of the file.
    joint
        Joint number from 1, or None where it concerns all joints.
    count
        How many samples it touches.
    intervals
        Where it is: the twenty longest (start, end) pairs in s, in the order of time; empty where it is
        everywhere.
    statement
        One sentence with numbers and units.
    level
        Where a saturated channel stays, or how far from the median of five a sample stands apart, in the
        channel's SI unit; None for all else.
    """

    kind: str
    channel: str
    joint: int | None
    count: int
    intervals: tuple[tuple[float, float], ...]
    statement: str
    level: float | None = None


@dataclass(frozen=True, eq=False)
class LogRows:
    """Carry a stretch of samples in SI.

    Time in s, position in rad or m, velocity per s, torque in N m or N, current in A, temperature in degC,
    references in the units of what follows them; see `core.log.channels`.
    """

    time: Samples
    position: JointSeries
    torque: JointSeries | None = None
    velocity: JointSeries | None = None
    current: JointSeries | None = None
    temperature: JointSeries | None = None
    position_ref: JointSeries | None = None
    velocity_ref: JointSeries | None = None
    torque_ref: JointSeries | None = None
    command: JointSeries | None = None

    def channels(self) -> dict[str, JointSeries]:
        """Give the channels that are there, by name."""
        there = {channel.name: getattr(self, channel.name) for channel in JOINT_CHANNELS}
        return {name: values for name, values in there.items() if values is not None}


@runtime_checkable
class LogSource(Protocol):
    """Give samples in SI by row number; time starts anywhere and increases strictly."""

    @property
    def samples(self) -> int:
        """Count the rows."""

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop."""


@dataclass(frozen=True, eq=False)
class ArraySource:
    """Give samples from arrays in memory."""

    data: LogRows

    @property
    def samples(self) -> int:
        """Count the rows."""
        return len(self.data.time)

    def rows(self, start: int, stop: int) -> LogRows:
        """Slice the arrays; no copy is made."""
        return rows_at(self.data, slice(start, stop))


@dataclass(frozen=True, eq=False)
class JointLog:
    """Carry one log: where its samples are, how they are clocked, and what is wrong with them.

    Attributes
    ----------
    source
        The samples.
    joints
        Number of joints.
    rate_hz
        One over the median step of the stamps.
    duration
        Last stamp minus first, s.
    segments
        (start, stop) rows of the stretches between gaps; a study never differentiates across their borders.
    defects
        What is wrong but usable.
    ignored_columns
        Columns of the file that the mapping does not name.
    sha256
        Hash of the file's bytes, for provenance.
    bindings
        The columns that the samples were read from, time first where there is a column of it.
    """

    name: str
    source: LogSource
    joints: int
    rate_hz: float
    duration: float
    segments: tuple[tuple[int, int], ...]
    defects: tuple[Defect, ...] = ()
    channels: tuple[str, ...] = ("position", "torque")
    ignored_columns: tuple[str, ...] = ()
    sha256: str = ""
    bindings: tuple[Binding, ...] = ()

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self.source.samples


def rows_at(rows: LogRows, index: slice | np.ndarray) -> LogRows:
    """Take some rows of all channels, by a slice, by number or by marks."""
    return LogRows(rows.time[index], **{name: values[index] for name, values in rows.channels().items()})


def joined_rows(parts: Sequence[LogRows]) -> LogRows:
    """Put the rows of parts with the same channels one after the other."""
    channels = [part.channels() for part in parts]
    return LogRows(
        np.concatenate([part.time for part in parts]),
        **{name: np.concatenate([channel[name] for channel in channels]) for name in channels[0]},
    )


def whole_rows(log: JointLog) -> LogRows:
    """Read all samples at once; for short logs, plots and tests."""
    return log.source.rows(0, log.samples)


STANDING_ROWS = 20
"""More repeats than these in a row are a standstill, or a recorder's; fewer are samples that it missed."""


def repeated_rows(rows: LogRows) -> np.ndarray:
    """Mark the rows whose positions and torques (currents, where no torque is logged) repeat the row before.

    As for a dropped sample.
    """
    effort = rows.current if rows.torque is None else rows.torque
    measured = rows.position if effort is None else np.hstack([rows.position, effort])
    same = np.zeros(len(measured), dtype=bool)
    same[1:] = np.all(measured[1:] == measured[:-1], axis=1)
    return same
