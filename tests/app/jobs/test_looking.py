"""How often a worker looks for jobs: seldom at rest, and at once where it is told of one."""

import threading
import time

import pytest

from tests.app.stubs import StubExecutor
from veritorque.app.jobs.worker import LONGEST_POLL_S, POLL_S
from veritorque.app.services.workers import worker_of
from veritorque.app.settings import Settings
from veritorque.app.store.store import Store


@pytest.fixture
def looks(tmp_path, monkeypatch):
    """A worker with one slot that has not begun, the instants at which it looked, and what a look does."""
    store = Store(tmp_path)
    worker = worker_of(store, Settings(data_dir=tmp_path, workers=1), StubExecutor(), {}, None)
    instants, during = [], []

    def look():
        instants.append(time.monotonic())
        for one in during:
            one()

    monkeypatch.setattr(worker, "_claim", look)
    yield worker, instants, during
    worker.close()
    store.close()


def test_a_worker_at_rest_looks_for_jobs_a_few_times_a_second(looks):
    worker, instants, _ = looks
    worker.start()
    time.sleep(1.5)
    at_rest = [instant for instant in instants if instant > instants[0] + 0.75]
    assert 1 <= len(at_rest) <= 0.75 / LONGEST_POLL_S + 1


def test_a_notice_that_comes_during_a_look_is_not_lost(looks):
    worker, instants, during = looks
    told = threading.Event()
    worker.start()
    time.sleep(1.0)

    def tell():
        if not told.is_set():
            told.set()
            worker.wake()

    during.append(tell)
    assert told.wait(10.0)
    count = len(instants)
    deadline = time.monotonic() + 10.0
    while len(instants) == count and time.monotonic() < deadline:
        time.sleep(0.001)
    assert instants[count] - instants[count - 1] < 0.5 * LONGEST_POLL_S
    assert POLL_S < 0.5 * LONGEST_POLL_S
