"""Suggest a mapping for a file whose columns have other names; the user confirms it.

A profile that fits comes first. Otherwise columns that differ in a number only, or in a joint's name, are
taken for the joints of one channel. Words in the names give the channel and, where they say one, the unit;
else sizes do. A suggestion is shown, never applied.
"""

from collections.abc import Collection, Mapping, Sequence
from itertools import chain

import numpy as np

from ...errors import LogError
from ..channels import CHANNELS, EFFORTS, TIME, UNITS
from ..formats.table import Table
from ..model import Defect
from .binding import Binding
from .blocks import unnamed_channels
from .families import (
    MOTOR,
    along_arm,
    arm_of,
    by_plainness,
    channel_by_unit,
    channel_of,
    clocks,
    name_words,
    named_families,
    numbered_families,
    single_families,
    tells_a_part,
)
from .layout import Layout
from .mapping import RATE
from .named_units import unit_called, unit_in_name
from .plausible_units import readings_by_column
from .profiles import PROFILE, PROFILES, fill_in

UNKNOWN = "?"
MOTOR_SIDE = ("position", "velocity", "torque")
IMPLAUSIBLE = "implausible_unit"


def suggest_mappings(table: Table, prismatic: Collection[int] = ()) -> list[dict[str, object]]:
    """Give the mapping that fits the names of the columns, or one for each arm that the file holds.

    None is given where the names are not enough. Units are those that names or the file say, else the most
    plausible by size, or `UNKNOWN` where no unit fits the size; so is the rate of a log without a clock, and
    what one count or one per cent is.

    Parameters
    ----------
    prismatic
        Joints, from 1, that are known to be prismatic.

    Examples
    --------
    >>> from veritorque.core.log.formats.table import MemoryTable
    >>> waves = {f"{name}{joint}": np.full(9, 0.4) for name in ("pos", "force") for joint in (1, 2)}
    >>> suggested = suggest_mappings(MemoryTable({"t": 0.004 * np.arange(9.0)} | waves), prismatic=[2])
    >>> suggested[0]["position"]["unit"], suggested[0]["torque"]["unit"]
    (['rad', 'm'], ['N m', 'N'])
    >>> columns = {"t": 0.004 * np.arange(9.0), "pos1": np.full(9, 90.0), "trq1": np.full(9, 2.5)}
    >>> suggest_mappings(MemoryTable(columns))[0]["position"]
    {'columns': ['pos1'], 'unit': 'deg'}
    """
    profile = _profile(table.names)
    if profile is not None:
        return [{PROFILE: profile} | _own_clock(profile, table) | _open_units(profile, table, prismatic)]
    unnamed = unnamed_channels(table)
    whole = [unnamed] if unnamed else _named_channels(table.names)
    return [_clock(channels, table) | _requests(channels, table, prismatic) for channels in whole]


def _named_channels(names: Sequence[str]) -> list[dict[str, list[str]]]:
    """Give the columns of every channel, for each arm that the names tell of."""
    numbered = numbered_families(names)
    arms = [_channels(own) for own in _by_arm(numbered)]
    whole = [channels for channels in arms if _is_whole(channels)]
    if len(whole) > 1:
        return whole
    by_part = {stem: along_arm(columns) for stem, columns in named_families(names).items()}
    of_one = {stem: columns for stem, columns in numbered.items() if not tells_a_part(stem)}
    found = map(_channels, (of_one, by_part, numbered, single_families(names)))
    return [channels for channels in found if _is_whole(channels)][:1]


def explained(error: LogError, table: Table) -> LogError:
    """Say of a file that holds positions alone, or efforts alone, that the others are to be joined to it.

    A clock of another name would be asked for first, and be of no use.
    """
    half = _half(table)
    if half is None or error.evidence.get("looked_for") != [TIME]:
        return error
    there, absent = half
    return LogError(
        f"the file holds {there}, and no {absent}",
        evidence=error.evidence,
        remedy=f"join it with the file of the {absent} of the same run: veritorque logs join THIS OTHER "
        "-o run.parquet; where they are in this file, map their columns",
    )


