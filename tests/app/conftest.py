import contextlib
import os

import pytest
from starlette.testclient import TestClient

from tests.app.planar_arm import csv_log, description
from tests.app.stubs import StubExecutor
from veritorque.app.main import create_app
from veritorque.app.settings import Settings

os.environ.setdefault("VERITORQUE_HOSTS", '["testserver"]')  # as the test client calls every service


@contextlib.contextmanager
def service(directory, executor=None, **settings):
    """Start the service on a directory; `client.executor` is the stub that stands for the science."""
    executor = executor or StubExecutor()
    chosen = Settings(data_dir=directory, **settings)
    with TestClient(create_app(chosen, executor=executor)) as client:
        client.executor = executor
        yield client


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A service shared by the tests of a file, whose jobs end at once."""
    executor = StubExecutor()
    executor.release.set()
    with service(tmp_path_factory.mktemp("data"), executor, max_upload_bytes=4_000_000) as client:
        yield client


@pytest.fixture(scope="session")
def log_bytes():
    return csv_log(seconds=4.0)


@pytest.fixture
def robot_id(client):
    return client.post("/v1/robots", json=description()).json()["id"]


@pytest.fixture
def log_id(client, log_bytes):
    return client.post("/v1/logs", content=log_bytes, headers={"Content-Type": "text/csv"}).json()["id"]


def assert_problem(response, status, kind):
    """Check that an answer is a whole problem document, and give it."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert set(problem) == {"type", "title", "status", "detail", "cause", "evidence", "remedy"}
    assert problem["type"] == f"urn:veritorque:problem:{kind}", problem
    assert problem["status"] == status
    assert problem["cause"]
    return problem
