"""Bind a mapping to a file's columns: which column is which joint's channel, and how its numbers become SI.

Where a channel is not mapped its default names hold (`time`, `q_1`, `tau_1`, ...). A refusal lists the
columns looked for, those that are there, and plausible readings.
"""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import JointSeries, Series
from ...errors import LogError
from ..channels import CHANNELS, EFFORTS, JOINT_CHANNELS, TIME, UNITS, Channel
from ..formats.table import Table
from ..model import LogRows
from ..refusals import absent_names, contradiction_error, missing_error, refuse_other_clock, unit_error
from .binding import Binding
from .mapping import ChannelRequest, LogMapping
from .named_units import unit_called

OTHER_NAME = "a column of another name is mapped, with its unit"
OTHER_FILE = "if they are in another file, join the two: veritorque logs join A B -o run.parquet"

UNNEEDED = ("optional", "reference")
"""Needs of channels that a log may lack. One sensor for an arm, or a channel of some joints, is left out."""


@dataclass(frozen=True)
class Layout:
    """Map channels to columns. Without a time column the rows follow a uniform clock of `rate_hz`."""

    time: Binding | None
    rate_hz: float
    channels: tuple[Binding, ...]
    ignored: tuple[str, ...] = ()

    @property
    def bindings(self) -> tuple[Binding, ...]:
        """List all bindings, time first where there is a column of it."""
        return (*([self.time] if self.time else []), *self.channels)

    @property
    def columns(self) -> tuple[str, ...]:
        """List all columns that are read, time first."""
        first = self.time.columns if self.time else ()
        return first + tuple(column for channel in self.channels for column in channel.columns)

    @property
    def joints(self) -> int:
        """Count the joints."""
        return len(self.channels[0].columns)

    @property
    def default_references(self) -> tuple[str, ...]:
        """Name the reference channels that the log has by default names, and the user has not asked for."""
        return tuple(
            bound.name
            for bound in self.channels
            if CHANNELS[bound.name].need == "reference"
            and all(name.startswith(CHANNELS[bound.name].prefix) for name in bound.columns)
        )

    def without(self, channels: Collection[str]) -> "Layout":
        """Leave channels out; their columns are ignored."""
        left = [bound for bound in self.channels if bound.name in channels]
        return replace(
            self,
            channels=tuple(bound for bound in self.channels if bound not in left),
            ignored=(*self.ignored, *(column for bound in left for column in bound.columns)),
        )

    def si_units(self) -> dict[str, tuple[str, ...]]:
        """Name the SI unit of every channel, joint by joint.

        A joint is prismatic where a unit that only prismatic joints have is declared for one of its channels.
        """
        prismatic = {
            joint
            for bound in self.channels
            for joint, unit in enumerate(bound.units)
            if UNITS[bound.name][unit].prismatic
        }
        quantities = {bound.name: CHANNELS[bound.name].quantity for bound in self.channels}
        return {
            name: tuple(
                quantity.prismatic if joint in prismatic else quantity.revolute
                for joint in range(self.joints)
            )
            for name, quantity in quantities.items()
        }

    def convert(self, block: Series, start: int) -> LogRows:
        """Turn a block of `columns` (columns by rows), whose first row has the number start, into SI."""
        if self.time is None:
            time = np.arange(start, start + block.shape[1]) / self.rate_hz
            at = 0
        else:
            time = self.time.convert(block[:1])[:, 0]
            at = 1
        parts: dict[str, JointSeries] = {}
        for channel in self.channels:
            parts[channel.name] = channel.convert(block[at : at + len(channel.columns)])
            at += len(channel.columns)
        return LogRows(time, **parts)


def bind(table: Table, mapping: LogMapping) -> Layout:
    """Find every channel's columns.

    Raises
    ------
    LogError
        If time, position, or both torque and current are missing, if a mapped column is not there, if a
        channel does not have one column per joint, or if a column's unit is neither declared nor given by its
        default name.
    """
    time = _bind_time(table, mapping)
    bound = [_bind_channel(channel, table, mapping) for channel in JOINT_CHANNELS]
    channels = tuple(filter(None, bound))
    _require(table, channels)
    channels = tuple(channel for channel in channels if not _is_other(channel, channels, mapping))
    _one_column_per_joint(channels)
    used = _used_columns((*channels, time) if time else channels)
    ignored = tuple(name for name in table.names if name not in used)
    return Layout(time, mapping.rate_hz or 0.0, channels, ignored)


