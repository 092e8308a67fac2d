"""Full disks, locked databases, clocks that jump, damaged bytes: a typed problem or a retry, never a loss."""

import contextlib
import errno
import os
import signal
import sqlite3
import subprocess
import threading
import time
from datetime import UTC, datetime, timedelta

import pytest

from tests.app import work
from tests.app.conftest import assert_problem, service
from tests.app.jobs.test_executor import COMPUTATION
from tests.app.jobs.test_jobs import another, asked, state_of
from tests.app.stubs import InlineExecutor, StubExecutor
from veritorque.app.jobs import worker as worker_module
from veritorque.app.jobs.computation import Died, Stopped, Workspace
from veritorque.app.jobs.executors.process_executor import ProcessExecutor
from veritorque.app.store import tables
from veritorque.app.store.errors import UnavailableError

MIB = 1024**2


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    monkeypatch.setattr(worker_module, "PAUSE_S", 0.05)
    monkeypatch.setattr("veritorque.app.store.database.PATIENCE_S", 0.3)


@pytest.fixture
def small_disk(tmp_path):
    """A disk of 8 MiB, which only an administrator can make."""
    disk = tmp_path / "disk"
    disk.mkdir()
    made = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=8m", "none", str(disk)], capture_output=True, check=False
    )
    if made.returncode:
        pytest.skip("SKIPPED FOR WANT OF A DISK: only an administrator can make a small one")
    yield disk
    subprocess.run(["umount", "-l", str(disk)], check=True)


def free(client):
    executor = client.executor
    executor.release.set()
    return executor


def test_an_upload_that_fills_the_disk_is_refused_and_leaves_nothing_behind(small_disk, log_bytes):
    with service(small_disk / "data", disk_reserve_bytes=0) as client:
        request = asked(client, log_bytes)
        upload = {"content": log_bytes + b"\n" * 9 * MIB, "headers": {"Content-Type": "text/csv"}}
        assert_problem(client.post("/v1/logs", **upload), 507, "disk-full")
        assert list((small_disk / "data" / "blobs" / "incoming").iterdir()) == []
        free(client)
        answer = client.post("/v1/jobs", json=request, headers={"Prefer": "wait=20"})
        assert answer.json()["state"] == "successful"


def test_a_job_that_ends_while_the_disk_is_full_is_successful_once_there_is_room(small_disk, log_bytes):
    with service(small_disk / "data", disk_reserve_bytes=0) as client:
        path = client.post("/v1/jobs", json=asked(client, log_bytes)).headers["location"]
        client.executor.started.wait(10.0)
        ballast = small_disk / "ballast"
        with ballast.open("wb", buffering=0) as file, contextlib.suppress(OSError):
            while True:  # until nothing is left
                file.write(b"\0" * 4096)
        free(client)
        time.sleep(0.5)
        assert client.get(path).json()["state"] == "running"
        refused = client.post("/v1/jobs", json=another(asked_again(client, path)))
        assert refused.status_code in (202, 507)  # SQLite may have room left in its log
        ballast.unlink()
        state_of(client, path, ("successful",), 20.0)
    with service(small_disk / "data", disk_reserve_bytes=0) as client:
        assert client.get(path + "/results").status_code == 200


def asked_again(client, path):
    job = client.get(path).json()
    return {"kind": job["kind"], "robot": job["robot"], "logs": job["logs"], "options": {}}


@pytest.mark.parametrize(
    "trouble", [OSError(errno.ENOSPC, "No space left on device"), UnavailableError("locked")]
)
def test_an_outcome_that_cannot_be_written_is_written_later(tmp_path, log_bytes, monkeypatch, trouble):
    with service(tmp_path) as client:
        store = client.app.state.services.store
        keep, tries = store.keep_result, []

        def keep_at_third(held, *kept):
            tries.append(held)
            if len(tries) < 3:
                raise trouble
            return keep(held, *kept)

        monkeypatch.setattr(store, "keep_result", keep_at_third)
        free(client)
        answer = client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=20"})
        assert answer.json()["state"] == "successful"
        assert len(set(tries)) == 1


def test_a_locked_database_is_a_problem_that_says_so_and_a_retry_succeeds(tmp_path, log_bytes):
    with service(tmp_path) as client:
        request = asked(client, log_bytes)
        other = sqlite3.connect(tmp_path / "veritorque.sqlite", isolation_level=None)
        other.execute("BEGIN IMMEDIATE")
        problem = assert_problem(client.post("/v1/jobs", json=request), 503, "unavailable")
        assert "locked" in problem["evidence"]["reason"]
        assert client.get("/v1/jobs").json()["jobs"] == []  # reads go on
        other.close()
        free(client)
        answer = client.post("/v1/jobs", json=request, headers={"Prefer": "wait=20"})
        assert answer.json()["state"] == "successful"