def _half(table: Table) -> tuple[str, str] | None:
    """Tell what a file holds and what it lacks; None where its names say neither or both."""
    families = numbered_families(table.names) | single_families(table.names)
    named = set(map(_told, families)) - {None}
    recorded = (fill_in({PROFILE: name}, table.names) for name in PROFILES if _is_ordered(name, table.names))
    named |= {channel for filled in recorded if isinstance(filled, dict) for channel in filled}
    efforts = {*EFFORTS, "torque_ref"} & named
    if bool(efforts) == ("position" in named):
        return None
    return ("positions", "torque or current") if not efforts else ("torque or current", "positions")


def _told(stem: str) -> str | None:
    """Tell a channel by the words of a name, else by its unit."""
    return channel_of(stem, ()) or channel_by_unit(stem)


def _by_arm(families: Mapping[str, list[str]]) -> list[dict[str, list[str]]]:
    """Part families by the words of their names that tell no quantity."""
    arms: dict[frozenset[str], dict[str, list[str]]] = {}
    for stem, columns in families.items():
        arms.setdefault(arm_of(stem), {})[stem] = columns
    return list(arms.values())


def _requests(
    channels: Mapping[str, list[str]], table: Table, prismatic: Collection[int]
) -> dict[str, object]:
    return {
        name: {"columns": channels[name]} | _declared(name, table, channels[name], prismatic)
        for name in CHANNELS
        if name in channels and name != TIME
    }


def _declared(
    channel: str, table: Table, columns: Sequence[str], prismatic: Collection[int] = ()
) -> dict[str, object]:
    """Give the unit of columns, or that of each, and leave open what one of it is where a mapping has to say.

    What is named after the motor is on its side of a gear, whose ratio only the user knows.
    """
    known = UNITS[channel]
    geared = channel in MOTOR_SIDE and MOTOR in name_words(columns[0])
    usual = next(iter(known)) if geared else _unit(channel, table, columns[0])
    units = [
        _said_unit(channel, table, column) or (_unit_of_slide(channel, table, column) if slides else usual)
        for column, slides in zip(columns, _are_prismatic(columns, prismatic), strict=True)
    ]
    is_open = geared or any(known[unit].needs_scale for unit in known.keys() & set(units))
    declared: dict[str, object] = {"unit": units if len(set(units)) > 1 else units[0]}
    return declared | ({"scale": UNKNOWN} if is_open else {})


def _are_prismatic(columns: Sequence[str], prismatic: Collection[int]) -> list[bool]:
    """Tell of each joint's column whether the joint is known to be prismatic."""
    return [joint in prismatic for joint in range(1, len(columns) + 1)]


def _unit_of_slide(channel: str, table: Table, column: str) -> str:
    """Give the unit of a prismatic joint by the size of its column, among those that such a joint has."""
    quantity = CHANNELS[channel].quantity
    own = {unit.name for unit in quantity.units if unit.prismatic or unit.needs_scale}
    if quantity.prismatic == quantity.revolute:
        return _unit(channel, table, column)
    readings = readings_by_column(channel, [column], table).get(column, [])
    return next((unit for unit in map(_unit_read, readings) if unit in own), quantity.prismatic)


def _unit_read(reading: str) -> str:
    return reading.split(":", maxsplit=1)[0]


def _open_units(profile: str, table: Table, prismatic: Collection[int]) -> dict[str, object]:
    """Give the units that the recorder does not fix."""
    filled = fill_in({PROFILE: profile}, table.names)
    requests = filled.items() if isinstance(filled, dict) else ()
    return {
        name: _declared(name, table, request["columns"], prismatic)
        for name, request in requests
        if isinstance(request, dict) and "columns" in request and "unit" not in request
    }


def _clock(channels: Mapping[str, Sequence[str]], table: Table) -> dict[str, object]:
    """Give the clock by its name, else the first column that only grows, else leave the rate open."""
    called = (*channels.get(TIME, ()), *clocks(table.names))
    stamps = next(iter(called), None) or _growing(channels, table)
    return (
        {RATE: UNKNOWN} if stamps is None else {TIME: {"column": stamps, "unit": _unit(TIME, table, stamps)}}
    )


