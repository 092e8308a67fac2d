"""The whole way over HTTP with the real science."""

import json

import pytest
from starlette.testclient import TestClient

from tests.app.planar_arm import TRUTH, csv_log, description
from veritorque.app.main import create_app
from veritorque.app.schemas.results import ResultDocument
from veritorque.app.settings import Settings


@pytest.fixture(scope="module")
def real(tmp_path_factory):
    with TestClient(create_app(Settings(data_dir=tmp_path_factory.mktemp("data")))) as client:
        yield client


@pytest.fixture(scope="module")
def identified(real):
    return identify(real)


def identify(real):
    robot = real.post("/v1/robots", json=description()).json()["id"]
    log = real.post("/v1/logs?name=swing.csv", content=csv_log(), headers={"Content-Type": "text/csv"}).json()
    request = {"kind": "identify", "robot": robot, "logs": [log["id"]]}
    request["options"] = {"bootstrap": {"draws": 20}}
    answer = real.post("/v1/jobs", json=request, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    assert answer.json()["state"] == "successful", answer.text
    return answer.json(), request


def test_a_log_sent_over_http_becomes_the_parameters_of_the_arm_that_made_it(real, identified):
    result = real.get(identified[0]["links"]["results"]).json()
    assert len(result["base_parameters"]) == 12  # ZZR1 MXR1 MY1 ZZ2 MX2 MY2 and three of friction per joint
    for row in result["base_parameters"]:
        true = sum(factor * TRUTH.get(name, 0.0) for name, factor in row["relation"].items())
        # Noise of 0.01 N m is nothing on 10 N m; the filters and the corner of Coulomb friction cost more.
        assert row["value"] == pytest.approx(true, rel=0.02, abs=0.02), row["name"]


def test_the_result_document_follows_the_documented_model(real, identified):
    ResultDocument.model_validate_json(real.get(identified[0]["links"]["results"]).content)


def test_another_service_gives_the_same_result_byte_for_byte(real, identified, tmp_path):
    job, request = identified
    with TestClient(create_app(Settings(data_dir=tmp_path))) as other:
        again, asked = identify(other)
        assert (asked, again["id"] != job["id"]) == (request, True)
        result = other.get(again["links"]["results"]).content
    assert result == real.get(job["links"]["results"]).content


def test_a_result_reads_in_the_order_of_the_contract(real, identified):
    result = real.get(identified[0]["links"]["results"]).json()
    assert list(result)[:5] == ["schema_version", "kind", "conflicts", "doubts", "robot"]
    assert list(result["base_parameters"][0])[:2] == ["name", "unit"]
    assert next(iter(result["robot"])) == "name"


def test_the_report_of_a_job_names_it_and_shows_its_motion_and_torque(real, identified):
    job = identified[0]
    page = real.get(job["links"]["report"]).text
    assert job["id"] in page
    assert job["finished_at"][:10] in page
    for kind in ("measured", "filtered", "estimated", "residual"):
        assert page.count(f'class="line trace {kind}"') >= 2  # joints
    assert page.count('class="band held-out"') == 8  # four of twenty blocks on either joint


def test_one_request_identifies_a_robot_that_is_sent_along(real, identified):
    answer = real.post(
        "/v1/identify",
        data={"robot": json.dumps(description()), "options": json.dumps(identified[1]["options"])},
        files={"log": ("swing.csv", csv_log(), "text/csv")},
    )
    assert answer.status_code == 200, answer.text
    assert answer.content == real.get(identified[0]["links"]["results"]).content


def test_base_parameters_are_known_before_any_motion(real):
    document = real.get("/v1/robots/yumi-left/base-parameters").json()
    assert document["counts"] == {"standard": 98, "base": 71}
    assert len(document["base_parameters"]) == 71
