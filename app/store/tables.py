"""Lay out the database, and read its rows: one table per resource, JSON as text, times as ISO 8601 in UTC.

Everything but a key belongs to a tenant. Numbers that only ever grow (`sequence`, `token`, `beat`, `version`)
order what clocks cannot: a clock may be set back an hour.
"""

import json
from collections.abc import Iterable
from dataclasses import fields
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    Column,
    ColumnElement,
    Float,
    Index,
    Integer,
    MetaData,
    Row,
    String,
    Table,
    Text,
    UniqueConstraint,
    or_,
)

from .records import JobRecord, JobRequestRecord, LogRecord, RobotRecord

METADATA = MetaData(
    naming_convention={
        "pk": "pk_%(table_name)s",
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    }
)

ROBOTS = Table(
    "robots",
    METADATA,
    Column("sequence", Integer, primary_key=True, autoincrement=True),
    Column("tenant", String, nullable=False),
    Column("id", String, nullable=False),
    Column("document", Text, nullable=False),
    Column("created_at", String, nullable=False),
    UniqueConstraint("tenant", "id"),
    sqlite_autoincrement=True,
)
LOGS = Table(
    "logs",
    METADATA,
    Column("sequence", Integer, primary_key=True, autoincrement=True),
    Column("tenant", String, nullable=False),
    Column("id", String, nullable=False),
    Column("sha256", String, nullable=False, index=True),
    Column("bytes", Integer, nullable=False),
    Column("document", Text, nullable=False),
    Column("created_at", String, nullable=False),
    UniqueConstraint("tenant", "id"),
    sqlite_autoincrement=True,
)
JOBS = Table(
    "jobs",
    METADATA,
    Column("sequence", Integer, primary_key=True, autoincrement=True),
    Column("tenant", String, nullable=False),
    Column("id", String, nullable=False, unique=True),
    Column("fingerprint", String, nullable=False),
    Column("request", Text, nullable=False),
    Column("trace", String),
    Column("state", String, nullable=False),
    Column("stage", String, nullable=False),
    Column("fraction", Float, nullable=False),
    Column("version", Integer, nullable=False),
    Column("attempts", Integer, nullable=False),
    Column("token", Integer, nullable=False),
    Column("owner", String),
    Column("beat", Integer, nullable=False),
    Column("problem", Text),
    Column("result_sha256", String, index=True),
    Column("result_bytes", Integer, nullable=False),
    Column("created_at", String, nullable=False),
    Column("started_at", String),
    Column("finished_at", String),
    Column("traces_sha256", String, index=True),
    Index(None, "state", "sequence"),
    Index(None, "tenant", "fingerprint"),
    Index(None, "tenant", "state"),
    sqlite_autoincrement=True,
)
"""`token` counts how often a job was taken: who holds an old one changes nothing. `beat` grows while `owner`
lives. `result_bytes` counts document and traces. Of equal `fingerprint` are jobs that ask for the same."""

REPEATS = Table(
    "repeats",
    METADATA,
    Column("tenant", String, primary_key=True),
    Column("key", String, primary_key=True),
    Column("digest", String, nullable=False),
    Column("job_id", String, nullable=False),
    Column("created_at", String, nullable=False),
)
"""Requests that carried an Idempotency-Key, by that key, with a hash of what was asked and the job."""

KEYS = Table(
    "keys",
    METADATA,
    Column("id", String, primary_key=True),
    Column("tenant", String, nullable=False),
    Column("name", String, nullable=False),
    Column("scopes", String, nullable=False),
    Column("sha256", String, nullable=False, unique=True),
    Column("created_at", String, nullable=False),
    Column("revoked_at", String),
)
"""API keys; of a key itself only the hash is kept."""


def one_of(column: ColumnElement[Any], values: Iterable[str]) -> ColumnElement[bool]:
    """Compare with a few known values, so that the statement is the same each time."""
    return or_(*(column == value for value in values))


def now() -> str:
    """Give the time as ISO 8601 in UTC with milliseconds."""
    return time_text(datetime.now(UTC))


def time_text(time: datetime) -> str:
    """Write a time in UTC such that later times sort after earlier ones."""
    return time.isoformat(timespec="milliseconds")


_AS_KEPT = [field.name for field in fields(JobRecord) if field.name not in ("request", "problem")]


def request_record(text: str) -> JobRequestRecord:
    """Read what was asked for."""
    asked = json.loads(text)
    return JobRequestRecord(asked["kind"], asked["robot"], tuple(asked["logs"]), asked["options"])


def job_record(row: Row[Any]) -> JobRecord:
    """Read a job."""
    return JobRecord(
        request=request_record(row.request),
        problem=None if row.problem is None else json.loads(row.problem),
        **{name: getattr(row, name) for name in _AS_KEPT},
    )


def log_record(row: Row[Any]) -> LogRecord:
    """Read a log's summary."""
    return LogRecord(row.id, row.sequence, row.sha256, json.loads(row.document), row.created_at)


def robot_record(row: Row[Any]) -> RobotRecord:
    """Read a robot."""
    document = json.loads(row.document)
    return RobotRecord(
        id=row.id,
        sequence=row.sequence,
        name=document["name"],
        joints=document["joints"],
        built_in=False,
        description=document["description"],
        suspicions=tuple(document["suspicions"]),
        created_at=row.created_at,
    )