def test_a_worker_hands_back_what_the_database_gave_it_without_its_knowing(tmp_path, log_bytes, monkeypatch):
    monkeypatch.setattr(worker_module, "HEARTBEAT_S", 0.1)
    with service(tmp_path) as client:
        free(client)
        claim, cut = client.app.state.services.store.work.claim, threading.Event()

        def claim_and_lose_the_answer(owner, *, most_per_tenant):
            job = claim(owner, most_per_tenant=most_per_tenant)
            if job is not None and not cut.is_set():
                cut.set()
                raise UnavailableError("the connection was closed")
            return job

        monkeypatch.setattr(client.app.state.services.store.work, "claim", claim_and_lose_the_answer)
        answer = client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=20"})
        assert cut.is_set()
        assert answer.json()["state"] == "successful"


@pytest.mark.parametrize("hours", [-1, 1])
def test_a_clock_that_is_set_wrong_by_an_hour_meanwhile_changes_no_outcome_and_no_order(
    tmp_path, log_bytes, monkeypatch, hours
):
    shift = timedelta()

    class Clock(datetime):
        @classmethod
        def now(cls, zone=None):
            return datetime.now(zone) + shift

    monkeypatch.setattr(tables, "datetime", Clock)
    with service(tmp_path, retention_days={"successful": 0.5, "repeats": 0.5}) as client:
        request, paths = asked(client, log_bytes), []
        for number in range(4):
            paths.append(client.post("/v1/jobs", json=another(request, number)).headers["location"])
            shift = timedelta(hours=hours * (number % 2))
        client.executor.started.wait(10.0)
        free(client)
        for path in paths:
            state_of(client, path, ("successful",), 20.0)
        listed = [job["links"]["self"] for job in client.get("/v1/jobs").json()["jobs"]]
        assert listed == paths[::-1]
        assert client.get("/").status_code == 200
    assert abs(datetime.now(UTC) - Clock.now(UTC)) < timedelta(hours=1.1)


def test_a_damaged_result_is_never_handed_out(tmp_path, log_bytes):
    with service(tmp_path) as client:
        free(client)
        job = client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=20"}).json()
        store = client.app.state.services.store
        sha256 = store.of("local").jobs.get(job["id"]).result_sha256
        path = store.blobs.path(sha256)
        for spoil in (lambda: path.write_bytes(path.read_bytes().replace(b"0", b"1", 1)), path.unlink):
            spoil()
            problem = assert_problem(client.get(job["links"]["results"]), 500, "damaged")
            assert problem["evidence"]["sha256"] == sha256
            assert_problem(client.get(job["links"]["report"]), 500, "damaged")


def test_a_damaged_log_is_never_computed_on(tmp_path, log_bytes):
    with service(tmp_path, InlineExecutor(), workers=0) as client:
        request = asked(client, log_bytes)
        path = client.post("/v1/jobs", json=request).headers["location"]
        store = client.app.state.services.store
        log = store.blobs.path(store.of("local").logs.get(request["logs"][0]).sha256)
        log.write_bytes(log.read_bytes().replace(b"1", b"2", 1))
    executor = ProcessExecutor()
    with service(tmp_path, executor) as client:
        job = state_of(client, path, ("failed",), 60.0)
        assert job["problem"]["type"] == "urn:veritorque:problem:damaged"


def test_a_signal_to_all_processes_of_the_service_ends_no_computation_behind_its_workers_back():
    stop, ended = threading.Event(), []

    def compute():
        ended.append(executor.run(COMPUTATION, Workspace(), progress=hit, stop=stop, timeout_s=60.0))

    def hit(stage, fraction):
        os.kill(int(stage), signal.SIGTERM)
        told.set()

    executor, told = ProcessExecutor(work.name_yourself, preload=()), threading.Event()
    computing = threading.Thread(target=compute)
    computing.start()
    assert told.wait(60.0)
    time.sleep(0.3)
    assert ended == []
    stop.set()
    computing.join()
    assert ended == [Stopped()]


def test_a_computation_that_cannot_be_started_is_tried_again(tmp_path, log_bytes, monkeypatch):
    class Hapless(StubExecutor):
        def run(self, computation, workspace, **how):
            if not self.computations:
                self.computations.append(computation)
                return Died({"type": "urn:veritorque:problem:computation-stopped"})
            return super().run(computation, workspace, **how)

    with service(tmp_path, Hapless()) as client:
        free(client)
        answer = client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=20"})
        assert answer.json()["state"] == "successful"
        assert len(client.executor.computations) == 2


def test_without_processes_to_be_had_a_computation_counts_as_died(monkeypatch):
    executor = ProcessExecutor(work.echo, preload=())
    monkeypatch.setattr(executor._context.Process, "start", _refuse)
    outcome = executor.run(COMPUTATION, Workspace(), progress=print, stop=threading.Event(), timeout_s=5.0)
    assert isinstance(outcome, Died)


def _refuse(process):
    raise BlockingIOError(errno.EAGAIN, "Resource temporarily unavailable")
