"""Read uploaded logs: a file goes in, a summary or decimated channels come out, as documents."""

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from ...core.log.channels import CHANNELS
from ...core.log.preview import FEWEST_POINTS, preview
from ...core.log.reader import read_log
from ..json_text import plain
from ..store.blobs.blob_store import check_file
from ..store.records import Document

MOST_NUMBERS = 600_000
"""Numbers in all traces of a log together."""


@dataclass(frozen=True)
class LogFile:
    """Name the file of a log and how to read it."""

    path: Path
    """The bytes as they were uploaded."""
    name: str
    """The log's name."""
    mapping: Document | None
    """Which column is what; None for the default names."""
    sha256: str
    """Hash of the bytes."""


@dataclass(frozen=True)
class ChannelSelection:
    """Select what is shown of a log."""

    channels: tuple[str, ...]
    """Their names."""
    points: int
    """The most points per trace."""
    begin: float | None = None
    end: float | None = None
    """Interval of the log's clock, s; None for its own ends."""


def summarise_log(log: LogFile, *, media_type: str | None) -> Document:
    """Read a log once and say what is in it.

    Raises
    ------
    LogError
        If the log cannot be used.
    """
    seen = read_log(log.path, media_type=media_type, mapping=log.mapping, name=log.name, sha256=log.sha256)
    summary = {
        "name": seen.name,
        "sha256": log.sha256,
        "mapping": log.mapping,
        "samples": seen.samples,
        "duration_s": seen.duration,
        "rate_hz": seen.rate_hz,
        "joints": seen.joints,
        "channels": seen.channels,
        "ignored_columns": seen.ignored_columns,
        "defects": [asdict(defect) for defect in seen.defects],
    }
    return {name: plain(value) for name, value in summary.items()}


def trace_log(log: LogFile, selection: ChannelSelection) -> Document:
    """Draw channels of a log with few points each, in single precision, as a screen needs them.

    Where there are very many traces, they have fewer points than are asked for.

    Raises
    ------
    OptionError
        If nothing was measured in the stretch of time that is asked for.
    DamagedError
        If the log is not what it was.
    """
    check_file(log.path, log.sha256)
    seen = read_log(log.path, mapping=log.mapping, name=log.name, sha256=log.sha256)
    named = [(channel, joint) for channel in selection.channels for joint in range(1, seen.joints + 1)]
    few = max(FEWEST_POINTS, min(selection.points, MOST_NUMBERS // (len(named) + 1)))
    drawn = preview(seen, selection.channels, points=few, begin=selection.begin, end=selection.end)
    return {
        "name": seen.name,
        "samples": seen.samples,
        "rows_per_stretch": drawn.rows_per_stretch,
        "time": {"unit": "s", "values": [round(stamp, 6) for stamp in drawn.time.tolist()]},
        "traces": [
            {"channel": channel, "joint": joint, "unit": CHANNELS[channel].unit, "values": _round(values)}
            for (channel, joint), values in zip(named, drawn.values.T, strict=True)
        ],
    }


def _round(values: np.ndarray) -> list[float | None]:
    """Write numbers with the digits that single precision has; None for NaN."""
    return [None if np.isnan(value) else float(str(value)) for value in values.astype(np.float32)]
