"""What was accepted is computed, even if the service is stopped or dies meanwhile."""

from tests.app.conftest import service
from tests.app.jobs.test_jobs import asked, state_of
from tests.app.planar_arm import description
from tests.app.stubs import StubExecutor


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


def test_a_half_received_file_of_an_earlier_run_is_removed(tmp_path):
    with service(tmp_path) as client:
        client.post("/v1/robots", json=description())
    leftover = tmp_path / "blobs" / "incoming" / "half"
    leftover.write_bytes(b"time,q_1")
    with service(tmp_path):
        assert not leftover.exists()
