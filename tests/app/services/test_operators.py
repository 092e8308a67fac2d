"""Operators learn what the service does: is it ready, what has it done, and what happened to whom."""

import json
import logging
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest
from prometheus_client.parser import text_string_to_metric_families

from tests.app.conftest import assert_problem, service
from tests.app.jobs.test_jobs import asked
from tests.app.stubs import StubExecutor, failing
from veritorque.app import logging as journal
from veritorque.app.http.request_log import trace_id
from veritorque.app.settings import Settings
from veritorque.app.store.store import Store

TRACE = "4bf92f3577b34da6a3ce929d0e0e4736"
TRACEPARENT = f"00-{TRACE}-00f067aa0ba902b7-01"


def figures(client):
    """Read all samples as {(name, labels): value}."""
    text = client.get("/metrics").text
    families = text_string_to_metric_families(text)
    return {
        (sample.name, tuple(sorted(sample.labels.items()))): sample.value
        for family in families
        for sample in family.samples
    }


def test_a_disk_below_its_reserve_makes_the_service_not_ready(tmp_path):
    with service(tmp_path, disk_reserve_bytes=10**18) as client:
        problem = assert_problem(client.get("/readyz"), 503, "not-ready")
    assert problem["evidence"]["free_bytes"] < problem["evidence"]["reserve_bytes"] == 10**18


def test_a_database_that_takes_no_writes_makes_the_service_not_ready(tmp_path, monkeypatch):
    monkeypatch.setattr("veritorque.app.store.database.PATIENCE_S", 0.2)
    with service(tmp_path) as client:
        assert client.get("/readyz").status_code == 200
        other = sqlite3.connect(tmp_path / "veritorque.sqlite", isolation_level=None)
        other.execute("BEGIN IMMEDIATE")
        time.sleep(1.1)  # what was found stands for a second
        problem = assert_problem(client.get("/readyz"), 503, "not-ready")
        other.close()
        time.sleep(1.1)
        assert client.get("/readyz").status_code == 200
    assert "locked" in problem["evidence"]["reason"]


def test_jobs_and_requests_are_counted_by_state_outcome_and_route(tmp_path, log_bytes):
    executor = failing("excitation")
    executor.release.set()
    with service(tmp_path, executor) as client:
        request = asked(client, log_bytes)
        client.post("/v1/jobs", json=request, headers={"Prefer": "wait=10"})
        for identity in ("one", "two", "three"):
            client.get(f"/v1/jobs/{identity}")
        client.head("/v1/jobs/four")
        client.get("/elsewhere")
        seen = figures(client)
    count = "veritorque_http_request_duration_seconds_count"
    job = {"route": "/v1/jobs/{job_id}", "status": "404"}
    assert seen[count, tuple(sorted({**job, "method": "GET"}.items()))] == 3
    assert seen[count, tuple(sorted({**job, "method": "HEAD"}.items()))] == 1
    assert seen[count, (("method", "GET"), ("route", "none"), ("status", "404"))] == 1
    assert seen["veritorque_jobs", (("state", "failed"),)] == 1
    ended = (("kind", "identify"), ("outcome", "failed"))
    assert seen["veritorque_job_duration_seconds_count", ended] == 1
    assert seen["veritorque_job_problems_total", (("problem", "excitation"),)] == 1


def test_the_depth_of_the_queue_is_what_waits_and_not_what_runs(tmp_path, log_bytes):
    executor = StubExecutor()
    with service(tmp_path, executor) as client:
        request = asked(client, log_bytes)
        for draws in (20, 30, 40):
            client.post("/v1/jobs", json=request | {"options": {"bootstrap": {"draws": draws}}})
        executor.started.wait(5.0)
        seen = figures(client)
    assert seen["veritorque_queue_depth", ()] == 2
    assert seen["veritorque_jobs", (("state", "running"),)] == 1


def test_no_label_holds_what_a_client_made_up(tmp_path):
    with service(tmp_path) as client:
        client.get("/v1/robots/made-up")
        client.request("MADEUP", "/v1/robots")
        assert "made-up" not in client.get("/metrics").text
        assert "MADEUP" not in client.get("/metrics").text


