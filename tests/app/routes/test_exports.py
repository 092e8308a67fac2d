"""The files of a result over HTTP: every form, its media type, and what cannot be written."""

import json

import numpy as np
import pytest

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import columns, csv_log, description
from tests.app.stubs import StubExecutor
from veritorque.app.jobs.computation import Finished
from veritorque.app.json_text import json_bytes
from veritorque.app.services.export_files import ARTIFACTS
from veritorque.core.document.model.model_file import read_model
from veritorque.core.document.model.reading import identified_robot
from veritorque.core.export.formats import FORMATS
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.study import IdentifyRequest, identify

MEDIA_TYPES = {
    "parameters.csv": "text/csv; charset=utf-8",
    "standard_parameters.csv": "text/csv; charset=utf-8",
    "parameters.yaml": "application/yaml",
    "parameters.mat": "application/x-matlab-data",
    "parameters.h": "text/x-c; charset=utf-8",
    "robot.urdf": "application/xml",
    "robot.xml": "application/xml",
    "robot.sdf": "application/xml",
    "model.json": "application/json",
}


def result(**options):
    log = log_from_arrays("arm", *columns(seconds=10.0))
    chosen = {"bootstrap": {"draws": 0}} | options
    return identify(IdentifyRequest(robot_from_description(description()), (log,), chosen))


def results_of(client):
    """Let a job succeed, and give where its results are."""
    robot = client.post("/v1/robots", json=description()).json()["id"]
    log = client.post("/v1/logs", content=csv_log(seconds=4.0), headers={"Content-Type": "text/csv"})
    body = {"kind": "identify", "robot": robot, "logs": [log.json()["id"]], "options": {}}
    job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=10"}).json()
    assert job["state"] == "successful"
    return job["links"]["results"]


def giving(document):
    executor = StubExecutor(Finished(json_bytes(document)))
    executor.release.set()
    return executor


@pytest.fixture(scope="module")
def document():
    return result()


@pytest.fixture(scope="module")
def client(tmp_path_factory, document):
    with service(tmp_path_factory.mktemp("data"), giving(document)) as client:
        yield client


@pytest.fixture(scope="module")
def results(client):
    return results_of(client)


def test_these_are_the_files_that_are_promised():
    assert set(ARTIFACTS) == {*MEDIA_TYPES, "comparison.csv", "comparison.tex"}
    assert set(FORMATS) == set(MEDIA_TYPES)


@pytest.mark.parametrize("name", MEDIA_TYPES)
def test_every_file_comes_as_what_it_is_and_is_saved_under_its_name(client, results, name):
    answer = client.get(f"{results}/{name}")
    assert (answer.status_code, answer.headers["content-type"]) == (200, MEDIA_TYPES[name])
    assert answer.headers["content-disposition"] == f'attachment; filename="{name}"'
    assert answer.content == client.get(f"{results}/{name}").content


@pytest.mark.parametrize("name", MEDIA_TYPES)
def test_the_contract_names_the_media_type_of_every_file(client, name):
    operation = client.get("/openapi.json").json()["paths"]["/v1/jobs/{job_id}/results/{artifact}"]["get"]
    assert MEDIA_TYPES[name].partition(";")[0] in operation["responses"]["200"]["content"]
    (parameter,) = (one for one in operation["parameters"] if one["name"] == "artifact")
    assert name in parameter["schema"]["examples"]


def test_the_files_hold_the_numbers_of_the_result(client, results, document):
    bodies = identified_robot(document).links
    urdf = robot_from_urdf(client.get(f"{results}/robot.urdf").content)
    np.testing.assert_allclose(urdf.prior, bodies, rtol=0, atol=1e-12 * np.abs(bodies).max())
    model = read_model(client.get(f"{results}/model.json").content)
    assert model.values == {row["name"]: row["value"] for row in document["standard_parameters"]}


def test_a_file_that_does_not_exist_is_refused_with_the_list_of_those_that_do(client, results):
    problem = assert_problem(client.get(f"{results}/robot.step"), 404, "not-found")
    assert problem["evidence"]["known"] == [*MEDIA_TYPES, "residuals.parquet"]


def test_a_result_without_bodies_is_no_robots_file_but_a_table(tmp_path):
    with service(tmp_path, giving(result(terms=["viscous", "coulomb"]))) as client:
        results = results_of(client)
        for name in ("robot.urdf", "robot.xml", "robot.sdf", "parameters.h"):
            problem = assert_problem(client.get(f"{results}/{name}"), 422, "option")
            assert "rigid_body" in problem["remedy"]
        assert client.get(f"{results}/parameters.yaml").status_code == 200


def test_a_result_that_holds_no_robot_is_a_problem_and_no_mistake_of_ours(tmp_path):
    with service(tmp_path) as client:
        client.executor.release.set()
        results = results_of(client)
        for name in sorted(set(MEDIA_TYPES) - {"parameters.csv", "standard_parameters.csv"}):
            assert_problem(client.get(f"{results}/{name}"), 422, "robot")


def test_a_result_of_an_earlier_diagnosis_that_kept_no_model_gives_the_robot_before_the_correction(
    tmp_path, document
):
    bare = {"after": {"validation": [], "base_parameters": []}}
    with service(tmp_path, giving(document | {"diagnosis": bare})) as client:
        text = client.get(f"{results_of(client)}/model.json").content
    names = [row["name"] for row in document["standard_parameters"]]
    assert [one.name for one in read_model(text).model.parameters] == names
    assert json.loads(text)["format"] == "veritorque-model"
