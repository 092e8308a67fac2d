"""Describe logs as they are answered; they are sent as files."""

from typing import Annotated

from pydantic import Field, JsonValue

from app.schemas.common import Instant, Next, Open


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
    channels: list[str]
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
