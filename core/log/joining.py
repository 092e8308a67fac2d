"""Join files that belong together: positions in one and torques in another, or a file per joint or channel.

The clock of the first file that holds positions is kept, because positions are differentiated. What other
files hold is brought to it, inside the time that all share: as it is where the stamps are the same, else
positions by a cubic through four samples, and torques, which carry noise, by a straight line between two.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ..arrays import Instants, SampleMask, Samples
from ..errors import LogError
from .channels import TIME, UNITS
from .columns.families import channel_of, clocks
from .columns.named_units import unit_called, unit_in_name
from .columns.plausible_units import plausible_readings
from .defects.stretch import count_text
from .formats.table import Table, check_values
from .reader import open_table

CUBIC_POINTS = 4
SPARSE = 0.1
"""A column that lacks more than this part of its values was recorded at instants of its own."""
FEWEST_SHARED = 0.5
"""Files that share less than this part of the shortest one's time do not belong together."""


@dataclass(frozen=True, eq=False)
class Joined:
    """Carry the columns of several files on one clock, and what was done to get them."""

    columns: dict[str, Samples]
    notes: tuple[str, ...]

    def save(self, path: Path) -> None:
        """Write the columns as Parquet."""
        pq.write_table(pa.table(self.columns), path)


@dataclass(frozen=True, eq=False)
class _Part:
    """Carry the columns of one file."""

    name: str
    stamp: str
    time: Samples
    columns: dict[str, Samples]
    label: str
    """What it is called in notes."""


def join_logs(paths: Sequence[Path]) -> Joined:
    """Join files by their stamps, or the channels of one file that were recorded at instants of their own.

    Columns keep their names; those that several files have get the name of their file in front.

    Raises
    ------
    LogError
        If a file has no clock, or clocks share less than half of the shortest file's time.
    """
    parts = list(chain(*(_split(_read(path)) for path in paths)))
    first = _leading(parts)
    inside = _shared_time(parts, first.time)
    clock = first.time[inside]
    columns, notes = {TIME: clock}, []
    taken = _repeated(parts)
    for part in parts:
        same = np.array_equal(part.time, first.time)
        for name, values in part.columns.items():
            own = f"{part.name}_{name}" if name in taken else name
            columns[own] = values[inside] if same else _brought(name, clock, part.time, values)
        if not same:
            notes.append(f"{part.label}: interpolated at the stamps of {first.label}")
    check_values(len(columns) * len(clock))
    outside = int(np.count_nonzero(~inside))
    if outside:
        notes.append(f"{count_text(outside, 'row')} of {first.label} outside the shared time left out")
    return Joined(columns, tuple(notes))


def _shared_time(parts: Sequence[_Part], time: Samples) -> SampleMask:
    """Mark the instants of which every file has some; they are at least half of the shortest."""
    begin, end = max(part.time[0] for part in parts), min(part.time[-1] for part in parts)
    _check_shared(parts, float(begin), float(end))
    return np.asarray((time >= begin) & (time <= end))


def _leading(parts: Sequence[_Part]) -> _Part:
    """Give the first file with positions, whose clock the others are brought to; else the first."""
    return next((part for part in parts if any(map(_is_position, part.columns))), parts[0])


def _is_position(name: str) -> bool:
    return channel_of(name, ()) in ("position", "position_ref")


def _brought(name: str, clock: Instants, time: Samples, values: Samples) -> Instants:
    """Interpolate a column at other stamps."""
    if not _is_position(name) or len(time) < CUBIC_POINTS:
        return np.asarray(np.interp(clock, time, values))
    first = np.clip(np.searchsorted(time, clock) - CUBIC_POINTS // 2, 0, len(time) - CUBIC_POINTS)
    points = [first + offset for offset in range(CUBIC_POINTS)]
    total = np.zeros(len(clock))
    for own in points:
        weight = np.ones(len(clock))
        for other in points:
            if other is not own:
                weight *= (clock - time[other]) / (time[own] - time[other])
        total += weight * values[own]
    return total


def _read(path: Path) -> _Part:
    table = open_table(path)[1]
    stamp = _stamp(table, path)
    numbers = [name for name in table.names if name != stamp and name not in table.texts]
    block = np.hstack(list(table.batches([stamp, *numbers])))
    time = block[0] * _seconds(table, stamp, block[0])
    return _Part(path.stem, stamp, time, dict(zip(numbers, block[1:], strict=True)), path.stem)


def _split(part: _Part) -> list[_Part]:
    """Part columns that have values at instants of their own, each with its own stamps.

    Raises
    ------
    LogError
        If the stamps of a part do not increase.
    """
    alike: dict[bytes, list[str]] = {}
    for name, values in part.columns.items():
        alike.setdefault(_instants(values).tobytes(), []).append(name)
    parts = []
    for rows, names in alike.items():
        known = np.frombuffer(rows, dtype=bool)
        own = {name: part.columns[name][known] for name in names}
        parts.append(_Part(part.name, part.stamp, part.time[known], own, _label(part, names)))
    return [_in_order(own_part) for own_part in parts if len(own_part.time)] or [_in_order(part)]


def _label(part: _Part, names: Sequence[str]) -> str:
    """Call columns by the first of them, where they are not all of a file."""
    if len(names) == len(part.columns):
        return part.name
    return names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more"


def _instants(values: Samples) -> SampleMask:
    """Mark the rows at which a column was recorded: all, unless many lack a value."""
    known = np.isfinite(values)
    return known if np.mean(known) < 1.0 - SPARSE else np.ones(len(values), dtype=bool)


def _in_order(part: _Part) -> _Part:
    """Give the part if its stamps increase."""
    steps = np.diff(part.time)
    if not np.all(steps > 0.0):
        raise LogError(
            "the stamps of a file that is to be joined do not increase",
            evidence={"file": part.name, "column": part.stamp, "not_increasing": int(np.sum(~(steps > 0.0)))},
            remedy="join files of one run each, whose stamps increase",
        )
    return part


def _stamp(table: Table, path: Path) -> str:
    found = clocks(table.names)
    if not found:
        raise LogError(
            "a file that is to be joined has no clock",
            evidence={"file": path.name, "columns": list(table.names[:24])},
            remedy="give every file a column of stamps on one clock, called time",
        )
    return found[0]


def _seconds(table: Table, stamp: str, values: Samples) -> float:
    """Give how many seconds one of the stamps is."""
    said = unit_called(TIME, table.units.get(stamp, "")) or unit_in_name(TIME, stamp)
    plausible = plausible_readings(TIME, values)
    unit = said or (plausible[0].split(":")[0] if plausible and stamp != TIME else "s")
    return UNITS[TIME][unit].factor


def _check_shared(parts: Sequence[_Part], begin: float, end: float) -> None:
    shortest = min(part.time[-1] - part.time[0] for part in parts)
    if end - begin >= FEWEST_SHARED * shortest:
        return
    spans: Mapping[str, list[float]] = {
        part.name: [float(part.time[0]), float(part.time[-1])] for part in parts
    }
    raise LogError(
        "the files share too little time to belong together",
        evidence={"from_to_s": dict(spans), "shared_s": max(end - begin, 0.0)},
        remedy="join files of the same run, on the same clock",
    )


def _repeated(parts: Sequence[_Part]) -> set[str]:
    counts = Counter(chain(*(part.columns for part in parts)))
    return {name for name, count in counts.items() if count > 1}
