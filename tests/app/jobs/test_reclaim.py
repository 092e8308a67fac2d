"""Jobs of a worker that is gone or silent are taken back, by a steady clock and not by the time of day."""

import subprocess
import sys

import pytest

from tests.app.stubs import add_job
from veritorque.app.jobs.liveness import Presence
from veritorque.app.jobs.reclaim import LEASE_S, Reclaimer
from veritorque.app.store.records import JobRequestRecord
from veritorque.app.store.store import Store
from veritorque.app.store.work import MOST_ATTEMPTS

HOLDS = """
import sys, time
from pathlib import Path
from veritorque.app.jobs.liveness import Presence

print(Presence(Path(sys.argv[1])).name, flush=True)
time.sleep(60)
"""


class Clock:
    """Stand still until it is moved."""

    now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def store(tmp_path):
    opened = Store(tmp_path)
    yield opened
    opened.close()


@pytest.fixture
def mine(tmp_path):
    presence = Presence(tmp_path / "workers")
    yield presence
    presence.leave()


def claimed(store, owner):
    jobs = store.of("local").jobs
    job = add_job(jobs, JobRequestRecord("identify", "arm", (), {}))
    assert store.work.claim(owner, most_per_tenant=9).id == job.id
    return lambda: jobs.get(job.id)


def test_the_job_of_a_process_that_was_killed_is_taken_back_at_once(store, mine, tmp_path):
    arguments = [sys.executable, "-c", HOLDS, str(tmp_path / "workers")]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as other:
        name = other.stdout.readline().strip()
        job = claimed(store, name)
        reclaimer = Reclaimer(store, mine, clock=Clock())
        assert (reclaimer.run(), job().state) == (0, "running")
        other.kill()
        other.wait()
        assert (reclaimer.run(), job().state) == (1, "accepted")
    assert not (tmp_path / "workers" / name).exists()


def test_the_job_of_a_worker_elsewhere_is_taken_back_when_its_beats_stop(store, mine):
    job, clock = claimed(store, "elsewhere"), Clock()
    reclaimer = Reclaimer(store, mine, clock=clock)
    for _ in range(5):
        clock.now += 0.9 * LEASE_S
        store.work.beat("elsewhere")
        assert (reclaimer.run(), job().state) == (0, "running")
    clock.now += 1.1 * LEASE_S
    assert (reclaimer.run(), job().state) == (1, "accepted")


def test_a_watcher_that_was_frozen_itself_takes_nothing_from_those_who_worked(store, mine):
    job, clock = claimed(store, "elsewhere"), Clock()
    reclaimer = Reclaimer(store, mine, clock=clock)
    reclaimer.run()
    clock.now += 100.0 * LEASE_S
    store.work.beat("elsewhere")
    assert (reclaimer.run(), job().state) == (0, "running")


def test_a_job_whose_workers_go_silent_again_and_again_fails(store, mine):
    job, clock = claimed(store, "elsewhere"), Clock()
    reclaimer = Reclaimer(store, mine, clock=clock)
    for attempt in range(MOST_ATTEMPTS):
        if attempt:
            store.work.claim("elsewhere", most_per_tenant=9)
        reclaimer.run()
        clock.now += 1.1 * LEASE_S
        reclaimer.run()
    assert job().state == "failed"
    assert "3 times" in job().problem["cause"]
