"""The contract that is documented is the one that is kept: one battery for all routes."""

import json
import threading
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import description
from tests.app.stubs import StubExecutor
from veritorque.app.kinds.diagnose import HIDDEN_LOG_ID
from veritorque.app.kinds.identify import EXAMPLE_LOG_ID
from veritorque.app.kinds.registry import KINDS as JOB_KINDS
from veritorque.app.main import create_app
from veritorque.app.problems import KINDS, Problem
from veritorque.app.schemas import examples
from veritorque.app.schemas.jobs import Job, JobList, JobRequest
from veritorque.app.schemas.logs import LogList, LogSummary
from veritorque.app.schemas.robots import Robot, RobotDescription, RobotList
from veritorque.app.services import catalogue, readiness
from veritorque.app.settings import Settings
from veritorque.app.store.logs import log_id as id_of_log
from veritorque.app.version import VERSION
from veritorque.core.robot import description as core_description
from veritorque.core.robot import link_data

ROOT = Path(__file__).parents[3]
OPENAPI = create_app().openapi()
PATHS = {path: {method.upper() for method in operations} for path, operations in OPENAPI["paths"].items()}
# What api.md promises and this version serves.
PROMISED = {
    "/v1/robots": {"GET", "POST"},
    "/v1/robots/{robot_id}": {"GET", "DELETE"},
    "/v1/robots/{robot_id}/base-parameters": {"GET"},
    "/v1/robots/{robot_id}/audit": {"POST"},
    "/v1/logs": {"GET", "POST"},
    "/v1/logs/{log_id}": {"GET", "DELETE"},
    "/v1/logs/{log_id}/readings": {"POST"},
    "/v1/logs/{log_id}/traces": {"GET"},
    "/v1/jobs": {"GET", "POST"},
    "/v1/jobs/{job_id}": {"GET", "DELETE"},
    "/v1/jobs/{job_id}/events": {"GET"},
    "/v1/jobs/{job_id}/report": {"GET"},
    "/v1/jobs/{job_id}/traces": {"GET"},
    "/v1/jobs/{job_id}/residuals": {"GET"},
    "/v1/jobs/{job_id}/results": {"GET"},
    "/v1/jobs/{job_id}/results/{artifact}": {"GET"},
    "/v1/identify": {"POST"},
    "/healthz": {"GET"},
    "/readyz": {"GET"},
    "/metrics": {"GET"},
    "/version": {"GET"},
}


def test_the_paths_and_methods_are_the_promised_ones():
    assert PATHS == PROMISED


