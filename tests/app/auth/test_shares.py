"""Nobody takes more than their share: of requests, of jobs, of the disk."""

import shutil
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.app.conftest import assert_problem, service
from tests.app.jobs.test_jobs import another, asked
from tests.app.planar_arm import csv_log, description
from veritorque.app.auth.rate_limit import BURST_S, RateLimit
from veritorque.app.http import disk_reserve as disk
from veritorque.app.problems import Problem

CSV = {"Content-Type": "text/csv"}


def early_s(pace):
    """Ask as somebody; give by how much that was too early, s, None where it was not."""
    try:
        pace.count("somebody")
    except Problem as problem:
        return problem.evidence["early_s"]
    return None


@given(st.lists(st.floats(0.0, 3.0), max_size=60), st.floats(0.5, 20.0))
def test_in_no_span_of_time_do_more_requests_pass_than_the_pace_allows(pauses, per_second):
    now, passed = 0.0, []
    pace = RateLimit(per_second, clock=lambda: now)
    for pause in pauses:
        now += pause
        early = early_s(pace)
        if early is not None:
            now += early + 1e-6
            assert early_s(pace) is None  # whoever waits as long as told is let through
        passed.append(now)
    at_once = max(1.0, BURST_S * per_second)
    for first in range(len(passed)):
        for last in range(first, len(passed)):
            assert last - first + 1 <= at_once + per_second * (passed[last] - passed[first]) + 1e-3


def test_callers_do_not_slow_each_other():
    pace = RateLimit(1.0, clock=lambda: 0.0)
    for _ in range(int(BURST_S)):
        pace.count("one")
    with pytest.raises(Problem):
        pace.count("one")
    pace.count("other")


def test_who_asks_too_often_is_told_when_to_come_back(tmp_path):
    with service(tmp_path, requests_per_second=0.5) as client:
        answers = [client.get("/v1/jobs") for _ in range(4)]
        assert [answer.status_code for answer in answers] == [200, 200, 429, 429]
        assert_problem(answers[-1], 429, "too-many")
        assert int(answers[-1].headers["retry-after"]) >= 1
        assert client.get("/healthz").status_code == 200


def test_who_guesses_keys_is_held_up(tmp_path):
    with service(tmp_path, requests_per_second=0.5) as client:
        guesses = [client.get("/v1/jobs", headers={"Authorization": f"Bearer vt_{n}"}) for n in range(3)]
        assert [answer.status_code for answer in guesses] == [401, 401, 429]


def test_a_tenant_has_no_more_unfinished_jobs_than_it_may(tmp_path, log_bytes):
    with service(tmp_path, queued_per_tenant=2) as client:
        body = asked(client, log_bytes)
        first = client.post("/v1/jobs", json=body)
        assert client.post("/v1/jobs", json=another(body)).status_code == 202
        refused = client.post("/v1/jobs", json=another(body, 2))
        problem = assert_problem(refused, 429, "quota")
        assert problem["evidence"] == {"unfinished jobs": 2}
        assert "VERITORQUE_QUEUED_PER_TENANT" in problem["remedy"]
        assert refused.headers["retry-after"]
        assert client.post("/v1/jobs", json=body).json()["id"] == first.json()["id"]
        client.delete(first.headers["location"])
        assert client.post("/v1/jobs", json=another(body, 2)).status_code == 202


def test_a_tenant_stores_no_more_than_it_may(tmp_path, log_bytes):
    with service(tmp_path, stored_bytes_per_tenant=len(log_bytes) + 1000) as client:
        first = client.post("/v1/logs", content=log_bytes, headers=CSV)
        assert first.status_code == 201
        other = csv_log(seconds=3.0)
        assert_problem(client.post("/v1/logs", content=other, headers=CSV), 429, "quota")
        assert len(list((tmp_path / "blobs" / "kept").glob("*/*"))) == 1
        assert len(client.get("/v1/logs").json()["logs"]) == 1
        assert client.post("/v1/logs", content=log_bytes, headers=CSV).status_code == 201
        client.delete(first.headers["location"])
        assert client.post("/v1/logs", content=other, headers=CSV).status_code == 201


@pytest.fixture
def free(monkeypatch):
    """Say how much of the disk is free."""
    left = [0]
    monkeypatch.setattr(disk.shutil, "disk_usage", lambda _: SimpleNamespace(free=left[0]))
    return left


def test_nothing_is_taken_where_the_reserve_would_be_touched_and_deleting_still_works(
    tmp_path, log_bytes, free
):
    with service(tmp_path, disk_reserve_bytes=1000) as client:
        free[0] = 10**9
        body = asked(client, log_bytes)
        free[0] = len(log_bytes) + 999
        problem = assert_problem(client.post("/v1/logs", content=log_bytes, headers=CSV), 507, "disk-full")
        assert problem["evidence"]["left_bytes"] == len(log_bytes) - 1
        assert client.post("/v1/robots", json=description()).status_code == 201
        free[0] = 999
        assert_problem(client.post("/v1/robots", json=description()), 507, "disk-full")
        assert_problem(client.post("/v1/jobs", json=body), 507, "disk-full")
        assert client.get("/v1/jobs").status_code == 200
        assert client.delete(f"/v1/logs/{body['logs'][0]}").status_code == 204


def test_a_body_of_unknown_length_ends_where_the_reserve_begins(tmp_path, free):
    def pieces():
        yield b"time,q_1\n"
        for _ in range(40):
            free[0] -= 1 << 20
            yield b"0" * (1 << 20)

    with service(tmp_path, disk_reserve_bytes=1000) as client:
        free[0] = 10 << 20
        assert_problem(client.post("/v1/logs", content=pieces(), headers=CSV), 507, "disk-full")


def test_a_disk_that_is_full_all_the_same_is_a_problem_too(tmp_path, log_bytes, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    with service(tmp_path) as client:
        monkeypatch.setattr("veritorque.app.store.blobs.incoming.os.fsync", full)
        assert_problem(client.post("/v1/logs", content=log_bytes, headers=CSV), 507, "disk-full")


def test_the_reserve_is_measured_on_the_disk_of_the_data(tmp_path):
    assert disk.DiskReserve(tmp_path, 0).left == pytest.approx(shutil.disk_usage(tmp_path).free, rel=0.05)
