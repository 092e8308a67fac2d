"""Read the mapping, a JSON object that says which column is which channel, in which unit.

It is strict: what it does not know it refuses, with the list of what it knows, so that a misspelt key never
passes as absent.

    {"time": {"column": "t", "unit": "ms"},
     "position": {"columns": ["a", "b"], "unit": "counts", "scale": 1e-4, "offset": [0.0, 1.57]},
     "torque": {"columns": ["m1", "m2"], "unit": "N m"}, "temperature": null, "rate_hz": 250.0}

A value becomes SI as unit(scale * value + offset): `scale` and `offset` lead to the declared unit (with
`counts`: to rad or N m) and the unit leads to SI. `linkage` then adds positions of joints to each other, as
`[{"joint": 3, "adds": 2}]` where axis 3 is counted from the horizontal. `null` leaves a channel out although
its default names are there.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from ...errors import LogError
from ...fields import Fields
from ..channels import CHANNELS, EFFORTS, TIME, UNITS
from .linkage import LARGEST_FACTOR, LINKED, Added, are_told_apart

RATE = "rate_hz"
MAX_MAPPED_COLUMNS = 64


class MappingFields(Fields):
    """Read the fields of an object of a mapping."""

    error = LogError
    largest = math.inf
    holds = "found"


MAPPING_FIELDS = {
    **{
        channel.name: f"null, or an object with {'columns' if channel.per_joint else 'column'} and unit"
        for channel in CHANNELS.values()
    },
    RATE: "the rate of uniform samples in Hz, above 0",
}
_CHANNEL_FIELDS = {
    channel: (
        {"column": "a name"}
        if channel == TIME
        else {
            "columns": f"a list of 1 to {MAX_MAPPED_COLUMNS} names",
            "scale": "a number other than 0, or a list with one per column (of counts, %: 1 in SI); "
            "a 0 in a list leaves a joint's torque or current out",
            "offset": "a number, or a list with one per column",
        }
    )
    | ({"linkage": "a list of objects with joint, adds and factor"} if channel in LINKED else {})
    | {"unit": f"one of {', '.join(units)}, or a list with one per column"}
    for channel, units in UNITS.items()
}
_LINKAGE_FIELDS = {
    "joint": "the number of a joint, from 1",
    "adds": "the number of the joint whose value, as it was read, is added",
    "factor": f"a number other than 0 between -{LARGEST_FACTOR:g} and {LARGEST_FACTOR:g}, 1 by default",
}


@dataclass(frozen=True)
class ChannelRequest:
    """Ask for one channel: its columns, each with unit, scale and offset; an empty unit is not declared."""

    columns: tuple[str, ...]
    units: tuple[str, ...]
    scales: tuple[float, ...]
    offsets: tuple[float, ...]
    linkage: tuple[Added, ...] = ()
    """What is added to each joint's values; empty where nothing is."""


@dataclass(frozen=True)
class LogMapping:
    """Carry what is asked for by channel: None leaves it out, and an absent one goes by its default names."""

    channels: Mapping[str, ChannelRequest | None] = field(default_factory=dict)
    rate_hz: float | None = None


def parse_mapping(document: object) -> LogMapping:
    """Check a mapping and give it a type.

    Parameters
    ----------
    document
        The decoded JSON object; None is the same as an empty one.

    Raises
    ------
    LogError
        If a key, unit or value is not one that a mapping knows.

    Examples
    --------
    >>> parse_mapping({"time": {"column": "t", "unit": "ms"}}).channels["time"].units
    ('ms',)
    """
    if document is None:
        return LogMapping()
    top = MappingFields(document, "the mapping", "/mapping", MAPPING_FIELDS)
    asked = {name: _channel(top, name) if top.has(name) else None for name in CHANNELS if name in top.value}
    _each_column_once(asked)
    return LogMapping(asked, top.optional_number(RATE, positive=True))


