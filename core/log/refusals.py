"""Word the refusals of a mapping: what was looked for, what is there, and what would help."""

import re
from collections.abc import Sequence
from difflib import get_close_matches

from ..errors import LogError
from .channels import CHANNELS, TIME, UNITS
from .columns.mapping import ChannelRequest
from .columns.plausible_units import readings_by_column
from .formats.table import BY_NUMBER, Table

SHOWN_COLUMNS = 24
NUMBERED = (
    'map the columns by their numbers from 1, as in {"time": {"column": 1, "unit": "s"}, '
    '"position": {"columns": [2], "unit": "rad"}, "torque": {"columns": [3], "unit": "N m"}}, or put names '
    "on the first line"
)
_DEFAULT_NAME = re.compile(rf"({'|'.join(channel.prefix for channel in CHANNELS.values())})(_\d+)?")


def absent_names(wanted: Sequence[str], present: Sequence[str]) -> list[str]:
    """Give the names that are not there."""
    return [name for name in wanted if name not in present]


def contradiction_error(channel: str, columns: Sequence[str], unit: str) -> LogError:
    """Say that the file itself declares another unit than the default names stand for."""
    si = next(iter(UNITS[channel]))
    return LogError(
        f"the file says that {columns[0]!r} is in {unit}, and a default name stands for {si}",
        evidence={"columns": list(columns[:SHOWN_COLUMNS]), "unit_in_the_file": unit, "default": si},
        remedy=f'map {channel} with "unit": "{unit}", or with the unit that it truly has',
    )


def refuse_other_clock(table: Table) -> None:
    """Refuse stamps of the default name that are too far apart for seconds, with what they could be.

    Raises
    ------
    LogError
        If another unit is plausible and seconds are not.
    """
    readings = readings_by_column(TIME, [TIME], table).get(TIME, [])
    units = [reading.split(":")[0] for reading in readings]
    second = next(iter(UNITS[TIME]))
    if not units or second in units:
        return
    size = readings[0].split(": ")[1].split(";")[0]
    raise LogError(
        f"the unit of 'time' is not declared, and {size}, too long for {second}",
        evidence={"columns": [TIME], "plausible_readings": readings},
        remedy=f'declare it, as in {{"time": {{"column": "time", "unit": "{units[0]}"}}}}; with the unit '
        f'"{second}" the log is read as it stands',
    )


def missing_error(channel: str, wanted: list[str], table: Table, remedy: str) -> LogError:
    """Say that a channel has no columns, which there are, and what they could be."""
    absent = absent_names(wanted, table.names)
    candidates = [name for name in table.names if not _DEFAULT_NAME.fullmatch(name)]
    nearest = {name: near for name in absent[:8] if (near := get_close_matches(name, candidates, 3))}
    shown, there = wanted[:SHOWN_COLUMNS], list(table.names[:SHOWN_COLUMNS])
    evidence: dict[str, object] = {"looked_for": shown, "columns": there, "nearest": nearest}
    if readings := readings_by_column(channel, candidates[:SHOWN_COLUMNS], table):
        evidence["plausible_readings"] = readings
    cause = f"the log has no column for {channel}: {', '.join(absent[:8])}"
    if all(name.startswith(BY_NUMBER) for name in table.names):
        cause, remedy = "the file has no header that names its columns", NUMBERED
    return LogError(cause, evidence=evidence, remedy=remedy)


def unit_error(channel: str, request: ChannelRequest, table: Table) -> LogError:
    """Say that the unit of a channel is not declared, and which are plausible."""
    columns = [name for name, unit in zip(request.columns, request.units, strict=True) if not unit]
    readings = readings_by_column(channel, columns[:SHOWN_COLUMNS], table)
    first = next(iter(readings.values()), [])
    likely = f", most plausibly {first[0].split(':')[0]}" if first else ""
    return LogError(
        f"the unit of {channel} is not declared, and {columns[0]!r} is not a default name, which would be SI",
        evidence={
            "columns": columns[:SHOWN_COLUMNS],
            "plausible_readings": readings,
            "known": list(UNITS[channel]),
        },
        remedy=f'declare "unit" for {channel}{likely}',
    )
