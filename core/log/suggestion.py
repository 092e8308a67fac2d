"""Suggest a mapping for a file whose columns go by other names; whoever knows the recorder confirms it.

A profile that fits says it best. Otherwise columns which differ in a number only are taken for the joints of
one channel, their words tell which, and their sizes tell the unit. Nothing is read by a suggestion: it is
shown.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import LogError
from .formats.table import Table
from .layout import Layout
from .mapping import RATE
from .model import Defect
from .plausible_units import plausible_readings
from .profiles import PROFILE, PROFILES, fill_in
from .units import TIME, UNITS

WORDS: Mapping[str, tuple[str, ...]] = {
    "velocity": ("qd", "dq", "vel", "velocity", "velocities", "speed", "omega", "qdot"),
    "torque": ("tau", "torque", "torques", "trq", "effort", "moment", "mom", "tq"),
    "current": ("current", "currents", "cur", "curr", "amp", "amps", "i"),
    "temperature": ("temperature", "temp"),
    "position": ("q", "pos", "position", "positions", "angle", "angles", "theta", "joint", "ang"),
}
"""Words in a column's name by channel, the more telling channel first."""
TIME_WORDS = ("time", "t", "timestamp", "stamp", "sec", "seconds", "ms", "clock", "tick")
UNKNOWN = "?"
IMPLAUSIBLE = "implausible_unit"


def suggested_mapping(table: Table) -> dict[str, object] | None:
    """Give a mapping that fits the names of the columns; None where they tell too little.

    Units are the most plausible by size, or `UNKNOWN` where the size tells none; so is the rate of a log
    without a clock.

    Examples
    --------
    >>> import numpy as np
    >>> from veritorque.core.log.formats.table import MemoryTable
    >>> columns = {"t": 0.004 * np.arange(9.0), "pos1": np.full(9, 90.0), "trq1": np.full(9, 2.5)}
    >>> suggested_mapping(MemoryTable(columns))["position"]
    {'columns': ['pos1'], 'unit': 'deg'}
    """
    profile = _profile(table.names)
    if profile is not None:
        return {PROFILE: profile} | _own_clock(profile, table)
    mapping: dict[str, dict[str, Any]] = {}
    time = next((name for name in table.names if set(_words(name)) & set(TIME_WORDS)), None)
    for stem, columns in _families(table.names).items():
        channel = _channel(stem)
        if channel is not None and channel not in mapping:
            mapping[channel] = {"columns": columns, "unit": _unit(channel, table, columns[0])}
    if not _is_whole(mapping):
        return None
    clock = {RATE: UNKNOWN} if time is None else {TIME: {"column": time, "unit": _unit(TIME, table, time)}}
    return clock | {name: mapping[name] for name in UNITS if name in mapping}


def suggested_units(table: Table, layout: Layout, defects: Sequence[Defect]) -> dict[str, object] | None:
    """Give the mapping by which channels of implausible size would be of a plausible one; None if none is."""
    channels = {channel.name: channel for channel in (layout.time, *layout.channels) if channel is not None}
    mapping: dict[str, object] = {}
    for defect in defects:
        channel = channels.get(defect.channel)
        if defect.kind != IMPLAUSIBLE or channel is None or channel.name in mapping:
            continue
        unit = _unit(channel.name, table, channel.columns[(defect.joint or 1) - 1])
        if unit not in (UNKNOWN, *channel.units):
            columns = {"column": channel.columns[0]} if channel.name == TIME else {"columns": channel.columns}
            mapping[channel.name] = columns | {"unit": unit}
    return mapping or None


def _is_whole(mapping: Mapping[str, Mapping[str, Sequence[str]]]) -> bool:
    """Tell whether position and an effort are there, with one column per joint each."""
    efforts = [mapping[name] for name in ("torque", "current") if name in mapping]
    joints = {len(one["columns"]) for one in mapping.values()}
    return "position" in mapping and bool(efforts) and len(joints) == 1


def _profile(names: Sequence[str]) -> str | None:
    """Find a recorder whose names these are; the units that it leaves open are asked for when it is tried."""
    for name in PROFILES:
        try:
            filled = fill_in({PROFILE: name}, names)
        except LogError:  # the order of the joints is not known, and would have to be told as well
            continue
        if isinstance(filled, dict) and {"position"} < filled.keys() & UNITS.keys():
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


def _families(names: Sequence[str]) -> dict[str, list[str]]:
    """Gather columns that differ in their last number only, in the order of that number."""
    families: dict[str, list[tuple[int, str]]] = {}
    for name in names:
        numbers = list(re.finditer(r"\d+", name))
        if numbers:
            last = numbers[-1]
            stem = f"{name[: last.start()]} {name[last.end() :]}"
            families.setdefault(stem, []).append((int(last.group()), name))
    return {stem: [name for _, name in sorted(found)] for stem, found in families.items()}


def _channel(stem: str) -> str | None:
    words = set(_words(stem))
    return next((channel for channel, known in WORDS.items() if words & set(known)), None)


def _words(name: str) -> list[str]:
    """Cut a name at its signs, numbers and capitals."""
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)]


def _unit(channel: str, table: Table, column: str) -> str:
    try:
        block = next(iter(table.batches([column])), None)
    except LogError:
        return UNKNOWN
    plausible = [] if block is None else plausible_readings(channel, block[0])
    return plausible[0].split(":")[0] if plausible else UNKNOWN
