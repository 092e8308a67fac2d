"""A set-up check through the service: its result, and what it is not."""

import pytest

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import csv_log, description
from tests.app.stubs import InlineExecutor
from veritorque.app.kinds.check import Check
from veritorque.app.kinds.registry import KINDS
from veritorque.app.problems import Problem
from veritorque.app.schemas.setup_check import CheckDocument


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A service which computes with the real science, in the tests' own process."""
    with service(tmp_path_factory.mktemp("data"), InlineExecutor()) as client:
        yield client


def test_a_check_answers_a_document_of_its_own_and_is_no_reference(client):
    robot = client.post("/v1/robots", json=description()).json()["id"]
    csv = {"Content-Type": "text/csv"}
    log = client.post("/v1/logs", content=csv_log(seconds=12.0, noise=0.05), headers=csv).json()["id"]
    body = {"kind": "check", "robot": robot, "logs": [log], "options": {}}
    job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=60"}).json()
    assert job["state"] == "successful"
    assert set(job["links"]) == {"self", "results"}
    result = client.get(job["links"]["results"])
    document = CheckDocument.model_validate_json(result.content)
    assert document.agreement == "yes"
    assert KINDS["check"].words.alarm.is_raised(result.json()) is False
    assert_problem(client.get(f"{job['links']['self']}/report"), 404, "not-found")
    assert_problem(client.get(job["links"]["results"], headers={"Accept": "text/csv"}), 406, "not-acceptable")
    against = body | {"kind": "diagnose", "options": {"reference": job["id"]}}
    assert_problem(client.post("/v1/jobs", json=against), 422, "option")


@pytest.mark.parametrize(("takes_logs", "refused"), [(True, 0), (False, 1)])
def test_a_kind_takes_logs_or_none(monkeypatch, takes_logs, refused):
    monkeypatch.setattr(Check, "takes_logs", takes_logs)
    Check().require_logs(1 - refused)
    with pytest.raises(Problem) as raised:
        Check().require_logs(refused)
    assert raised.value.evidence["pointer"] == "/logs"
