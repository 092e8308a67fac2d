"""Suggest a mapping for a file whose columns have other names; the user confirms it.

A profile that fits comes first. Otherwise columns that differ in a number only are taken for the joints of
one channel. Words in the names give the channel, sizes the unit. A suggestion is shown, never applied.
"""

import re
from collections.abc import Collection, Mapping, Sequence

from ..errors import LogError
from .channels import CHANNELS, EFFORTS, JOINT_CHANNELS, REFERENCE_WORDS, TIME
from .formats.table import Table
from .layout import Binding, Layout
from .mapping import RATE
from .model import Defect
from .plausible_units import readings_by_column
from .profiles import PROFILE, PROFILES, fill_in

UNKNOWN = "?"
IMPLAUSIBLE = "implausible_unit"


def suggest_mapping(table: Table) -> dict[str, object] | None:
    """Give a mapping that fits the names of the columns; None where the names are not enough.

    Units are the most plausible by size, or `UNKNOWN` where no unit fits the size; so is the rate of a log
    without a clock.

    Examples
    --------
    >>> import numpy as np
    >>> from veritorque.core.log.formats.table import MemoryTable
    >>> columns = {"t": 0.004 * np.arange(9.0), "pos1": np.full(9, 90.0), "trq1": np.full(9, 2.5)}
    >>> suggest_mapping(MemoryTable(columns))["position"]
    {'columns': ['pos1'], 'unit': 'deg'}
    """
    profile = _profile(table.names)
    if profile is not None:
        return {PROFILE: profile} | _own_clock(profile, table)
    mapping = {
        channel: {"columns": columns, "unit": _unit(channel, table, columns[0])}
        for channel, columns in _joint_columns(table.names).items()
    }
    if not _is_whole(mapping):
        return None
    return _clock(table) | {name: mapping[name] for name in CHANNELS if name in mapping}


def _clock(table: Table) -> dict[str, object]:
    time = next((name for name in table.names if _name_words(name) & set(CHANNELS[TIME].words)), None)
    return {RATE: UNKNOWN} if time is None else {TIME: {"column": time, "unit": _unit(TIME, table, time)}}


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
    unit = _unit(channel.name, table, channel.columns[(joint or 1) - 1])
    if unit in (UNKNOWN, *channel.units):
        return {}
    if channel.name == TIME:
        return {"column": channel.columns[0], "unit": unit}
    return {"columns": channel.columns, "unit": unit}


def _joint_columns(names: Sequence[str]) -> dict[str, list[str]]:
    """Choose columns for every channel; measured ones first, then references that are one per joint."""
    families = _column_families(names)
    found: dict[str, list[str]] = {}
    for stem in sorted(families, key=lambda name: bool(_name_words(name) & REFERENCE_WORDS)):
        channel, columns = _channel(stem, found), families[stem]
        if channel is None or channel in found:
            continue
        if CHANNELS[channel].need != "reference" or len(columns) == len(found.get("position", ())):
            found[channel] = columns
    return found


def _is_whole(mapping: Mapping[str, Mapping[str, Sequence[str]]]) -> bool:
    """Tell whether position and an effort are there, with one column per joint each."""
    joints = {len(channel["columns"]) for channel in mapping.values()}
    return "position" in mapping and bool(mapping.keys() & set(EFFORTS)) and len(joints) == 1


def _profile(names: Sequence[str]) -> str | None:
    """Find a recorder whose names these are; the units that it leaves open are asked for when it is tried."""
    for name in PROFILES:
        try:
            filled = fill_in({PROFILE: name}, names)
        except LogError:  # the order of the joints is not known, and would have to be given as well
            continue
        if isinstance(filled, dict) and {"position"} < filled.keys() & CHANNELS.keys():
            return name
    return None


def _own_clock(profile: str, table: Table) -> dict[str, object]:
    """Give the clock where its steps are not of the size that the profile's unit makes of them."""
    filled = fill_in({PROFILE: profile}, table.names)
    clock = filled.get(TIME) if isinstance(filled, dict) else None
    if not isinstance(clock, dict) or "unit" not in clock:
        return {}
    unit = _unit(TIME, table, clock["column"])
    return {} if unit in (UNKNOWN, clock["unit"]) else {TIME: clock | {"unit": unit}}


def _column_families(names: Sequence[str]) -> dict[str, list[str]]:
    """Gather columns that differ in their last number only, in the order of that number."""
    families: dict[str, list[tuple[int, str]]] = {}
    for name in names:
        numbers = list(re.finditer(r"\d+", name))
        if numbers:
            last = numbers[-1]
            stem = f"{name[: last.start()]} {name[last.end() :]}"
            families.setdefault(stem, []).append((int(last.group()), name))
    return {stem: [name for _, name in sorted(found)] for stem, found in families.items()}


def _channel(stem: str, known: Collection[str]) -> str | None:
    """Find the channel of a name; a reference stands for what was measured where nothing else does."""
    words = _name_words(stem)
    by_trust = sorted(JOINT_CHANNELS, key=lambda channel: channel.name == "position")  # "joint" says least
    own = list(filter(lambda channel: not words.isdisjoint(channel.words), by_trust))
    measured = next((channel for channel in own if channel.need != "reference"), None)
    if measured is None:
        return own[0].name if own else None
    if not words & REFERENCE_WORDS or (measured.need != "optional" and measured.name not in known):
        return measured.name
    return next((channel.name for channel in JOINT_CHANNELS if channel.reference_to == measured.name), None)


def _name_words(name: str) -> set[str]:
    """Cut a name at its signs, numbers and capitals."""
    return {word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)}


def _unit(channel: str, table: Table, column: str) -> str:
    plausible = readings_by_column(channel, [column], table)
    return plausible[column][0].split(":")[0] if plausible else UNKNOWN
