"""Describe logs as they are answered; they are sent as files."""

from typing import Annotated

from pydantic import Field, JsonValue

from ...core.log.channels import JOINT_CHANNELS
from .common import Instant, Next, Open, Strict, about


class Defect(Open):
    """A defect of a usable log."""

    kind: Annotated[str, Field(examples=["gap", "jitter", "repeated_rows", "standstill"])]
    channel: str
    joint: Annotated[int | None, about("counted from 1; null if it concerns all joints")]
    count: Annotated[int, about("number of affected samples")]
    intervals: Annotated[list[list[float]], about("start and end in s, at most twenty")]
    statement: str
    level: Annotated[
        float | None,
        about(
            "SI: where a saturated channel stays, or how far from the median of five samples an outlier lies "
            "at least; null for other defects"
        ),
    ]


class LogSummary(Open):
    """Summary of a log. Logs are immutable: the same bytes, name and mapping have the same id."""

    id: str
    name: str
    sha256: str
    bytes: int
    samples: int
    duration_s: float
    rate_hz: float
    joints: int
    channels: Annotated[list[str], about(f"of {', '.join(channel.name for channel in JOINT_CHANNELS)}")]
    ignored_columns: Annotated[list[str], about("columns that the mapping does not name")]
    defects: list[Defect]
    mapping: Annotated[dict[str, JsonValue] | None, about("as it was sent; null for the default names")]
    created_at: Instant


class LogReading(Strict):
    """Ask for another reading of a log's bytes."""

    mapping: Annotated[
        dict[str, JsonValue],
        Field(max_length=100, description="what each column is, as at an upload; empty: default names"),
    ]


class LogList(Open):
    """Logs, the newest first."""

    logs: list[LogSummary]
    next: Next


class Trace(Open):
    """A channel of a joint, min/max decimated; null at gaps."""

    channel: Annotated[str, Field(examples=[channel.name for channel in JOINT_CHANNELS])]
    joint: Annotated[int, about("counted from 1")]
    unit: Annotated[str, about("of two units, the type of the joint decides: revolute or prismatic")]
    values: Annotated[list[float | None], Field(max_length=4000)]


class Stamps(Open):
    """The time axis that all traces share."""

    unit: str
    values: Annotated[list[float], Field(max_length=4000)]


class LogTraces(Open):
    """A log for plotting, min/max decimated: minimum and maximum of each group of rows, in order of time."""

    name: str
    samples: int
    rows_per_stretch: Annotated[int, about("rows per decimation group; 1 without decimation")]
    time: Stamps
    traces: list[Trace]
