import json
import time

import pytest

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import description
from tests.app.stubs import RESULT, StubExecutor, failing
from veritorque.app.json_text import json_bytes
from veritorque.app.schemas.jobs import Job
from veritorque.app.store.blobs.sweep import Sweep


@pytest.fixture
def executor():
    return StubExecutor()


@pytest.fixture
def slow(tmp_path, executor):
    """A service whose jobs run until they are released."""
    with service(tmp_path, executor) as client:
        yield client


@pytest.fixture
def request_body(slow, log_bytes):
    return asked(slow, log_bytes)


def asked(client, log_bytes):
    robot = client.post("/v1/robots", json=description()).json()["id"]
    log = client.post("/v1/logs", content=log_bytes, headers={"Content-Type": "text/csv"}).json()["id"]
    return {"kind": "identify", "robot": robot, "logs": [log], "options": {"essential": True}}


def another(body, number=1):
    """Ask for something else of the same robot and log."""
    return body | {"options": {"filter": {"cutoff_hz": 5.0 + number}}}


def state_of(client, path, until, seconds=5.0):
    """Follow a job until its state is one of those named."""
    deadline = time.monotonic() + seconds
    while (job := client.get(path).json())["state"] not in until and time.monotonic() < deadline:
        time.sleep(0.01)
    assert job["state"] in until
    return job


def test_a_job_is_accepted_runs_and_succeeds(slow, executor, request_body):
    answer = slow.post("/v1/jobs", json=request_body)
    path = answer.headers["location"]
    assert (answer.status_code, answer.json()["state"]) == (202, "accepted")
    assert answer.headers["retry-after"] == "1"
    executor.started.wait(5.0)
    running = slow.get(path).json()
    assert running["state"] == "running"
    assert running["progress"] == {"stage": "estimate", "fraction": 0.5}
    assert_problem(slow.get(path + "/results"), 409, "job-unfinished")
    executor.release.set()
    done = state_of(slow, path, ("successful",))
    assert done["progress"]["fraction"] == 1.0
    assert slow.get(done["links"]["results"]).content == json_bytes(RESULT)
    Job.model_validate(done)


def test_the_computation_gets_what_was_asked_for(slow, executor, request_body, log_bytes):
    slow.post("/v1/jobs", json=request_body)
    executor.started.wait(5.0)
    (computation,) = executor.computations
    assert computation.options == {"essential": True}
    (workspace,) = executor.workspaces
    assert workspace.files[computation.logs[0].sha256].read_bytes() == log_bytes
    assert computation.robot["name"] == "planar arm"


def test_a_client_that_waits_gets_the_finished_job(slow, executor, request_body):
    executor.release.set()
    answer = slow.post("/v1/jobs", json=request_body, headers={"Prefer": "wait=10"})
    assert (answer.status_code, answer.json()["state"]) == (200, "successful")
    assert answer.headers["preference-applied"] == "wait=10"


def test_a_client_that_waits_too_short_is_told_to_come_back(slow, request_body):
    answer = slow.post("/v1/jobs", json=request_body, headers={"Prefer": "wait=0"})
    assert answer.status_code == 202
    assert answer.headers["location"].startswith("/v1/jobs/")