def _growing(channels: Mapping[str, Sequence[str]], table: Table) -> str | None:
    """Find a column that grows from row to row as a clock does, and does not only count the rows."""
    used = set(chain(*channels.values()))
    for name in table.names:
        if name in used or name in table.texts or not readings_by_column(TIME, [name], table):
            continue
        steps = np.diff(next(iter(table.batches([name])))[0])
        if np.all(steps > 0.0) and np.any(steps != 1.0):
            return name
    return None


def suggest_units(table: Table, layout: Layout, defects: Sequence[Defect]) -> dict[str, object] | None:
    """Give the mapping by which channels of implausible size would be of a plausible one; None if none is."""
    channels = {channel.name: channel for channel in filter(None, (layout.time, *layout.channels))}
    mapping: dict[str, object] = {}
    for defect in defects:
        channel = channels.get(defect.channel)
        if defect.kind != IMPLAUSIBLE or channel is None or channel.name in mapping:
            continue
        if request := _in_plausible_unit(channel, defect.joint, table):
            mapping[channel.name] = request
    return mapping or None


def _in_plausible_unit(channel: Binding, joint: int | None, table: Table) -> dict[str, object]:
    """Give the request for a channel in the unit that fits a joint's column; empty where no other fits."""
    declared = _declared(channel.name, table, [channel.columns[(joint or 1) - 1]])
    if declared["unit"] in (UNKNOWN, *channel.units):
        return {}
    if channel.name == TIME:
        return {"column": channel.columns[0]} | declared
    return {"columns": channel.columns} | declared


def _channels(families: Mapping[str, list[str]]) -> dict[str, list[str]]:
    """Choose columns for every channel; measured and plain ones first, references where one per joint."""
    found: dict[str, list[str]] = {}
    for stem in sorted(families, key=by_plainness):
        channel, columns = channel_of(stem, found), families[stem]
        if channel is None or channel in found:
            continue
        if CHANNELS[channel].need != "reference" or len(columns) == len(found.get("position", ())):
            found[channel] = columns
    by_unit = ((channel_by_unit(stem), stem) for stem in families if channel_of(stem, ()) is None)
    return {channel: families[stem] for channel, stem in by_unit if channel is not None} | found


def _is_whole(channels: Mapping[str, list[str]]) -> bool:
    """Tell whether position and an effort are there, with one column per joint each."""
    joints = {len(columns) for columns in channels.values()}
    return "position" in channels and bool(channels.keys() & set(EFFORTS)) and len(joints) == 1


def _profile(names: Sequence[str]) -> str | None:
    """Find a recorder whose names these are; the units that it leaves open are asked for when it is tried."""
    for name in PROFILES:
        if not _is_ordered(name, names):
            continue
        filled = fill_in({PROFILE: name}, names)
        if isinstance(filled, dict) and "position" in filled and not filled.keys().isdisjoint(EFFORTS):
            return name
    return None


def _is_ordered(profile: str, names: Sequence[str]) -> bool:
    """Tell whether the order of a profile's joints is known, which would have to be given as well."""
    try:
        fill_in({PROFILE: profile}, names)
    except LogError:
        return False
    return True


def _own_clock(profile: str, table: Table) -> dict[str, object]:
    """Give the clock where the file calls it otherwise, the profile leaves its unit open, or sizes differ."""
    filled = fill_in({PROFILE: profile}, table.names)
    channels = filled if isinstance(filled, dict) else {}
    clock = channels.get(TIME)
    if not isinstance(clock, dict):
        return _clock({name: request["columns"] for name, request in channels.items()}, table)
    unit = _unit(TIME, table, clock["column"])
    return {} if unit in (UNKNOWN, clock.get("unit")) else {TIME: clock | {"unit": unit}}


def _unit(channel: str, table: Table, column: str) -> str:
    said = _said_unit(channel, table, column)
    if said is not None:
        return said
    plausible = readings_by_column(channel, [column], table)
    return _unit_read(plausible[column][0]) if plausible else UNKNOWN


def _said_unit(channel: str, table: Table, column: str) -> str | None:
    return unit_called(channel, table.units.get(column, "")) or unit_in_name(channel, column)
