"""Lay out the database: one table per resource, JSON documents as text, times as ISO 8601 in UTC.

SQLite in WAL mode lets requests read while a computation reports its progress. Source: https://www.sqlite.org/wal.html
"""

from datetime import UTC, datetime
from pathlib import Path

from sqlalchemy import (
    URL,
    Column,
    Engine,
    Float,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    create_engine,
    event,
)
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.pool import ConnectionPoolEntry

METADATA = MetaData()

ROBOTS = Table(
    "robots",
    METADATA,
    Column("id", String, primary_key=True),
    Column("sequence", Integer, nullable=False, index=True),
    Column("document", Text, nullable=False),
    Column("created_at", String, nullable=False),
)
LOGS = Table(
    "logs",
    METADATA,
    Column("id", String, primary_key=True),
    Column("sequence", Integer, nullable=False, index=True),
    Column("sha256", String, nullable=False, index=True),
    Column("document", Text, nullable=False),
    Column("created_at", String, nullable=False),
)
JOBS = Table(
    "jobs",
    METADATA,
    Column("sequence", Integer, primary_key=True, autoincrement=True),
    Column("id", String, nullable=False, unique=True),
    Column("request", Text, nullable=False),
    Column("state", String, nullable=False, index=True),
    Column("stage", String, nullable=False, default=""),
    Column("fraction", Float, nullable=False, default=0.0),
    Column("attempts", Integer, nullable=False, default=0),
    Column("version", Integer, nullable=False, default=1),
    Column("problem", Text),
    Column("result_sha256", String, index=True),
    Column("created_at", String, nullable=False),
    Column("started_at", String),
    Column("finished_at", String),
)


def open_database(path: Path) -> Engine:
    """Open the database, and create it where there is none."""
    engine = create_engine(URL.create("sqlite", database=str(path)), connect_args={"timeout": 10.0})
    event.listen(engine, "connect", _set_pragmas)
    METADATA.create_all(engine)
    return engine


def now() -> str:
    """Give the time as ISO 8601 in UTC with milliseconds."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _set_pragmas(connection: DBAPIConnection, _entry: ConnectionPoolEntry) -> None:
    cursor = connection.cursor()
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "busy_timeout=10000"):
        cursor.execute(f"PRAGMA {pragma}")
    cursor.close()
