"""Read signals of one joint in a range of time from a file of traces, min/max decimated.

Rows are read by groups and only the columns that are asked for, so that a picture of an hour costs little
more than one of a minute.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from ...arrays import Instants, InstantSeries, JointSeries, Mask, Samples
from ...errors import OptionError
from ...log.preview import rows_between, thin
from ...numerics.marked_runs import marked_runs
from .layout import HELD_OUT, LOG, SIGNALS, TIME, USED, column

GAP_STEPS = 1.5
"""Rows further apart than this many steps have a gap between them."""
MOST_SPANS = 400
"""Number of spans beyond which neighbours are merged."""
Spans = list[tuple[float, float]]


@dataclass(frozen=True)
class View:
    """Select signals and a range of time."""

    log: int
    joint: int
    """Numbers of the log and of the joint, counted from 1."""
    signals: tuple[str, ...]
    """Names of `layout.SIGNALS`."""
    begin: float | None = None
    end: float | None = None
    """Stretch of the log's clock, s; None for its own ends."""
    points: int = 2000
    """The most points per trace."""


@dataclass(frozen=True, eq=False)
class Traces:
    """Hold decimated traces on one time axis."""

    extent: tuple[float, float]
    """First and last decimated sample of the whole log, s."""
    time: Instants
    values: InstantSeries
    """Instants, and one column per signal; NaN at gaps."""
    units: tuple[str, ...]
    """Of each signal."""
    rows_per_stretch: int
    """How many rows became two points; 1 where every row is there."""
    held_out: Spans
    left_out: Spans
    """Spans that are held out, and spans that do not count for this joint."""


def read_traces(path: Path, view: View) -> Traces:
    """Read the selected signals.

    Raises
    ------
    OptionError
        If there is no such log, joint or signal, or nothing was measured in that stretch of time.
    """
    with pq.ParquetFile(path) as file:
        log = LogOfTraces(file, view.log)
        known = log.known(view.joint)
        for signal in view.signals:
            if signal not in known:
                raise _unknown("signal", signal, known)
        time = log.column(TIME)
        first, last = rows_between(lambda row: float(time[row]), len(time), view.begin, view.end)
        inside = time[first:last]
        names = [column(signal, view.joint) for signal in view.signals]

        def read(start: int, stop: int) -> tuple[Samples, JointSeries]:
            return inside[start:stop], log.columns(names, first + start, first + stop)

        seen = thin(read, stretches(inside), points=view.points)
        held_out, used = (log.column(name)[first:last] for name in (HELD_OUT, column(USED, view.joint)))
        return Traces(
            extent=(float(time[0]), float(time[-1])),
            time=seen.time,
            values=seen.values,
            units=tuple(log.unit(name) for name in names),
            rows_per_stretch=seen.rows_per_stretch,
            held_out=_spans(inside, held_out),
            left_out=_spans(inside, ~used),
        )


@dataclass(frozen=True, eq=False)
class LogOfTraces:
    """Give the rows of one log of a file by number, from 0."""

    file: pq.ParquetFile
    number: int

    @cached_property
    def groups(self) -> tuple[int, ...]:
        """List the groups of rows that are this log's; none holds rows of two."""
        column = self.file.schema_arrow.get_field_index(LOG)
        every = range(self.file.metadata.num_row_groups)
        return tuple(group for group in every if self._log_of(group, column) == self.number)

    @cached_property
    def starts(self) -> list[int]:
        """Give the first row of each group, and the number of rows."""
        sizes = [self.file.metadata.row_group(group).num_rows for group in self.groups]
        return [0, *np.cumsum(sizes).tolist()]

    def known(self, joint: int) -> list[str]:
        """List the signals of a joint, counted from 1.

        Raises
        ------
        OptionError
            If there is no such log or joint.
        """
        names = set(self.file.schema_arrow.names)
        if not self.groups:
            last = self._log_of(self.file.metadata.num_row_groups - 1, 0)
            raise _unknown("log", self.number, list(range(1, last + 1)))
        joints = [int(name.rpartition("_")[2]) for name in names if name.startswith(f"{USED}_")]
        if joint not in joints:
            raise _unknown("joint", joint, sorted(joints))
        return [signal for signal in SIGNALS if column(signal, joint) in names]

    def unit(self, name: str) -> str:
        """Give the unit of a column."""
        return str(self.file.schema_arrow.field(name).metadata[b"unit"].decode())

    def column(self, name: str) -> np.ndarray:
        """Read a whole column."""
        read = self.file.read_row_groups(list(self.groups), columns=[name], use_threads=False)
        return np.asarray(read.column(0).to_numpy())

    def columns(self, names: Sequence[str], start: int, stop: int) -> JointSeries:
        """Read the rows from start up to, not including, stop."""
        first, last = bisect_right(self.starts, start) - 1, bisect_right(self.starts, stop - 1)
        groups = list(self.groups[first:last])
        read = self.file.read_row_groups(groups, columns=list(dict.fromkeys(names)), use_threads=False)
        inner = read.slice(start - self.starts[first], stop - start)
        return np.column_stack([inner.column(name).to_numpy().astype(float) for name in names])

    def _log_of(self, group: int, column: int) -> int:
        return int(self.file.metadata.row_group(group).column(column).statistics.min)


def stretches(time: Samples) -> list[tuple[int, int]]:
    """Give the (start, stop) rows between gaps."""
    steps = np.diff(time)
    breaks = np.flatnonzero(steps > GAP_STEPS * np.median(steps)) + 1 if len(steps) else np.array([], int)
    borders = [0, *breaks.tolist(), len(time)]
    return list(pairwise(borders))


def _spans(time: Samples, marks: Mask) -> Spans:
    """Give first and last time of every run of marks; if there are many, the nearest are merged."""
    first, stop = marked_runs(marks).T
    begin, end = time[first], time[stop - 1]
    if len(begin) > MOST_SPANS:
        apart = begin[1:] - end[:-1]
        kept = np.sort(np.argsort(apart, kind="stable")[-(MOST_SPANS - 1) :])
        begin, end = np.append(begin[0], begin[1:][kept]), np.append(end[:-1][kept], end[-1])
    return list(zip(begin.tolist(), end.tolist(), strict=True))


def _unknown(what: str, given: int | str, known: list[int] | list[str]) -> OptionError:
    return OptionError(
        f"the result has no {what} {given}",
        evidence={what: given, "known": known},
        remedy=f"name a {what} of those that are known",
    )
