"""What was accepted is computed, even if the service is stopped or dies meanwhile."""

import pytest

from app.store.records import JobRequestRecord
from app.store.store import Store
from tests.app.conftest import service
from tests.app.planar_arm import description
from tests.app.stubs import StubExecutor
from tests.app.test_jobs import asked, state_of


def test_a_job_that_ran_when_the_service_stopped_is_computed_after_the_restart(tmp_path, log_bytes):
    executor = StubExecutor()
    with service(tmp_path, executor) as client:
        path = client.post("/v1/jobs", json=asked(client, log_bytes)).headers["location"]
        executor.started.wait(5.0)
    executor = StubExecutor()
    executor.release.set()
    with service(tmp_path, executor) as client:
        state_of(client, path, ("successful",))


def test_robots_logs_and_results_survive_a_restart(tmp_path, log_bytes):
    executor = StubExecutor()
    executor.release.set()
    with service(tmp_path, executor) as client:
        job = client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=10"}).json()
        paths = [f"/v1/robots/{job['robot']}", f"/v1/logs/{job['logs'][0]}", job["links"]["results"]]
        before = [client.get(path).content for path in paths]
    with service(tmp_path) as client:
        assert [client.get(path).content for path in paths] == before


def test_a_job_that_took_the_service_down_again_and_again_fails(tmp_path):
    store = Store(tmp_path)
    job = store.jobs.add(JobRequestRecord("identify", "yumi-left", (), {}))
    for _ in range(2):
        assert store.jobs.claim().state == "running"
        store.jobs.recover({"cause": "crashed"})
        assert store.jobs.get(job.id).state == "accepted"
    store.jobs.claim()
    store.jobs.recover({"cause": "crashed"})
    assert store.jobs.get(job.id).state == "failed"
    assert store.jobs.get(job.id).problem == {"cause": "crashed"}
    store.close()


def test_stopping_in_good_order_does_not_count_as_an_attempt(tmp_path):
    store = Store(tmp_path)
    job = store.jobs.add(JobRequestRecord("identify", "yumi-left", (), {}))
    for _ in range(5):
        store.jobs.claim()
        store.jobs.put_back(job.id)
    assert store.jobs.get(job.id).attempts == 0
    store.close()


def test_no_job_is_taken_twice(tmp_path):
    store = Store(tmp_path)
    ids = [store.jobs.add(JobRequestRecord("identify", "r", (), {})).id for _ in range(3)]
    taken = [store.jobs.claim() for _ in range(4)]
    assert [job and job.id for job in taken] == [*ids, None]
    store.close()


@pytest.mark.parametrize("change", ["succeed", "fail", "report", "put_back"])
def test_a_dismissed_job_stays_dismissed(tmp_path, change):
    store = Store(tmp_path)
    job = store.jobs.add(JobRequestRecord("identify", "r", (), {}))
    store.jobs.claim()
    store.jobs.dismiss(job.id)
    arguments = {
        "succeed": {"result_sha256": "ab"},
        "fail": {"problem": {}},
        "report": {"stage": "late", "fraction": 0.9},
        "put_back": {},
    }[change]
    getattr(store.jobs, change)(job.id, **arguments)
    now = store.jobs.get(job.id)
    assert (now.state, now.stage, now.result_sha256) == ("dismissed", "starting", None)
    store.close()


def test_a_result_that_nobody_wants_any_more_is_not_kept(tmp_path):
    store = Store(tmp_path)
    job = store.jobs.add(JobRequestRecord("identify", "r", (), {}))
    store.jobs.claim()
    store.jobs.dismiss(job.id)
    assert not store.keep_result(job.id, b"{}")
    assert not [path for path in (tmp_path / "blobs" / "kept").rglob("*") if path.is_file()]
    store.close()


def test_a_half_received_file_of_an_earlier_run_is_removed(tmp_path):
    with service(tmp_path) as client:
        client.post("/v1/robots", json=description())
    leftover = tmp_path / "blobs" / "incoming" / "half"
    leftover.write_bytes(b"time,q_1")
    with service(tmp_path):
        assert not leftover.exists()