def _bind_time(table: Table, mapping: LogMapping) -> Binding | None:
    if TIME in mapping.channels:
        request = mapping.channels[TIME]
    else:
        request = _si_request((TIME,)) if TIME in table.names else None
        if request is not None and mapping.rate_hz is None:
            refuse_other_clock(table)
            return _bind_default(TIME, request.columns, table)
    if request is not None and mapping.rate_hz is not None:
        raise LogError(
            "the log has a time column and the mapping declares rate_hz as well",
            evidence={"time": request.columns[0], "rate_hz": mapping.rate_hz},
            remedy='keep the stamps and drop rate_hz, or set "time": null to use the uniform clock',
        )
    if request is not None:
        return _bind_request(TIME, request, table)
    if mapping.rate_hz is None:
        raise missing_error(
            TIME,
            [TIME],
            table,
            'name the time column, or declare the rate if the samples are uniform: {"rate_hz": 250}',
        )
    return None


def _bind_channel(channel: Channel, table: Table, mapping: LogMapping) -> Binding | None:
    if channel.name in mapping.channels:
        request = mapping.channels[channel.name]
        return None if request is None else _bind_request(channel.name, request, table)
    columns = _default_columns(channel, table, spare=_is_spare(channel, table.names, mapping))
    return _bind_default(channel.name, columns, table) if columns else None


def _bind_default(channel: str, columns: tuple[str, ...], table: Table) -> Binding:
    """Bind default names, which are SI; refuse them where the file itself says otherwise."""
    request = _si_request(columns)
    for column in columns:
        unit = unit_called(channel, table.units.get(column, ""))
        if unit is not None and (UNITS[channel][unit].factor, UNITS[channel][unit].offset) != (1.0, 0.0):
            raise contradiction_error(channel, columns, unit)
    return _bind_request(channel, request, table)


def _is_spare(channel: Channel, names: Collection[str], mapping: LogMapping) -> bool:
    """Tell whether a log may lack a channel: no computation needs it, or there is another effort."""
    others = (CHANNELS[effort] for effort in EFFORTS if channel.name in EFFORTS and effort != channel.name)
    there = (mapping.channels.get(other.name, f"{other.prefix}_1" in names) for other in others)
    return channel.need in UNNEEDED or any(there)


def _is_other(bound: Binding, channels: Sequence[Binding], mapping: LogMapping) -> bool:
    """Tell whether the default names of a channel that the log may lack mean something else.

    They are mapped to another channel, or are not one per joint.
    """
    joints = len(channels[0].columns)
    if bound.name in mapping.channels or not _is_replaced(bound, channels, joints):
        return False
    mapped = {column for request in mapping.channels.values() if request for column in request.columns}
    return bool(mapped & set(bound.columns)) or len(bound.columns) != joints


def _is_replaced(bound: Binding, channels: Sequence[Binding], joints: int) -> bool:
    """Tell whether no computation needs a channel, or another effort has one column per joint."""
    others = {own.name for own in channels if own is not bound and len(own.columns) == joints}
    return CHANNELS[bound.name].need in UNNEEDED or (bound.name in EFFORTS and bool(others & set(EFFORTS)))


def _default_columns(channel: Channel, table: Table, *, spare: bool) -> tuple[str, ...]:
    """Find `q_1` to `q_n`, or the single `q` of a one-joint log; nothing where some of a spare one lack."""
    prefix = channel.prefix
    _refuse_count_from_zero(channel, table)
    numbered = [name for name in table.names if re.fullmatch(f"{prefix}_[1-9][0-9]{{0,3}}", name)]
    if not numbered:
        return (prefix,) if prefix in table.names else ()
    highest = max(int(name[len(prefix) + 1 :]) for name in numbered)
    wanted = _default_names(channel, highest)
    if len(numbered) < highest:
        if spare:
            return ()
        raise missing_error(channel.name, wanted, table, f"log {channel.name} of every joint; {OTHER_NAME}")
    return tuple(wanted)


