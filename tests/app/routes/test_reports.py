"""Reports over HTTP, and jobs that diagnose: what a client asks for, compares with, and gets."""

import json

import pytest
from starlette.testclient import TestClient

from tests.app.conftest import assert_problem, service
from tests.app.jobs.test_jobs import asked
from tests.app.planar_arm import csv_log, description
from tests.app.stubs import RESULT, StubExecutor, failing
from tests.core.report.documents import diagnosed, nothing_found
from veritorque.app.jobs.computation import Finished
from veritorque.app.json_text import json_bytes
from veritorque.app.main import create_app
from veritorque.app.schemas.results import ResultDocument
from veritorque.app.settings import Settings

WAIT = {"Prefer": "wait=10"}
BROWSER = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"


@pytest.fixture(params=[RESULT, diagnosed()], ids=["identify", "diagnose"])
def finished(tmp_path, log_bytes, request):
    """A service and its one finished job, whose result is a document of either kind."""
    executor = StubExecutor(Finished(json_bytes(request.param)))
    executor.release.set()
    with service(tmp_path, executor) as client:
        yield client, client.post("/v1/jobs", json=asked(client, log_bytes), headers=WAIT).json()


@pytest.mark.parametrize("document", [RESULT, diagnosed(), nothing_found()], ids=lambda one: one["kind"])
def test_the_documents_that_reports_are_tested_with_follow_the_contract(document):
    ResultDocument.model_validate_json(json.dumps(document))


def test_a_finished_job_has_a_report_that_may_only_be_read(finished):
    client, job = finished
    answer = client.get(job["links"]["report"])
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    policy = answer.headers["content-security-policy"]
    assert policy.startswith("default-src 'none'; style-src 'unsafe-inline'")
    assert "sandbox" in policy
    assert "script-src" not in policy
    assert "bench arm" in answer.text


def test_a_browser_that_opens_the_results_gets_the_report_and_a_program_the_document(finished):
    client, job = finished
    page = client.get(job["links"]["results"], headers={"Accept": BROWSER})
    assert page.text == client.get(job["links"]["report"]).text
    assert client.get(job["links"]["results"]).headers["content-type"] == "application/json"
    assert page.headers["vary"] == "Accept"


def test_a_job_without_a_result_has_no_report(tmp_path, log_bytes):
    executor = failing()
    executor.release.set()
    with service(tmp_path, executor) as client:
        job = client.post("/v1/jobs", json=asked(client, log_bytes), headers=WAIT).json()
        assert_problem(client.get(f"/v1/jobs/{job['id']}/report"), 409, "job-failed")
        assert_problem(client.get("/v1/jobs/none/report"), 404, "not-found")


def test_a_diagnosis_is_computed_as_one(finished, log_bytes):
    client, _ = finished
    body = asked(client, log_bytes) | {"kind": "diagnose", "options": {"reference": None}}
    answer = client.post("/v1/jobs", json=body, headers=WAIT)
    assert (answer.status_code, answer.json()["kind"]) == (200, "diagnose")
    assert client.executor.computations[-1].kind == "diagnose"


@pytest.mark.parametrize(
    ("reference", "kind"),
    [
        *((wrong, "option") for wrong in (7, True, ["job-1"], "", "j" * 201)),
        ("job-1", "unknown-reference"),
        ("prior", "robot"),
    ],
)
def test_a_reference_that_cannot_be_compared_with_is_refused(finished, log_bytes, reference, kind):
    client, _ = finished
    body = asked(client, log_bytes) | {"kind": "diagnose", "options": {"reference": reference}}
    problem = assert_problem(client.post("/v1/jobs", json=body), 422, kind)
    assert problem["evidence"]
    assert problem["remedy"]


def test_an_identification_knows_no_reference(finished, log_bytes):
    client, job = finished
    body = asked(client, log_bytes) | {"options": {"reference": job["id"]}}
    assert_problem(client.post("/v1/jobs", json=body), 422, "option")


@pytest.mark.slow
def test_a_log_sent_over_http_is_diagnosed_by_the_real_science_and_reported(tmp_path):
    with TestClient(create_app(Settings(data_dir=tmp_path))) as client:
        robot = client.post("/v1/robots", json=description()).json()["id"]
        content = csv_log(seconds=20.0, noise=0.05)
        log = client.post("/v1/logs?name=swing.csv", content=content, headers={"Content-Type": "text/csv"})
        body = {"kind": "diagnose", "robot": robot, "logs": [log.json()["id"]]}
        job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=60"}).json()
        assert job["state"] == "successful", job
        result = client.get(job["links"]["results"])
        ResultDocument.model_validate_json(result.content)
        assert result.json()["diagnosis"]["findings"] == []
        assert "No cause of simulation error found" in client.get(job["links"]["report"]).text
