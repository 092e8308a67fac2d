"""Read the mapping, a JSON object that says which column is which channel, in which unit.

It is strict: what it does not know it refuses, with the list of what it knows, so that a misspelt key never
passes as absent.

    {"time": {"column": "t", "unit": "ms"},
     "position": {"columns": ["a", "b"], "unit": "counts", "scale": 1e-4, "offset": [0.0, 1.57]},
     "torque": {"columns": ["m1", "m2"], "unit": "N m"}, "temperature": null, "rate_hz": 250.0}

A value becomes SI as unit(scale * value + offset): `scale` and `offset` lead to the declared unit (with
`counts`: to rad or N m) and the unit leads to SI. `null` leaves a channel out although its default names are
there.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches

from ..errors import LogError
from .channels import TIME, UNITS

RATE = "rate_hz"
MAX_MAPPED_COLUMNS = 64


@dataclass(frozen=True)
class ChannelRequest:
    """Ask for one channel: its columns, each with unit, scale and offset; an empty unit is not declared."""

    columns: tuple[str, ...]
    units: tuple[str, ...]
    scales: tuple[float, ...]
    offsets: tuple[float, ...]


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
    entries = _object("the mapping", document)
    _known_keys("the mapping", entries, (*UNITS, RATE))
    rate = entries.get(RATE)
    channels = {
        channel: None if entries[channel] is None else _channel(channel, entries[channel])
        for channel in UNITS
        if channel in entries
    }
    _each_column_once(channels)
    return LogMapping(channels, None if rate is None else _rate(rate))


def _channel(channel: str, entry: object) -> ChannelRequest:
    fields = _object(channel, entry)
    listed = "column" if channel == TIME else "columns"
    _known_keys(channel, fields, (listed, "unit") if channel == TIME else (listed, "unit", "scale", "offset"))
    columns = _texts(channel, listed, fields.get(listed))
    units = _units(channel, fields.get("unit"), len(columns))
    scales = _numbers(channel, "scale", fields.get("scale", 1.0), len(columns))
    if any(unit and UNITS[channel][unit].needs_scale for unit in units) and "scale" not in fields:
        raise _refused(
            f"{channel} in counts needs its scale", {"channel": channel}, "add what one count is in SI"
        )
    if 0.0 in scales:
        raise _refused(
            f"the scale of {channel} is zero", {"channel": channel, "scale": scales}, "give a scale"
        )
    return ChannelRequest(
        columns, units, scales, _numbers(channel, "offset", fields.get("offset", 0.0), len(columns))
    )


def _object(where: str, value: object) -> Mapping[str, object]:
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise _refused(
            f"{where} is not a JSON object", {"found": type(value).__name__}, "give an object of named fields"
        )
    return value


def _known_keys(where: str, entries: Mapping[str, object], known: Iterable[str]) -> None:
    unknown = [key for key in entries if key not in set(known)]
    if unknown:
        raise _refused(
            f"{where} has a field that is not known: {unknown[0]!r}",
            {
                "unknown": unknown[:20],
                "known": list(known),
                "nearest": get_close_matches(unknown[0], list(known)),
            },
            "use the known fields only",
        )


def _texts(channel: str, key: str, value: object) -> tuple[str, ...]:
    values = [value] if key == "column" else value
    if (
        not isinstance(values, list | tuple)
        or not 0 < len(values) <= MAX_MAPPED_COLUMNS
        or not all(isinstance(name, str) for name in values)
    ):
        raise _refused(
            f"{channel} does not name its columns",
            {"channel": channel, "field": key, "found": repr(value)[:100]},
            'give {"column": "..."}'
            if key == "column"
            else f'give {{"columns": [...]}}, 1 to {MAX_MAPPED_COLUMNS} names',
        )
    return tuple(values)


def _units(channel: str, value: object, count: int) -> tuple[str, ...]:
    if value is None:
        return ("",) * count
    values = tuple(value) if isinstance(value, list | tuple) else (value,) * count
    unknown = [unit for unit in values if not isinstance(unit, str) or unit not in UNITS[channel]]
    if unknown or len(values) != count:
        raise _refused(
            f"the unit of {channel} is not one that is known, or not one per column",
            {"channel": channel, "found": repr(value)[:100], "known": list(UNITS[channel]), "columns": count},
            f"declare one of {', '.join(UNITS[channel])}",
        )
    return tuple(str(unit) for unit in values)


def _numbers(channel: str, key: str, value: object, count: int) -> tuple[float, ...]:
    values = tuple(value) if isinstance(value, list | tuple) else (value,) * count
    numbers = tuple(float(item) for item in values if isinstance(item, int | float) and _is_number(item))
    if len(numbers) != count or len(values) != count:
        raise _refused(
            f"the {key} of {channel} is not one finite number, or one per column",
            {"channel": channel, "found": repr(value)[:100], "columns": count},
            f"give {key} as a number or a list of {count}",
        )
    return numbers


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _rate(value: object) -> float:
    if not isinstance(value, int | float) or not _is_number(value) or value <= 0:
        raise _refused(
            "rate_hz is not a positive number", {"found": repr(value)[:100]}, "give the sample rate in Hz"
        )
    return float(value)


def _each_column_once(channels: Mapping[str, ChannelRequest | None]) -> None:
    seen: set[str] = set()
    for request in channels.values():
        for column in request.columns if request else ():
            if column in seen:
                raise _refused(
                    f"the mapping names the column {column!r} twice", {"column": column}, "name it once"
                )
            seen.add(column)


def _refused(cause: str, evidence: Mapping[str, object], remedy: str) -> LogError:
    return LogError(cause, evidence=evidence, remedy=remedy)
