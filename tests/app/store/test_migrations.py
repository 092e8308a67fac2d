"""The steps of `migrations/versions` end at the tables that the code uses."""

import pytest
from sqlalchemy import create_engine, inspect

from tests.app.postgres import new_database
from veritorque.app.store.database import Database
from veritorque.app.store.migrations.upgrade import LATEST, revision, step, upgrade


@pytest.fixture(params=["sqlite", "postgresql"])
def fresh(request, tmp_path):
    """Make empty databases of either kind."""
    if request.param == "sqlite":
        return lambda name: f"sqlite:///{tmp_path / name}"
    pytest.importorskip("psycopg", reason="SKIPPED FOR WANT OF PSYCOPG: pip install veritorque[postgres]")
    folder = request.getfixturevalue("postgres")
    return lambda _: new_database(folder)


@pytest.fixture
def stepped(fresh):
    """Walk all steps from an empty database."""
    engine = create_engine(fresh("stepped"))
    with engine.begin() as connection:
        step(connection, "head")
    yield engine
    engine.dispose()


def layout(engine):
    """Describe tables, columns, keys and indexes, all with their names."""
    tables = inspect(engine)
    return {
        name: (
            [
                (column["name"], str(column["type"]), column["nullable"])
                for column in tables.get_columns(name)
            ],
            tables.get_pk_constraint(name),
            sorted((one["name"], one["column_names"]) for one in tables.get_unique_constraints(name)),
            sorted((one["name"], one["column_names"], one["unique"]) for one in tables.get_indexes(name)),
        )
        for name in tables.get_table_names()
        if name != "alembic_version"
    }


def test_the_steps_lead_to_the_tables_of_a_new_database(fresh, stepped):
    url = fresh("new")
    Database(url).close()
    new = create_engine(url)
    assert {"robots", "logs", "jobs", "repeats", "keys"} <= set(layout(new))
    assert layout(stepped) == layout(new)
    new.dispose()


def test_a_database_at_the_last_step_is_taken_as_it_is(stepped):
    upgrade(stepped)
    with stepped.connect() as connection:
        assert revision(connection) == LATEST