def test_figures_of_all_tenants_take_a_key_of_scope_admin(tmp_path):
    with service(tmp_path, host="0.0.0.0") as client:  # noqa: S104 - nothing listens in this test
        keys = client.app.state.services.keys._store
        for scopes, status in ((("read", "write"), 403), (("read", "admin"), 200)):
            _, secret = keys.create(tenant="one", name="key", scopes=scopes)
            client.app.state.services.keys._until = 0.0
            answer = client.get("/metrics", headers={"Authorization": f"Bearer {secret}"})
            assert answer.status_code == status
        assert_problem(client.get("/metrics"), 401, "no-key")


@pytest.mark.parametrize(
    "header",
    [
        None,
        "",
        "00-" + "0" * 32 + "-00f067aa0ba902b7-01",
        f"00-{TRACE}-{'0' * 16}-01",
        f"ff-{TRACE}-00f067aa0ba902b7-01",
        f"00-{TRACE}-00f067aa0ba902b7-01-more",
        f"00-{TRACE.upper()}-00f067aa0ba902b7-01",
        f"00-{TRACE}-00f067aa0ba902b7-01\n",
    ],
)
def test_a_trace_that_is_not_valid_is_replaced_by_a_new_one(header):
    given = trace_id(header)
    assert given != TRACE
    assert int(given, 16)
    assert given != trace_id(header)


def test_a_later_version_of_the_trace_header_may_say_more():
    assert trace_id(f"01-{TRACE}-00f067aa0ba902b7-01-more") == TRACE


def test_a_line_about_a_job_carries_its_id_and_the_trace_of_its_request(tmp_path, log_bytes, capsys):
    root = logging.getLogger()
    before = root.handlers, root.level
    try:
        journal.configure_logging(Settings(data_dir=tmp_path))
        executor = StubExecutor()
        executor.release.set()
        with service(tmp_path, executor) as client:
            headers = {"Prefer": "wait=10", "traceparent": TRACEPARENT}
            answer = client.post("/v1/jobs", json=asked(client, log_bytes), headers=headers)
    finally:
        root.handlers, root.level = before
    lines = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
    computed = next(line for line in lines if line["event"] == "computed")
    assert computed["job"] == answer.json()["id"]
    assert computed["trace"] == TRACE
    assert computed["outcome"] == "successful"
    answered = next(line for line in lines if line.get("path") == "/v1/jobs")
    assert answered["request"] == answer.headers["x-request-id"]
    assert answered["trace"] == TRACE
    assert answered["status"] == 200


def test_a_job_that_computes_when_the_service_is_told_to_end_is_handed_back(tmp_path, log_bytes):
    """The service runs as it does for users, with its worker process beside it."""
    script = (
        "import sys; from veritorque.app.jobs import worker_process as process\n"
        "from veritorque.app.jobs.executors.process_executor import ProcessExecutor\n"
        "from veritorque.app.terminal.main import main; from tests.app import work\n"
        "process.executor_of = lambda settings, store: ProcessExecutor(work.sleep, preload=())\n"
        "if __name__ == '__main__': main()\n"
    )
    (tmp_path / "sleepy.py").write_text(script)
    job = _accepted(tmp_path, log_bytes)
    environment = {**os.environ, "VERITORQUE_DATA_DIR": str(tmp_path / "data"), "PYTHONPATH": str(Path.cwd())}
    worker = subprocess.Popen([sys.executable, str(tmp_path / "sleepy.py"), "work"], env=environment)
    store = Store(tmp_path / "data")
    try:
        _until(lambda: store.of("local").jobs.get(job).stage == "sleep")
        worker.send_signal(signal.SIGTERM)
        assert worker.wait(30.0) == 0
        found = store.of("local").jobs.get(job)
        assert (found.state, found.attempts) == ("accepted", 0)
    finally:
        worker.kill()
        worker.wait()
        store.close()


def _accepted(tmp_path, log_bytes):
    with service(tmp_path / "data", workers=0) as client:
        return client.post("/v1/jobs", json=asked(client, log_bytes)).json()["id"]


def _until(reached, seconds=60.0):
    deadline = time.monotonic() + seconds
    while not reached() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert reached()
