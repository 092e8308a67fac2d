"""Check a log before anything is identified from it: what was recognised, what moved, what is wrong.

A file that cannot be used yet is no error here: the answer holds the reason and a mapping that would help.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..arrays import JointVector
from ..errors import LogError
from .channels import TIME
from .columns.binding import Binding
from .columns.layout import Layout
from .columns.suggestion import explained, suggest_mappings, suggest_units
from .formats.first_rows import first_rows
from .model import JointLog
from .reader import bind_columns, open_table, read_table

PIECE_ROWS = 1 << 16


@dataclass(frozen=True, eq=False)
class Reach:
    """Hold the smallest and largest value of a channel, joint by joint, in SI."""

    channel: str
    units: tuple[str, ...]
    low: JointVector
    high: JointVector


@dataclass(frozen=True, eq=False)
class LogCheck:
    """Describe what is in a file."""

    format: str
    """``CSV``, ``Parquet`` ..."""
    columns: tuple[str, ...]
    """All columns of the file."""
    recognised: tuple[Binding, ...] = ()
    """Time and channels with their columns and units; empty where they are not known."""
    log: JointLog | None = None
    """The log with its defects; None where it cannot be used."""
    reach: tuple[Reach, ...] = ()
    """Between which values every channel moved."""
    refusal: LogError | None = None
    """Why it cannot be used."""
    suggestion: Mapping[str, object] | None = None
    """A mapping to confirm, where names or units are not known, or a unit makes implausible sizes."""
    other_arms: tuple[Mapping[str, object], ...] = ()
    """Mappings for the other arms of the same file, which are logs of their own."""


def check_log(path: Path, *, mapping: Mapping[str, object] | None = None) -> LogCheck:
    """Check a file.

    Raises
    ------
    LogError
        If the file is of no format that holds a log, or damaged.
    """
    form, table = open_table(path)
    seen = first_rows(table)
    try:
        layout = bind_columns(seen, mapping)
    except LogError as error:
        arms = [] if mapping else suggest_mappings(seen)
        suggestion = next(iter(arms), None)
        refusal = error if mapping or arms else explained(error, table)
        return LogCheck(
            form.name, table.names, refusal=refusal, suggestion=suggestion, other_arms=tuple(arms[1:])
        )
    recognised = tuple(filter(None, (layout.time, *layout.channels)))
    try:
        log = read_table(table, layout, name=path.stem, sha256="")
    except LogError as error:
        return LogCheck(form.name, table.names, recognised, refusal=error)
    recognised = tuple(bound for bound in recognised if bound.name in (TIME, *log.channels))
    units = None if mapping else suggest_units(table, layout, log.defects)
    return LogCheck(form.name, table.names, recognised, log, _reach(log, layout), suggestion=units)


def _reach(log: JointLog, layout: Layout) -> tuple[Reach, ...]:
    names, units = list(log.channels), layout.si_units()
    pieces = [_extremes(log, names, start) for start in range(0, log.samples, PIECE_ROWS)]
    return tuple(
        Reach(
            name,
            units[name],
            np.min([low for low, _ in piece], axis=0),
            np.max([high for _, high in piece], axis=0),
        )
        for name, piece in zip(names, zip(*pieces, strict=True), strict=True)
    )


def _extremes(log: JointLog, names: list[str], start: int) -> list[tuple[JointVector, JointVector]]:
    rows = log.source.rows(start, min(start + PIECE_ROWS, log.samples))
    return [(getattr(rows, name).min(axis=0), getattr(rows, name).max(axis=0)) for name in names]
