"""Write the check of a log as lines of text and as a document."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ....core.log.check import LogCheck, Reach
from ....core.log.columns.binding import Binding
from ....core.log.defects.stretch import count_text
from ...json_text import plain

SHOWN = 6


def lines_of(path: Path, seen: LogCheck) -> Iterator[str]:
    """Give lines of text: file, channels, ranges and defects."""
    log = seen.log
    yield f"{path.name}: {seen.format}, {len(seen.columns)} columns"
    if log is not None:
        yield (
            f"{log.samples} samples, {log.duration:.4g} s at {log.rate_hz:.4g} Hz, {log.joints} joints, "
            f"{count_text(len(log.segments), 'segment')}"
        )
    for channel in seen.recognised:
        yield f"  {channel.name:<14}{_units(channel):<8}{_shorten(channel.columns)}"
    if log is None:
        yield f"  columns       {_shorten(seen.columns)}"
        return
    if log.ignored_columns:
        yield f"  {'ignored':<22}{_shorten(log.ignored_columns)}"
    yield from _reach_lines(seen.reach)
    yield f"{count_text(len(log.defects), 'defect')}{':' if log.defects else ''}"
    for defect in log.defects:
        joint = "" if defect.joint is None else f" {defect.joint}"
        yield f"  {defect.kind:<18}{defect.channel + joint:<14}{defect.statement}"


def document_of(path: Path, seen: LogCheck) -> dict[str, Any]:
    """Give the check as a document."""
    log = seen.log
    summary: dict[str, Any] = {
        "name": path.name,
        "format": seen.format,
        "columns": seen.columns,
        "usable": log is not None,
        "recognised": [
            {"channel": channel.name, "columns": channel.columns, "units": channel.units}
            for channel in seen.recognised
        ],
        "defects": [] if log is None else [asdict(defect) for defect in log.defects],
        "suggestion": seen.suggestion,
        "other_arms": seen.other_arms,
    }
    if log is not None:
        summary |= {
            "samples": log.samples,
            "duration_s": log.duration,
            "rate_hz": log.rate_hz,
            "joints": log.joints,
            "segments": log.segments,
            "ignored_columns": log.ignored_columns,
            "reach": [asdict(span) for span in seen.reach],
        }
    if seen.refusal is not None:
        summary["problem"] = {
            "cause": seen.refusal.cause,
            "evidence": seen.refusal.evidence,
            "remedy": seen.refusal.remedy,
        }
    return {name: plain(value) for name, value in summary.items()}


def _reach_lines(reach: Sequence[Reach]) -> Iterator[str]:
    if reach:
        yield "  joint " + "".join(f"{span.channel:>30}" for span in reach)
        for joint in range(len(reach[0].low)):
            cells = (f"{span.low[joint]:.4g} .. {span.high[joint]:.4g} {span.units[joint]}" for span in reach)
            yield f"  {joint + 1:>5} " + "".join(f"{cell:>30}" for cell in cells)


def _units(channel: Binding) -> str:
    """Name the unit that all columns share, or all units."""
    return ", ".join(dict.fromkeys(channel.units))


def _shorten(names: Sequence[str]) -> str:
    if len(names) <= SHOWN:
        return " ".join(names)
    return f"{names[0]} {names[1]} ... {names[-1]} ({len(names)})"
