"""Bring a database to the present layout: a new one at once, one of an earlier version step by step.

A database of the present layout is recognised by its own note, so that Alembic is loaded only where there is
something to change. Processes that start together wait for each other.
"""

from pathlib import Path

from sqlalchemy import Connection, Engine, inspect, text

from ..tables import METADATA

LATEST = "0002"
"""The last of `versions/`."""
_NOTE = "CREATE TABLE alembic_version (version_num VARCHAR(32) NOT NULL PRIMARY KEY)"
_LOCK = 7236011


def upgrade(engine: Engine) -> None:
    """Lay the tables out, or change those of an earlier version."""
    with engine.connect() as connection:
        if revision(connection) == LATEST:
            return
    with engine.connect().execution_options(writes=True) as connection, connection.begin():
        if connection.dialect.name == "postgresql":
            connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": _LOCK})
        if revision(connection) is None:
            create(connection)
        else:
            step(connection, LATEST)


def revision(connection: Connection) -> str | None:
    """Give the step that a database is at; None where it is empty."""
    if not inspect(connection).has_table("alembic_version"):
        return None
    return str(connection.execute(text("SELECT version_num FROM alembic_version")).scalar_one())


def touch(connection: Connection) -> None:
    """Note again which step the database is at, which takes a write."""
    connection.execute(text("UPDATE alembic_version SET version_num = version_num"))


def create(connection: Connection) -> None:
    """Lay out an empty database as the last step leaves it."""
    METADATA.create_all(connection)
    connection.execute(text(_NOTE))
    connection.execute(text("INSERT INTO alembic_version VALUES (:latest)"), {"latest": LATEST})


def step(connection: Connection, target: str) -> None:
    """Run the steps up to one of `versions/`."""
    from alembic import command
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent))
    config.attributes |= {"connection": connection, "metadata": METADATA}
    command.upgrade(config, target)
