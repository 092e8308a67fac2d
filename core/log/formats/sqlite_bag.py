"""Give the topics and messages of a ROS 2 bag in SQLite, of whose schema nothing is trusted.

The tables are those of the storage plugin rosbag2_storage_sqlite3. SQLite computes nothing that a file
brings along: views, triggers, virtual tables and generated columns are refused. Pages that lead round in
circles come to an end. Messages come in the order in which they were stored.
Source: rosbag2_storage_sqlite3, sqlite_storage.cpp; SQLite, "Defense Against The Dark Arts".
"""

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import count
from pathlib import Path

from ...errors import LogError
from .table import FREE_BYTES, LONGEST_NAME

CDR = "cdr"
NEEDED = {"topics", "messages"}
PLAIN = ("CREATE TABLE ", "CREATE INDEX ")
"""What a bag's schema is made of."""
LARGEST_VALUE = 1 << 20
"""Bytes. Joint states of 512 joints take a fifth of it; larger messages of other topics are not touched."""
STEPS = 1000
ZSTANDARD = b"\x28\xb5\x2f\xfd"
CONVERT = "convert the bag to MCAP: ros2 bag convert"


@dataclass(frozen=True)
class Topic:
    """Describe one topic."""

    number: int
    topic: str
    msgtype: str
    serialization: str


@dataclass(frozen=True)
class SqliteBag:
    """Read an open bag."""

    database: sqlite3.Connection
    size: int
    """Bytes of the file."""

    @property
    def connections(self) -> list[Topic]:
        """List the topics."""
        rows = self.database.execute("SELECT id, name, type, serialization_format FROM topics")
        return [Topic(number, *(str(word)[:LONGEST_NAME] for word in words)) for number, *words in rows]

    def messages(self, topics: list[Topic]) -> Iterator[tuple[Topic, int, bytes]]:
        """Give the messages of topics with their stamps, ns.

        Raises
        ------
        LogError
            If they are not serialised as CDR, are compressed, or are more than the file's bytes can hold.
        """
        given = 0
        for topic in topics:
            if topic.serialization != CDR:
                raise LogError(
                    f"the messages of {topic.topic} are not serialised as CDR",
                    evidence={"serialization_format": topic.serialization, "read": CDR},
                    remedy=f"{CONVERT} with output_serialization_format: cdr",
                )
            rows = self.database.execute(
                "SELECT timestamp, data FROM messages WHERE topic_id = ?", (topic.number,)
            )
            for stamp, data in rows:
                if data.startswith(ZSTANDARD):
                    raise LogError(
                        "the messages of the bag are compressed one by one",
                        evidence={"compression": "zstd"},
                        remedy=f"{CONVERT} without a compression_mode",
                    )
                given += len(data)
                if given > self.size:
                    raise LogError(
                        "the bag gives more messages than its bytes can hold",
                        evidence={"bytes": self.size},
                        remedy="write the bag again and upload it whole",
                    )
                yield topic, stamp, data


@contextmanager
def sqlite_bag(path: Path) -> Iterator[SqliteBag]:
    """Open a bag to read it, and nothing else that lies beside it.

    Raises
    ------
    LogError
        If the database is no bag, or messages have not been written back to it yet.
    """
    _refuse_unmerged(path)
    size = path.stat().st_size
    address = f"{path.absolute().as_uri()}?mode=ro&immutable=1"
    with closing(sqlite3.connect(address, uri=True)) as database:
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_VALUE)
        database.execute("PRAGMA trusted_schema = OFF")
        database.execute("PRAGMA cell_size_check = ON")
        # A row takes more bytes than steps; a tree that leads round in circles has rows without end.
        calls, most = count(), (FREE_BYTES + size) // STEPS
        database.set_progress_handler(lambda: next(calls) > most, STEPS)
        _require_bag(database)
        yield SqliteBag(database, size)


def _refuse_unmerged(path: Path) -> None:
    beside = path.with_name(f"{path.name}-wal")
    if beside.is_file() and beside.stat().st_size:
        raise LogError(
            "the last messages of the bag are in a file beside it, since its recorder was not closed",
            evidence={"beside": beside.name, "bytes": beside.stat().st_size},
            remedy=f"have SQLite write them back: sqlite3 {path.name} 'PRAGMA wal_checkpoint(TRUNCATE)'",
        )


def _require_bag(database: sqlite3.Connection) -> None:
    schema = database.execute("SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL").fetchall()
    names = {name[:LONGEST_NAME] for name, _ in schema}
    foreign = {name[:LONGEST_NAME] for name, sql in schema if not sql.startswith(PLAIN)}
    computed = set(filter(partial(_is_computed, database), NEEDED))
    if foreign | computed or not names >= NEEDED:
        raise LogError(
            "the SQLite database is no ROS 2 bag",
            evidence={"holds": sorted(foreign | computed or names)[:20], "needed": sorted(NEEDED)},
            remedy="export the measured columns as CSV or Parquet; of a bag whose recorder was killed, let "
            "SQLite write back the file that ends in -wal: sqlite3 BAG.db3 'PRAGMA wal_checkpoint(TRUNCATE)'",
        )


def _is_computed(database: sqlite3.Connection, table: str) -> bool:
    """Tell whether a column of a table is computed from others."""
    return any(hidden for *_, hidden in database.execute(f"PRAGMA table_xinfo({table})"))
