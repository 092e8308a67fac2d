import pytest

from tests.app.http.test_server import listening_service
from tests.app.stubs import StubExecutor
from veritorque.app.client.client import Client


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """A service that listens, whose jobs end at once; gives a client for it."""
    executor = StubExecutor()
    executor.release.set()
    with (
        listening_service(tmp_path_factory.mktemp("data"), executor) as (_, port),
        Client(f"http://127.0.0.1:{port}") as client,
    ):
        yield client