@pytest.mark.parametrize("path", sorted(PROMISED))
def test_a_method_that_a_path_does_not_take_is_refused_with_all_that_it_takes(client, path):
    real = path.format(robot_id="yumi", log_id="l", job_id="j", artifact="parameters.csv")
    for method in {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"} - PROMISED[path]:
        answer = client.request(method, real)
        assert_problem(answer, 405, "method-not-allowed")
        allowed = {one.strip() for one in answer.headers["allow"].split(",")}
        assert allowed == PROMISED[path] | ({"HEAD"} if "GET" in PROMISED[path] else set())


def test_head_is_answered_like_get_without_the_body(client, log_id):
    for path in ("/", "/docs", "/healthz", "/v1/robots/yumi", f"/v1/logs/{log_id}", "/v1/jobs/none"):
        head, get = client.head(path), client.get(path)
        assert (head.status_code, head.content) == (get.status_code, b"")
        assert head.headers["content-type"] == get.headers["content-type"]


@pytest.mark.parametrize("path", sorted(PROMISED))
def test_a_parameter_that_does_not_exist_is_refused_on_every_path(client, path):
    real = path.format(robot_id="yumi", log_id="l", job_id="j", artifact="parameters.csv")
    for method in PROMISED[path]:
        problem = assert_problem(client.request(method, real + "?nmae=arm"), 422, "request")
        assert problem["evidence"]["errors"] == [
            {"parameter": "nmae", "message": "there is no parameter nmae"}
        ]


def test_a_parameter_that_is_given_twice_is_refused(client):
    assert_problem(client.get("/v1/jobs?limit=1&limit=2"), 422, "request")
    assert_problem(client.get("/v1/jobs?" + "&".join(f"a{n}=1" for n in range(200))), 422, "request")
    assert client.get("/v1/jobs?limit=1").status_code == 200


def test_an_address_that_does_not_exist_is_a_problem(client):
    assert_problem(client.get("/v2/robots"), 404, "not-found")


def test_every_operation_documents_its_answers_and_its_problems():
    for path, operations in OPENAPI["paths"].items():
        for method, operation in operations.items():
            assert operation["summary"], (path, method)
            for status, answer in operation["responses"].items():
                if int(status) >= 400:
                    assert list(answer["content"]) == ["application/problem+json"], (path, method, status)
            if "{" in path:
                assert "404" in operation["responses"]
            if method == "post":
                assert {"400", "413", "415", "422"} <= set(operation["responses"])


def test_a_form_that_is_sent_as_swagger_ui_fills_it_in_is_a_good_one():
    for path in ("/v1/logs", "/v1/identify"):
        content = OPENAPI["paths"][path]["post"]["requestBody"]["content"]
        assert next(iter(content)) == "multipart/form-data"
        parts = content["multipart/form-data"]["schema"]["properties"].values()
        for part in parts:
            assert "default" in part or "binary" in (part.get("format"), part.get("items", {}).get("format"))


def test_every_reference_of_the_contract_leads_somewhere():
    def references(node):
        if isinstance(node, dict):
            yield from ([node["$ref"]] if "$ref" in node else [])
            for child in node.values():
                yield from references(child)
        elif isinstance(node, list):
            for child in node:
                yield from references(child)

    for reference in set(references(OPENAPI)):
        target = OPENAPI
        for step in reference.removeprefix("#/").split("/"):
            target = target[step]
        assert isinstance(target, dict)


def test_the_documented_fields_of_a_robot_are_those_that_core_reads():
    def fields(model):
        return set(RobotDescription.model_json_schema()["$defs"][model]["properties"])

    assert set(RobotDescription.model_fields) == set(core_description.ROBOT_FIELDS)
    both = core_description.ROW_FIELDS | core_description.FRAME_FIELDS | core_description.JOINT_FIELDS
    assert fields("JointDescription") == set(both)
    assert fields("Limits") == set(core_description.LIMIT_FIELDS)
    assert fields("CouplingDescription") == set(core_description.COUPLING_FIELDS)
    assert fields("LinkPrior") == set(link_data.PRIOR_FIELDS)
    assert fields("StandardParameters") == set(link_data.SYMBOL_FIELDS)


def test_answers_follow_the_documented_models(client, robot_id, log_id):
    answers = {
        Robot: client.get(f"/v1/robots/{robot_id}"),
        RobotList: client.get("/v1/robots"),
        LogSummary: client.get(f"/v1/logs/{log_id}"),
        LogList: client.get("/v1/logs"),
        Job: client.post("/v1/jobs", json={"kind": "identify", "robot": robot_id, "logs": [log_id]}),
        JobList: client.get("/v1/jobs"),
    }
    for model, answer in answers.items():
        model.model_validate_json(answer.content)
    for name in ("yumi-left", "yumi-right", "yumi"):
        Robot.model_validate_json(client.get(f"/v1/robots/{name}").content)


def test_the_examples_of_the_contract_work(client):
    for kind in JOB_KINDS.values():
        JobRequest.model_validate(kind.words.request)
    assert client.post("/v1/robots", json=examples.YUMI_LEFT).status_code == 201
    urdf = client.post("/v1/robots", content=examples.PENDULUM_URDF, headers={"Content-Type": "text/xml"})
    assert urdf.status_code == 201
    json.loads(examples.MAPPING)


@pytest.mark.parametrize(
    ("log", "identity", "kind"),
    [
        ("examples/yumi/log.csv", EXAMPLE_LOG_ID, "identify"),
        ("examples/yumi/hidden_log.csv", HIDDEN_LOG_ID, "diagnose"),
    ],
)
def test_the_example_jobs_name_the_logs_that_ship_with_the_project(client, log, identity, kind):
    path = ROOT / log
    answer = client.post("/v1/logs", files={"file": (path.name, path.read_bytes(), "text/csv")})
    assert answer.json()["id"] == identity
    assert client.post("/v1/jobs", json=JOB_KINDS[kind].words.request).status_code == 202


def test_the_id_of_a_log_depends_on_bytes_name_and_mapping_only():
    one = id_of_log(sha256="ab", name="a", mapping={"x": 1, "y": 2})
    assert one == id_of_log(sha256="ab", name="a", mapping={"y": 2, "x": 1})
    others = [("cd", "a", {}), ("ab", "b", {}), ("ab", "a", None)]
    assert len({one, *(id_of_log(sha256=s, name=n, mapping=m) for s, n, m in others)}) == 4


def test_every_kind_of_problem_is_whole():
    for kind, (status, title) in KINDS.items():
        assert 400 <= status < 600
        assert title
        assert Problem(kind, "a cause").document()["status"] == status


def test_a_mistake_of_ours_shows_nothing_of_the_inside(tmp_path, caplog):
    app = create_app(Settings(data_dir=tmp_path), executor=None)

    @app.get("/broken")
    def broken() -> None:
        raise ZeroDivisionError("a secret of ours")

    answer = TestClient(app, raise_server_exceptions=False).get("/broken")
    problem = assert_problem(answer, 500, "internal")
    assert "secret" not in answer.text
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert problem["evidence"]["incident"] in caplog.text


def test_the_version_is_the_one_of_the_project(client):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert VERSION == project["version"] == client.get("/version").json()["version"]


class Loading(StubExecutor):
    """Has not loaded the solver until somebody opens the gate."""

    def __init__(self):
        super().__init__()
        self.gate = threading.Event()

    def prepare(self):
        self.gate.wait(20.0)


def test_a_service_that_still_loads_the_solver_is_alive_but_not_ready(tmp_path):
    loading = Loading()
    with service(tmp_path, loading) as client:
        assert client.get("/healthz").status_code == 200
        assert_problem(client.get("/readyz"), 503, "not-ready")
        assert client.post("/v1/robots", json=description()).status_code == 201
        loading.gate.set()
        client.app.state.services.computing.ready.wait(5.0)
        assert client.get("/readyz").json() == {"status": "ready"}


def test_what_needs_the_solver_waits_until_it_is_loaded(tmp_path, monkeypatch):
    loading = Loading()
    monkeypatch.setattr(catalogue, "base_parameters", lambda _robot: {"counts": {"base": 5}})
    with service(tmp_path, loading) as client, ThreadPoolExecutor() as others:
        robot = client.post("/v1/robots", json=description()).json()["id"]
        assert_problem(client.get("/v1/robots/none/base-parameters"), 404, "not-found")
        asked = others.submit(client.get, f"/v1/robots/{robot}/base-parameters")
        with pytest.raises(TimeoutError):
            asked.result(0.5)
        loading.gate.set()
        assert asked.result(20.0).json() == {"robot": robot, "counts": {"base": 5}}


def test_who_waits_too_long_for_the_solver_is_told(tmp_path, monkeypatch):
    loading = Loading()
    monkeypatch.setattr(readiness, "LOADING_S", 0.3)
    with service(tmp_path, loading) as client:
        answer = client.get("/v1/robots/yumi/base-parameters")
        assert_problem(answer, 503, "not-ready")
        assert answer.headers["retry-after"]
        loading.gate.set()
