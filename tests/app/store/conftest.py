import pytest

from tests.app.postgres import cluster, new_database
from veritorque.app.store.store import Store


@pytest.fixture(scope="session")
def postgres():
    with cluster() as folder:
        yield folder


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request):
    """Name an empty database of either kind; None is the one in the data directory."""
    if request.param == "sqlite":
        return None
    pytest.importorskip("psycopg", reason="SKIPPED FOR WANT OF PSYCOPG: pip install veritorque[postgres]")
    return new_database(request.getfixturevalue("postgres"))


@pytest.fixture
def store(tmp_path, database_url):
    opened = Store(tmp_path, database_url)
    yield opened
    opened.close()
