"""What a job computed instant by instant, over HTTP: thinned for the eye, and whole as a file."""

import io

import numpy as np
import pyarrow.parquet as pq
import pytest

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import csv_log, description
from tests.app.stubs import InlineExecutor, StubExecutor
from veritorque.app.schemas.results import ResultDocument
from veritorque.app.schemas.traces import ResidualViews, ResultTraces
from veritorque.app.store.blobs.sweep import Sweep

FEW = {"bootstrap": {"draws": 0}}


def job_of(client):
    robot = client.post("/v1/robots", json=description()).json()["id"]
    log = client.post("/v1/logs", content=csv_log(seconds=8.0), headers={"Content-Type": "text/csv"})
    body = {"kind": "identify", "robot": robot, "logs": [log.json()["id"]], "options": FEW}
    return client.post("/v1/jobs", json=body, headers={"Prefer": "wait=20"}).json()


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    with service(tmp_path_factory.mktemp("data"), InlineExecutor()) as client:
        yield client


@pytest.fixture(scope="module")
def job(client):
    job = job_of(client)
    assert job["state"] == "successful", job
    return f"/v1/jobs/{job['id']}"


@pytest.fixture(scope="module")
def table(client, job):
    answer = client.get(f"{job}/results/residuals.parquet")
    assert answer.headers["content-type"] == "application/vnd.apache.parquet"
    assert 'filename="residuals.parquet"' in answer.headers["content-disposition"]
    return pq.read_table(io.BytesIO(answer.content))


def test_a_joint_is_looked_at_as_the_contract_describes_it(client, job, table):
    seen = ResultTraces.model_validate_json(client.get(f"{job}/traces?joint=2").content)
    assert [one.signal for one in seen.traces] == [
        "torque_measured", "torque_filtered", "torque_estimated", "residual",
    ]  # fmt: skip  # a table
    assert {one.unit for one in seen.traces} == {"N m"}
    residual = table.column("residual_2").to_numpy()
    assert np.array(seen.traces[3].values) == pytest.approx(residual, rel=1e-6)
    assert seen.held_out


def test_a_view_zooms_into_a_stretch_and_thins_it(client, job, table):
    query = {"joint": 1, "signals": "position, velocity", "from": 2.0, "to": 4.0, "points": 10}
    seen = client.get(f"{job}/traces", params=query).json()
    assert [one["unit"] for one in seen["traces"]] == ["rad", "rad/s"]
    assert len(seen["time"]["values"]) == 10
    assert seen["rows_per_stretch"] > 1
    time = table.column("time").to_numpy()
    inside = table.column("position_1").to_numpy()[(time >= 2.0) & (time <= 4.0)]
    assert max(seen["traces"][0]["values"]) >= inside.max()
    assert min(seen["traces"][0]["values"]) <= inside.min()


WRONG = {
    "joint=3": "option",
    "joint=0": "request",
    "joint=1&log=2": "option",
    "joint=1&signals=torque": "request",
    "joint=1&signals=residual,residual": "request",
    "joint=1&signals=residual_after": "option",
    "joint=1&from=3&to=2": "option",
    "joint=1&from=nan": "request",
    "joint=1&points=4001": "request",
    "joint=1&colour=red": "request",
    "": "request",
}


@pytest.mark.parametrize(("query", "kind"), WRONG.items())
def test_what_cannot_be_looked_at_is_refused_with_a_reason(client, job, query, kind):
    assert_problem(client.get(f"{job}/traces?{query}"), 422, kind)


def test_who_has_a_picture_is_told_so_and_other_pictures_have_other_tags(client, job):
    queries = ("joint=1", "joint=2", "joint=1&to=3", "joint=1&points=20", "joint=1&signals=residual")
    tags = [client.get(f"{job}/traces?{query}").headers["etag"] for query in queries]
    assert len(set(tags)) == len(queries)
    known = client.get(f"{job}/traces?joint=1", headers={"If-None-Match": tags[0]})
    assert (known.status_code, known.content) == (304, b"")


def test_traces_are_kept_as_long_as_their_job_and_no_longer(tmp_path):
    with service(tmp_path, InlineExecutor()) as client:
        job = f"/v1/jobs/{job_of(client)['id']}"
        store = client.app.state.services.store
        sweep, kept = Sweep(store), len(store.blobs.marks())
        assert (sweep.run(), sweep.run()) == (0, 0)
        assert client.get(f"{job}/traces?joint=1").status_code == 200
        client.delete(job)
        sweep.run()
        sweep.run()
        assert kept - len(store.blobs.marks()) == 2  # the result and the traces


def test_a_job_without_traces_says_so_and_has_its_result(tmp_path):
    executor = StubExecutor()
    executor.release.set()
    with service(tmp_path, executor) as client:
        job = f"/v1/jobs/{job_of(client)['id']}"
        assert client.get(f"{job}/results").status_code == 200
        for path in ("traces?joint=1", "results/residuals.parquet"):
            problem = assert_problem(client.get(f"{job}/{path}"), 404, "not-found")
            assert "no traces" in problem["cause"]


def test_an_unfinished_job_has_no_traces_yet(tmp_path):
    with service(tmp_path, StubExecutor()) as client:
        robot = client.post("/v1/robots", json=description()).json()["id"]
        log = client.post("/v1/logs", content=csv_log(seconds=4.0), headers={"Content-Type": "text/csv"})
        body = {"kind": "identify", "robot": robot, "logs": [log.json()["id"]]}
        job = client.post("/v1/jobs", json=body).json()["id"]
        assert_problem(client.get(f"/v1/jobs/{job}/traces?joint=1"), 409, "job-unfinished")
        client.executor.release.set()


def test_the_residual_is_seen_over_position_velocity_and_frequency(client, job, table):
    seen = ResidualViews.model_validate_json(client.get(f"{job}/residuals?joint=1").content)
    assert [(over.coordinate, over.unit) for over in seen.over] == [
        ("position", "rad"),
        ("velocity", "rad/s"),
    ]
    assert seen.samples == table.column("used_1").to_numpy().sum()
    assert [one.signal for one in seen.densities] == ["residual"]


@pytest.mark.parametrize("query", ["joint=3", "joint=1&log=2"])
def test_a_residual_that_is_not_there_is_refused(client, job, query):
    assert_problem(client.get(f"{job}/residuals?{query}"), 422, "option")


def test_the_result_tells_bodies_to_draw_and_what_was_held_out(client, job):
    document = ResultDocument.model_validate_json(client.get(f"{job}/results").content)
    assert [body.link for body in document.bodies] == [1, 2]
    assert all(body.half_axes for body in document.bodies)
    held_out = client.get(f"{job}/traces?joint=1").json()["held_out"]
    for span, (begin, end) in zip(document.held_out, held_out, strict=True):
        assert (span.begin_s, span.end_s) == pytest.approx((begin, end), abs=1e-6)