def _default_names(channel: Channel, joints: int) -> list[str]:
    return [f"{channel.prefix}_{number}" for number in range(1, joints + 1)]


def _refuse_count_from_zero(channel: Channel, table: Table) -> None:
    prefix = channel.prefix
    if channel.need in ("always", "effort") and f"{prefix}_0" in table.names:
        raise LogError(
            f"the columns of {channel.name} are counted from 0, and default names from 1",
            evidence={"columns": [name for name in table.names if re.fullmatch(f"{prefix}_[0-9]+", name)]},
            remedy=f"map them in the order of the joints, or rename them {prefix}_1, {prefix}_2, ...",
        )


def _si_request(columns: tuple[str, ...]) -> ChannelRequest:
    count = len(columns)
    return ChannelRequest(columns, ("",) * count, (1.0,) * count, (0.0,) * count)


def _bind_request(channel: str, request: ChannelRequest, table: Table) -> Binding:
    """Turn a request into gains; default names are SI, others must have declared their unit."""
    if absent_names(request.columns, table.names):
        raise missing_error(channel, list(request.columns), table, "map columns that the file has")
    default = re.compile(CHANNELS[channel].prefix + ("(_[1-9][0-9]*)?" if channel != TIME else ""))
    named = zip(request.columns, request.units, strict=True)
    if any(not unit and not default.fullmatch(name) for name, unit in named):
        raise unit_error(channel, request, table)
    return _binding(channel, request)


def _binding(channel: str, request: ChannelRequest) -> Binding:
    named = tuple(unit or next(iter(UNITS[channel])) for unit in request.units)
    units = [UNITS[channel][unit] for unit in named]
    scales = tuple(unit.factor * scale for unit, scale in zip(units, request.scales, strict=True))
    offsets = zip(units, request.offsets, strict=True)
    shifts = tuple(unit.factor * (offset + unit.offset) for unit, offset in offsets)
    return Binding(channel, request.columns, scales, shifts, named, request.linkage)


def _require(table: Table, channels: Sequence[Binding]) -> None:
    names = [channel.name for channel in channels]
    if "position" not in names:
        remedy = f"map the positions with their unit; {OTHER_FILE}"
        raise missing_error("position", ["q_1", "q_2", "..."], table, remedy)
    if not set(EFFORTS) & set(names):
        raise missing_error(
            EFFORTS[0],
            [name for effort in EFFORTS for name in (f"{CHANNELS[effort].prefix}_1", "...")],
            table,
            f"log the torque of every joint, or its motor current, with the positions; {OTHER_NAME}; "
            f"{OTHER_FILE}",
        )


def _one_column_per_joint(channels: Sequence[Binding]) -> None:
    counts = {channel.name: len(channel.columns) for channel in channels}
    usual = max(counts.values(), key=lambda count: (list(counts.values()).count(count), count))
    odd = next((channel for channel in channels if len(channel.columns) != usual), None)
    if odd is None:
        return
    wanted = _default_names(CHANNELS[odd.name], usual)
    evidence: dict[str, object] = {"columns": counts}
    if set(odd.columns) < set(wanted):
        evidence["absent"] = absent_names(wanted, odd.columns)
    remedy = f"log {odd.name} of every joint; {OTHER_NAME}"
    if _is_dispensable(odd.name, counts):
        remedy += f'; "{odd.name}": null in the mapping leaves it out'
    raise LogError(f"{odd.name} does not have one column per joint", evidence=evidence, remedy=remedy)


def _is_dispensable(channel: str, present: Collection[str]) -> bool:
    need = CHANNELS[channel].need
    return need in UNNEEDED or (need == "effort" and set(EFFORTS) <= set(present))


def _used_columns(channels: Sequence[Binding]) -> list[str]:
    """Give the columns in use; refuse one that serves two channels."""
    columns = [column for channel in channels for column in channel.columns]
    twice = sorted({column for column in columns if columns.count(column) > 1})
    if twice:
        raise LogError(
            "a column serves two channels",
            evidence={"columns": twice},
            remedy="map every column to one channel",
        )
    return columns