def by_name(document: object, names: Sequence[str]) -> object:
    """Turn numbers of columns, counted from 1, into their names; all else is given back as it is.

    Examples
    --------
    >>> by_name({"position": {"columns": [2, 3], "unit": "rad"}}, ["t", "a", "b"])["position"]["columns"]
    ['a', 'b']
    """
    if not isinstance(document, Mapping):
        return document
    return {
        key: {
            field: _named(value, names) if field in ("column", "columns") else value
            for field, value in request.items()
        }
        if isinstance(request, Mapping)
        else request
        for key, request in document.items()
    }


def _named(value: object, names: Sequence[str]) -> object:
    if isinstance(value, list | tuple):
        return [_named(item, names) for item in value]
    if not isinstance(value, int) or isinstance(value, bool):
        return value
    if not 1 <= value <= len(names):
        raise LogError(
            f"the mapping names column {value}, which the file does not have",
            evidence={"column": value, "columns": len(names)},
            remedy="number columns from 1, or name them",
        )
    return names[value - 1]


def _channel(top: Fields, channel: str) -> ChannelRequest:
    fields = top.inner(channel, _CHANNEL_FIELDS[channel])
    columns = _columns(fields)
    units = _units(fields, UNITS[channel], len(columns))
    if any(unit and UNITS[channel][unit].needs_scale for unit in units):
        fields.required("scale")
    scales = _numbers(fields, "scale", 1.0, len(columns))
    if 0.0 in scales and (channel not in EFFORTS or not any(scales)):
        fields.refuse("scale", "is zero")
    offsets = _numbers(fields, "offset", 0.0, len(columns))
    return ChannelRequest(columns, units, scales, offsets, _linkage(fields, len(columns)))


def _linkage(fields: Fields, count: int) -> tuple[Added, ...]:
    """Read what is added to the values of each joint."""
    if not fields.has("linkage"):
        return ()
    added: list[Added] = [()] * count
    for place, item in enumerate(fields.items("linkage", most=count**2)):
        pointer = f"{fields.pointer}/linkage/{place}"
        own = MappingFields(item, f"linkage of {fields.where}", pointer, _LINKAGE_FIELDS)
        joint, other = (own.integer(name, (1, count)) for name in ("joint", "adds"))
        factor = own.number("factor", 1.0)
        if not 0.0 < abs(factor) <= LARGEST_FACTOR:
            own.refuse("factor", "is out of range")
        added[joint - 1] += ((other - 1, factor),)
    if not are_told_apart(added):
        fields.refuse("linkage", "leaves a joint without values of its own")
    return tuple(added)


def _columns(fields: Fields) -> tuple[str, ...]:
    name = next(iter(fields.meanings))
    value = fields.required(name)
    columns = [value] if name == "column" else fields.items(name, least=1, most=MAX_MAPPED_COLUMNS)
    if not all(isinstance(column, str) for column in columns):
        fields.refuse(name, "holds something else than names")
    return tuple(map(str, columns))


def _units(fields: Fields, known: Collection[str], count: int) -> tuple[str, ...]:
    if not fields.has("unit"):
        return ("",) * count
    value = fields.value["unit"]
    units = tuple(value) if isinstance(value, list | tuple) else (value,) * count
    if len(units) != count or not all(isinstance(unit, str) and unit in known for unit in units):
        fields.refuse("unit", "is not one that is known, or not one per column", known=list(known))
    return units


def _numbers(fields: Fields, name: str, default: float, count: int) -> tuple[float, ...]:
    if isinstance(fields.value.get(name), list | tuple):
        return tuple(fields.numbers(name, count).tolist())
    return (fields.number(name, default),) * count


def _each_column_once(channels: Mapping[str, ChannelRequest | None]) -> None:
    columns = [column for request in channels.values() if request for column in request.columns]
    twice = next((column for column in columns if columns.count(column) > 1), None)
    if twice is not None:
        raise LogError(
            f"the mapping names the column {twice!r} twice", evidence={"column": twice}, remedy="name it once"
        )
