"""Whoever follows a job hears of every change, wherever it is computed, and takes up where it stopped."""

import http.client
import json
import threading
import time
from contextlib import contextmanager

import pytest

from tests.app.conftest import assert_problem, service
from tests.app.http.test_server import listening_service
from tests.app.stubs import add_job
from veritorque.app.routes import events
from veritorque.app.schemas.jobs import Job
from veritorque.app.services.job_feed import POLL_S
from veritorque.app.store.records import JobRequestRecord
from veritorque.app.store.store import Store

REQUEST = JobRequestRecord("identify", "yumi", ("log-1",), {})


@pytest.fixture
def computing(tmp_path):
    """The database as another process sees it that computes the jobs."""
    store = Store(tmp_path)
    yield store
    store.close()


@pytest.fixture
def port(tmp_path):
    with listening_service(tmp_path, workers=0) as (_, port):
        yield port


@contextmanager
def following(port, job, **headers):
    """Follow a job; gives what reads the next event, None at the end."""
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=5.0)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    link.request("GET", f"/v1/jobs/{job.id}/events", headers=named)
    answer = link.getresponse()
    assert answer.status == 200
    assert answer.headers["content-type"].startswith("text/event-stream")
    try:
        yield lambda: next_event(answer)
    finally:
        link.close()


def next_event(answer):
    """Read one event as its fields; comments stand under the empty name, `retry` alone is left out."""
    fields = {}
    while line := answer.readline():
        if line.strip():
            name, _, value = line.decode().rstrip("\n").partition(":")
            fields[name] = value.strip()
        elif set(fields) - {"retry"}:
            return fields
    return None


def test_every_change_is_told_and_the_last_ends_the_stream(port, computing):
    job = add_job(computing.of("local").jobs, REQUEST)
    with following(port, job) as read:
        first = read()
        assert (first["event"], json.loads(first["data"])["state"]) == ("progress", "accepted")
        taken = computing.work.claim("elsewhere", most_per_tenant=1)
        assert json.loads(read()["data"])["progress"] == {"stage": "starting", "fraction": 0.0}
        held = (taken.id, taken.token)
        computing.work.report(held, stage="estimate", fraction=0.5)
        assert json.loads(read()["data"])["progress"] == {"stage": "estimate", "fraction": 0.5}
        computing.keep_result(held, b"{}")
        last = read()
        assert (last["event"], Job.model_validate_json(last["data"]).state) == ("end", "successful")
        assert read() is None
    assert int(last["id"]) > int(first["id"])
    assert {*first, *last, "retry"} == set(events.EVENT["properties"])


def test_who_comes_back_hears_of_what_is_new_even_after_a_restart(tmp_path, computing):
    job = add_job(computing.of("local").jobs, REQUEST)
    with listening_service(tmp_path, workers=0) as (_, port), following(port, job) as read:
        heard = read()["id"]
    with listening_service(tmp_path, workers=0) as (_, port):
        with following(port, job, Last_Event_ID=heard) as read:
            computing.of("local").jobs.dismiss(job.id)
            event = read()
            assert json.loads(event["data"])["state"] == "dismissed"
            assert read() is None
        with following(port, job, Last_Event_ID=heard) as read:
            assert read() == event


def test_who_has_heard_the_end_is_told_not_to_come_back(client, robot_id, log_id):
    asked = {"kind": "identify", "robot": robot_id, "logs": [log_id], "options": {"essential": True}}
    answer = client.post("/v1/jobs", json=asked, headers={"Prefer": "wait=10"})
    path = f"/v1/jobs/{answer.json()['id']}/events"
    ident = next(line for line in client.get(path).text.splitlines() if line.startswith("id: "))
    again = client.get(path, headers={"Last-Event-ID": ident.removeprefix("id: ")})
    assert (again.status_code, again.content) == (204, b"")
    assert "event: end" in client.get(path, headers={"Last-Event-ID": "none of ours"}).text
    assert client.head(path).status_code == 200


def test_a_job_that_does_not_exist_has_no_events(client):
    assert_problem(client.get("/v1/jobs/none/events"), 404, "not-found")


def test_silence_is_filled_with_heartbeats(port, computing, monkeypatch):
    monkeypatch.setattr(events, "HEARTBEAT_S", 0.05)
    with following(port, add_job(computing.of("local").jobs, REQUEST)) as read:
        read()
        assert read() == read() == {"": "alive"}


def test_a_stream_ends_at_once_when_the_service_does(tmp_path, computing):
    job = add_job(computing.of("local").jobs, REQUEST)
    with listening_service(tmp_path, workers=0) as (server, port), following(port, job) as read:
        read()
        begun = time.monotonic()
        server.should_exit = True
        assert read() is None
        assert time.monotonic() - begun < 2.0


def test_many_who_follow_share_one_look_at_the_database(tmp_path, computing, monkeypatch):
    job = add_job(computing.of("local").jobs, REQUEST)
    with listening_service(tmp_path, workers=0) as (server, port):
        feed = server._app.state.services.feed
        asked = []
        plain = feed._jobs.versions
        monkeypatch.setattr(feed._jobs, "versions", lambda places: asked.append(places) or plain(places))
        heard = []

        def follow():
            with following(port, job) as read:
                heard.append([event["event"] for event in iter(read, None)])

        threads = [threading.Thread(target=follow) for _ in range(20)]
        for thread in threads:
            thread.start()
        time.sleep(1.0)
        looks = len(asked)
        computing.of("local").jobs.dismiss(job.id)
        for thread in threads:
            thread.join()
    assert heard == 20 * [["progress", "end"]]
    assert set(asked) == {(("local", job.id),)}
    assert looks <= 1.5 / POLL_S  # one look for all at a time, not one for each of twenty


def test_a_key_of_another_tenant_follows_nothing(tmp_path, computing):
    job = add_job(computing.of("other").jobs, REQUEST)
    with service(tmp_path) as client:
        assert_problem(client.get(f"/v1/jobs/{job.id}/events"), 404, "not-found")
        assert_problem(client.get(f"/v1/jobs/{job.id}"), 404, "not-found")
