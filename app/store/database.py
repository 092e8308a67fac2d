"""Open the database and run units of work in it: reads beside each other, writes whole or not at all.

SQLite takes one writer at a time and syncs the disk at every commit; so one thread commits what has gathered
meanwhile in one transaction, each unit within a savepoint of its own. PostgreSQL orders writers itself.
Sources: https://www.sqlite.org/wal.html; Gray & Reuter, Transaction Processing (1993), ch. 9.4.6, for commits
in groups.
"""

import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, TypeVar

from sqlalchemy import URL, Connection, Engine, Table, create_engine, event, make_url, text
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.exc import OperationalError
from sqlalchemy.pool import ConnectionPoolEntry

from .errors import UnavailableError
from .migrations.upgrade import upgrade

MOST_TOGETHER = 256
"""Units of work that one commit carries."""
PATIENCE_S = 10.0
"""How long a writer waits for another process."""
Given = TypeVar("Given")
Work = Callable[[Connection], Given]
_Unit = tuple[Callable[[Connection], Any], "Future[Any]"]


class Database:
    """Run units of work.

    Parameters
    ----------
    url
        As SQLAlchemy writes it: ``sqlite:///path`` or ``postgresql+psycopg://...``.

    Raises
    ------
    UnavailableError
        If the database does not answer.
    """

    def __init__(self, url: URL | str) -> None:
        self._engine = _engine(make_url(url))
        try:
            upgrade(self._engine)
        except OperationalError as error:
            raise UnavailableError(str(error.orig)) from None
        self._waiting: SimpleQueue[_Unit | None] = SimpleQueue()
        self._writer = threading.Thread(target=self._serve, name="writer", daemon=True)
        self.embedded = self._engine.dialect.name == "sqlite"
        if self.embedded:
            self._writer.start()

    @classmethod
    def in_directory(cls, directory: Path) -> "Database":
        """Open the embedded database of a data directory."""
        return cls(URL.create("sqlite", database=str(directory / "veritorque.sqlite")))

    def read(self, work: Work[Given]) -> Given:
        """Run a unit of work that changes nothing, and give what it gives.

        Raises
        ------
        UnavailableError
            If the database does not answer.
        """
        try:
            with self._engine.connect() as connection:
                return work(connection)
        except OperationalError as error:
            raise UnavailableError(str(error.orig)) from None

    def snapshot(self, work: Work[Given]) -> Given:
        """Run a unit of work that reads all as it is at one instant, however long it takes.

        Raises
        ------
        UnavailableError
            If the database does not answer.
        """
        level = {} if self.embedded else {"isolation_level": "REPEATABLE READ"}  # SQLite reads so anyway
        try:
            with self._engine.connect().execution_options(**level) as connection:
                return work(connection)
        except OperationalError as error:
            raise UnavailableError(str(error.orig)) from None

    def write(self, work: Work[Given]) -> Given:
        """Run a unit of work, and give what it gives once that is on the disk.

        Whatever it raises undoes it and comes out here.

        Raises
        ------
        UnavailableError
            If the database cannot be written: locked by another process, its disk full, or gone.
        """
        return self.begin(work).result()

    def begin(self, work: Work[Given]) -> "Future[Given]":
        """Run a unit of work as `write` does, and do not wait for it where others write."""
        outcome: Future[Given] = Future()
        if self.embedded:
            self._waiting.put((work, outcome))
            return outcome
        try:
            outcome.set_result(self._write_at_once(work))
        except Exception as error:  # noqa: BLE001 - it is raised where the outcome is read
            outcome.set_exception(error)
        return outcome

    def close(self) -> None:
        """Finish what waits, and close the database."""
        if self._writer.is_alive():
            self._waiting.put(None)
            self._writer.join()
        self._engine.dispose()

    def _write_at_once(self, work: Work[Given]) -> Given:
        try:
            with self._engine.begin() as connection:
                return work(connection)
        except OperationalError as error:
            raise UnavailableError(str(error.orig)) from None

    def _serve(self) -> None:
        open_ended = True
        while open_ended:
            units, open_ended = self._gather()
            if units:
                self._commit(units)

    def _gather(self) -> tuple[list[_Unit], bool]:
        """Wait for one unit and take what else waits; tell whether more may come."""
        units = []
        unit = self._waiting.get()
        while unit is not None:
            units.append(unit)
            try:
                unit = self._waiting.get_nowait() if len(units) < MOST_TOGETHER else _end_of_units()
            except Empty:
                return units, True
        return units, False

    def _commit(self, units: list[_Unit]) -> None:
        try:
            with self._engine.connect() as connection:
                writing = connection.execution_options(writes=True)
                with writing.begin():
                    outcomes = [_run_unit(work, writing) for work, _ in units]
        except Exception as error:  # noqa: BLE001 - those who wait get it, and the thread goes on
            failure = UnavailableError(str(error.orig)) if isinstance(error, OperationalError) else error
            outcomes = [failure] * len(units)
        for (_, outcome), given in zip(units, outcomes, strict=True):
            if isinstance(given, Exception):
                outcome.set_exception(given)
            else:
                outcome.set_result(given)


def insert_if_new(connection: Connection, table: Table, values: Mapping[str, object]) -> None:
    """Insert a row unless one with the same unique values is there, even if that comes at the same time."""
    if connection.dialect.name == "postgresql":
        connection.execute(postgresql.insert(table).values(values).on_conflict_do_nothing())
    else:
        connection.execute(sqlite.insert(table).values(values).on_conflict_do_nothing())


def lock_in_turn(connection: Connection, about: str) -> None:
    """Wait until no other transaction writes about the same; SQLite allows one writer anyway."""
    if connection.dialect.name == "postgresql":
        connection.execute(
            text("SELECT pg_advisory_xact_lock(hashtextextended(:about, 0))"), {"about": about}
        )


def _end_of_units() -> _Unit:
    raise Empty


def _run_unit(work: Callable[[Connection], Any], connection: Connection) -> object:
    """Run one unit within a savepoint, and give what it gives or raises."""
    given: object
    connection.exec_driver_sql("SAVEPOINT unit")
    try:
        given = work(connection)
    except OperationalError:
        raise
    except Exception as error:  # noqa: BLE001 - it is undone and handed to the one who asked
        connection.exec_driver_sql("ROLLBACK TO unit")
        given = error
    connection.exec_driver_sql("RELEASE unit")
    return given


def _engine(url: URL) -> Engine:
    if url.get_backend_name() != "sqlite":
        return create_engine(url, pool_size=8, max_overflow=8, pool_pre_ping=True)
    engine = create_engine(url, connect_args={"timeout": PATIENCE_S, "check_same_thread": False})
    event.listen(engine, "connect", _prepare)
    event.listen(engine, "begin", _begin)
    return engine


def _prepare(connection: DBAPIConnection, _entry: ConnectionPoolEntry) -> None:
    """Let us begin transactions ourselves, and set what SQLite keeps per connection."""
    connection.isolation_level = None
    cursor = connection.cursor()
    for pragma in ("journal_mode=WAL", "synchronous=FULL", f"busy_timeout={int(1000 * PATIENCE_S)}"):
        cursor.execute(f"PRAGMA {pragma}")
    cursor.close()


def _begin(connection: Connection) -> None:
    """Begin a write with the lock that it will need: one that is asked for later may be refused."""
    writes = connection.get_execution_options().get("writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
