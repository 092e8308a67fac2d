"""Describe logs as they are answered; they are sent as files."""

from typing import Annotated

from pydantic import Field, JsonValue

from ...core.log.channels import JOINT_CHANNELS
from .common import Instant, Next, Open


class Defect(Open):
    """Something that is wrong with usable data."""

    kind: Annotated[str, Field(examples=["gap", "jitter", "repeated_rows", "standstill"])]
    channel: str
    joint: Annotated[int | None, Field(description="counted from 1; null where it concerns all joints")]
    count: Annotated[int, Field(description="samples it touches")]
    intervals: Annotated[list[list[float]], Field(description="start and end in s, at most twenty")]
    statement: str


class LogSummary(Open):
    """What is in a log. It never changes: the same bytes under the same name and mapping have the same id."""

    id: str
    name: str
    sha256: str
    bytes: int
    samples: int
    duration_s: float
    rate_hz: float
    joints: int
    channels: Annotated[
        list[str], Field(description=f"of {', '.join(channel.name for channel in JOINT_CHANNELS)}")
    ]
    ignored_columns: Annotated[list[str], Field(description="columns that the mapping does not name")]
    defects: list[Defect]
    mapping: Annotated[
        dict[str, JsonValue] | None, Field(description="as it was sent; null for the default names")
    ]
    created_at: Instant


class LogList(Open):
    """Logs, the newest first."""

    logs: list[LogSummary]
    next: Next


class Trace(Open):
    """A channel of a joint, thinned for the eye; null at gaps."""

    channel: Annotated[str, Field(examples=[channel.name for channel in JOINT_CHANNELS])]
    joint: Annotated[int, Field(description="counted from 1")]
    unit: Annotated[
        str, Field(description="the robot tells which of two: whether the joint is revolute or prismatic")
    ]
    values: Annotated[list[float | None], Field(max_length=4000)]


class Stamps(Open):
    """The time axis that all traces share."""

    unit: str
    values: Annotated[list[float], Field(max_length=4000)]


class LogTraces(Open):
    """A log to look at: of every stretch of rows the smallest and the largest value, in order of time."""

    name: str
    samples: int
    rows_per_stretch: Annotated[
        int, Field(description="rows of which two points are left; 1 where every row is there")
    ]
    time: Stamps
    traces: list[Trace]