def test_an_unchanged_job_is_not_sent_again(slow, executor, request_body):
    path = slow.post("/v1/jobs", json=request_body).headers["location"]
    executor.started.wait(5.0)
    first = slow.get(path)
    again = slow.get(path, headers={"If-None-Match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
    executor.release.set()
    state_of(slow, path, ("successful",))
    assert slow.get(path, headers={"If-None-Match": first.headers["etag"]}).status_code == 200


def test_dismissing_a_running_job_ends_its_computation(slow, executor, request_body):
    path = slow.post("/v1/jobs", json=request_body).headers["location"]
    executor.started.wait(5.0)
    answer = slow.delete(path)
    assert (answer.status_code, answer.json()["state"]) == (200, "dismissed")
    assert executor.stopped.wait(5.0)
    assert_problem(slow.get(path + "/results"), 409, "job-dismissed")
    assert slow.get(path).json()["state"] == "dismissed"


def test_a_dismissed_job_that_waited_is_never_computed(slow, executor, request_body):
    first = slow.post("/v1/jobs", json=request_body).headers["location"]
    executor.started.wait(5.0)
    second = slow.post("/v1/jobs", json=another(request_body)).headers["location"]
    slow.delete(second)
    executor.release.set()
    state_of(slow, first, ("successful",))
    time.sleep(0.05)
    assert len(executor.computations) == 1


def test_deleting_a_finished_job_removes_it_with_its_result(slow, executor, request_body):
    executor.release.set()
    job = slow.post("/v1/jobs", json=request_body, headers={"Prefer": "wait=10"}).json()
    store = slow.app.state.services.store
    result = store.blobs.path(store.of("local").jobs.get(job["id"]).result_sha256)
    sweep = Sweep(store)
    assert sweep.run() == 0
    assert slow.delete(f"/v1/jobs/{job['id']}").status_code == 204
    assert [sweep.run(), result.exists()] == [0, True]
    assert [sweep.run(), result.exists()] == [1, False]
    assert_problem(slow.get(f"/v1/jobs/{job['id']}"), 404, "not-found")


def test_a_failed_job_keeps_its_problem(tmp_path, log_bytes):
    executor = failing()
    executor.release.set()
    with service(tmp_path, executor) as client:
        body = asked(client, log_bytes)
        job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=10"}).json()
        assert (job["state"], job["problem"]["status"]) == ("failed", 422)
        problem = assert_problem(client.get(f"/v1/jobs/{job['id']}/results"), 409, "job-failed")
        assert problem["cause"] == "the motion is too slow"
        form = {"data": {"robot": body["robot"]}, "files": {"log": ("a.csv", log_bytes, "text/csv")}}
        assert_problem(client.post("/v1/identify", **form), 422, "excitation")


def test_jobs_are_listed_with_the_newest_first(slow, request_body):
    ids = [slow.post("/v1/jobs", json=another(request_body, n)).json()["id"] for n in range(3)]
    listed = slow.get("/v1/jobs?limit=2").json()
    assert [job["id"] for job in listed["jobs"]] == [ids[2], ids[1]]
    rest = slow.get(f"/v1/jobs?limit=2&cursor={listed['next']}").json()
    assert ([job["id"] for job in rest["jobs"]], rest["next"]) == ([ids[0]], None)
    assert_problem(slow.get("/v1/jobs?cursor=-1"), 422, "request")


def test_the_same_request_is_the_same_job_and_is_answered_at_once_when_it_is_done(
    slow, executor, request_body
):
    first, second = (slow.post("/v1/jobs", json=request_body) for _ in range(2))
    assert (second.status_code, second.json()["id"]) == (202, first.json()["id"])
    executor.release.set()
    state_of(slow, first.headers["location"], ("successful",))
    third = slow.post("/v1/jobs", json=request_body)
    assert (third.status_code, third.json()["state"]) == (200, "successful")
    assert len(executor.computations) == 1


def test_a_request_with_a_key_may_be_sent_twice_and_is_meant_once(slow, request_body):
    key = {"Idempotency-Key": "once"}
    first = slow.post("/v1/jobs", json=request_body, headers=key).json()
    slow.delete(f"/v1/jobs/{first['id']}")
    assert slow.post("/v1/jobs", json=request_body, headers=key).json()["id"] == first["id"]
    assert_problem(slow.post("/v1/jobs", json=another(request_body), headers=key), 422, "key-reused")
    assert slow.post("/v1/jobs", json=request_body).json()["id"] != first["id"]


def test_results_come_as_a_table_for_those_who_prefer_one(slow, executor, request_body):
    executor.release.set()
    job = slow.post("/v1/jobs", json=request_body, headers={"Prefer": "wait=10"}).json()
    path = job["links"]["results"]
    table = slow.get(path, headers={"Accept": "text/csv"})
    assert table.headers["content-type"].startswith("text/csv")
    header, row = table.text.splitlines()
    assert header.startswith("name,joint,unit,value,value_ols,")
    assert row == "ZZR1,1,kg m2,0.5,0.6,0.01,2.0,true,ZZ1 + YY2,plain,0.5"
    assert slow.get(path + "/parameters.csv").text == table.text
    assert "in_combination" in slow.get(path + "/standard_parameters.csv").text
    assert_problem(slow.get(path, headers={"Accept": "image/png"}), 406, "not-acceptable")
    assert_problem(slow.get(path + "/robot.docx"), 404, "not-found")


def test_whoever_has_a_result_is_not_sent_it_again(slow, executor, request_body):
    executor.release.set()
    job = slow.post("/v1/jobs", json=request_body, headers={"Prefer": "wait=60"}).json()
    forms = [
        (job["links"]["results"], {}),
        (job["links"]["results"], {"Accept": "text/csv"}),
        (job["links"]["results"], {"Accept": "text/html"}),
        (job["links"]["results"] + "/standard_parameters.csv", {}),
    ]
    tags = set()
    for path, headers in forms:
        first = slow.get(path, headers=headers)
        again = slow.get(path, headers=headers | {"If-None-Match": first.headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")
        for name in ("etag", "vary", "cache-control"):
            assert again.headers[name] == first.headers[name]
        # A browser that reads what it kept takes over whatever policy stands here.
        assert again.headers.get("content-security-policy") in (
            None,
            first.headers["content-security-policy"],
        )
        other = slow.get(path, headers=headers | {"If-None-Match": '"other"'})
        assert (other.status_code, other.content) == (200, first.content)
        tags.add(first.headers["etag"])
    assert len(tags) == len(forms)


def test_one_request_answers_the_result_document(slow, executor, log_bytes):
    executor.release.set()
    form = {"robot": (None, json.dumps(description())), "log": ("a.csv", log_bytes, "text/csv")}
    answer = slow.post("/v1/identify", files=form)
    assert (answer.status_code, answer.content) == (200, json_bytes(RESULT))


def test_one_request_that_takes_too_long_is_answered_like_a_job(slow, log_bytes):
    form = {"robot": (None, "yumi-left"), "log": ("a.csv", log_bytes, "text/csv")}
    assert_problem(slow.post("/v1/identify", files=form), 422, "log")  # two joints for a robot of seven
    form["robot"] = ("arm.json", json.dumps(description()), "application/json")
    answer = slow.post("/v1/identify", files=form, headers={"Prefer": "wait=0"})
    assert answer.status_code == 202
    assert slow.get(answer.headers["location"]).json()["state"] in {"accepted", "running"}


def test_a_log_of_one_joint_is_spoken_of_in_the_singular(slow, request_body, log_bytes):
    lines = (line.split(b",") for line in log_bytes.splitlines())
    content = b"\n".join(b",".join((time, q, tau)) for time, q, _, tau, _ in lines)
    log = slow.post("/v1/logs?name=one.csv", content=content, headers={"Content-Type": "text/csv"}).json()
    problem = assert_problem(slow.post("/v1/jobs", json=request_body | {"logs": [log["id"]]}), 422, "log")
    assert problem["cause"] == "the log one.csv has 1 joint, the robot planar arm has 2"
