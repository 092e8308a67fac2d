"""Ask over HTTP what has changed: against an earlier job, or against the bodies of the description."""

import subprocess
import sys

import numpy as np
import pytest

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import TRUTH, columns, description
from tests.app.stubs import InlineExecutor, StubExecutor, failing
from veritorque.app.schemas.results import ResultDocument

CSV = {"Content-Type": "text/csv"}
WAIT = {"Prefer": "wait=60"}
FEW = {"bootstrap": {"draws": 0}}
GROWN = 0.3
"""By how much the Coulomb friction of joint 2 grows, N m."""


def sent(client, *, grown=0.0, seed=7, **options):
    """Upload a log of the planar arm, its second joint's friction grown."""
    time, position, torque = columns(**{"seconds": 20.0, "noise": 0.05, "seed": seed} | options)
    torque[:, 1] += grown * np.sign(np.gradient(position[:, 1]))
    rows = [",".join(f"{one:.6f}" for one in row) for row in np.column_stack([time, position, torque])]
    content = "\n".join(["time,q_1,q_2,tau_1,tau_2", *rows]).encode()
    return client.post("/v1/logs", content=content, headers=CSV).json()["id"]


def asked(client, log, options, kind="diagnose", **changes):
    robot = client.post("/v1/robots", json=description() | changes).json()["id"]
    return {"kind": kind, "robot": robot, "logs": [log], "options": FEW | options}


def done(client, body):
    job = client.post("/v1/jobs", json=body, headers=WAIT).json()
    assert job["state"] == "successful", job
    return job, client.get(job["links"]["results"])


@pytest.fixture(scope="module")
def earlier(tmp_path_factory):
    """A service that computes in this process, and an identification that it has finished."""
    with service(tmp_path_factory.mktemp("data"), InlineExecutor()) as client:
        job, _ = done(client, asked(client, sent(client), {}, kind="identify"))
        yield client, job["id"]


@pytest.fixture
def stopped(tmp_path):
    """A service whose jobs are not finished before it is told."""
    with service(tmp_path, StubExecutor()) as client:
        yield client


def test_friction_that_has_grown_since_an_earlier_job_is_found_and_reported(earlier):
    client, reference = earlier
    job, result = done(client, asked(client, sent(client, grown=GROWN, seed=8), {"reference": reference}))
    ResultDocument.model_validate_json(result.content)
    (found,) = result.json()["diagnosis"]["findings"]
    size = next(one for one in found["parameters"] if one["name"] == "delta_coulomb")
    assert (found["cause"], found["joints"]) == ("friction_change", [2])
    assert abs(size["value"] - GROWN) < 3.0 * size["standard_deviation"]
    assert result.json()["diagnosis"]["reference"]["name"] == reference
    assert result.json()["provenance"]["options"]["reference"] == reference
    assert "Friction change since the reference" in client.get(job["links"]["report"]).text


def test_a_diagnosis_may_be_the_reference_of_another(earlier):
    client, reference = earlier
    log = sent(client, seed=9)
    job, _ = done(client, asked(client, log, {"reference": reference}))
    _, result = done(client, asked(client, log, {"reference": job["id"]}))
    assert result.json()["diagnosis"]["findings"] == []


def test_a_description_that_has_bodies_is_a_reference(earlier):
    client, _ = earlier
    inertia = [
        {"XX": 0.01, "XY": 0.0, "XZ": 0.0, "YY": TRUTH[f"ZZ{n}"], "YZ": 0.0, "ZZ": TRUTH[f"ZZ{n}"]}
        | {"MX": TRUTH[f"MX{n}"], "MY": TRUTH[f"MY{n}"], "MZ": 0.0, "M": TRUTH[f"M{n}"]}
        for n in (1, 2)
    ]
    prior = [{"standard": one} for one in inertia]
    _, result = done(client, asked(client, sent(client, seed=10), {"reference": "prior"}, prior=prior))
    diagnosis = result.json()["diagnosis"]
    assert diagnosis["findings"] == []
    assert {"FV1", "FC2"} <= set(diagnosis["reference"]["left_open"])


def test_a_job_that_was_deleted_is_no_reference(earlier):
    client, _ = earlier
    job, _ = done(client, asked(client, sent(client, seed=11), {}, kind="identify"))
    client.delete(f"/v1/jobs/{job['id']}")
    body = asked(client, sent(client, seed=11), {"reference": job["id"]})
    problem = assert_problem(client.post("/v1/jobs", json=body), 422, "unknown-reference")
    assert problem["evidence"]["reference"] == job["id"]


def test_a_job_that_an_unfinished_one_compares_with_cannot_be_deleted(tmp_path):
    with service(tmp_path, InlineExecutor()) as client:
        first, _ = done(client, asked(client, sent(client), {}, kind="identify"))
    with service(tmp_path, StubExecutor()) as client:
        body = asked(client, sent(client, seed=12), {"reference": first["id"]})
        second = client.post("/v1/jobs", json=body).json()
        assert_problem(client.delete(f"/v1/jobs/{first['id']}"), 409, "in-use")
        client.delete(f"/v1/jobs/{second['id']}")
        assert client.delete(f"/v1/jobs/{first['id']}").status_code == 204


def test_a_job_of_another_robot_is_no_reference(earlier):
    client, reference = earlier
    body = asked(client, sent(client), {"reference": reference}, gravity=[0.0, 0.0, -9.81])
    problem = assert_problem(client.post("/v1/jobs", json=body), 422, "option")
    assert problem["evidence"]["differ"] == ["gravity"]


def test_a_job_that_still_runs_is_no_reference(stopped):
    first = stopped.post("/v1/jobs", json=asked(stopped, sent(stopped), {}, kind="identify")).json()
    body = asked(stopped, sent(stopped), {"reference": first["id"]})
    problem = assert_problem(stopped.post("/v1/jobs", json=body), 422, "option")
    assert problem["evidence"]["state"] in ("accepted", "running")
    assert "wait" in problem["remedy"]


def test_a_job_that_failed_is_no_reference(tmp_path):
    executor = failing()
    executor.release.set()
    with service(tmp_path, executor) as client:
        body = asked(client, sent(client), {}, kind="identify")
        first = client.post("/v1/jobs", json=body, headers=WAIT).json()
        problem = assert_problem(
            client.post("/v1/jobs", json=asked(client, sent(client), {"reference": first["id"]})),
            422,
            "option",
        )
    assert problem["evidence"]["state"] == "failed"


ADMITS = """
import sys
from veritorque.app.kinds.diagnose import Diagnose
from veritorque.app.kinds.kind import PlannedJob
from veritorque.core.dynamics.model import standard_model
from veritorque.core.robot.builtin import builtin_robot

kind, model = Diagnose(), standard_model(builtin_robot("yumi-left"), None)
kind.admit(PlannedJob({}, (), {}, lambda terms: model, None), kind.read_options({}))
sys.exit("numba" in sys.modules or "clarabel" in sys.modules)
"""


def test_whoever_compares_with_nothing_does_not_wait_for_the_solver_to_be_loaded():
    subprocess.run([sys.executable, "-c", ADMITS], check=True)
