"""The model of a joint through the service: the answer, refusals at admission, and refusals by the log."""

import io

import numpy as np
import pytest
from rich.console import Console

from tests.app.conftest import assert_problem, service
from tests.app.stubs import InlineExecutor
from tests.core.joint_model.plant import Plant, Run, recorded, robot_of
from veritorque.app.kinds.registry import KINDS
from veritorque.app.schemas.joint_model import JointModelDocument
from veritorque.core.robot.writing import to_description

CSV = {"Content-Type": "text/csv"}


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A service which computes with the real science, in the tests' own process."""
    with service(tmp_path_factory.mktemp("data"), InlineExecutor()) as client:
        yield client


@pytest.fixture(scope="module")
def asked(client):
    """Give what asks for the model of a joint of 12 Hz, of a log without references."""
    plant = Plant.with_mode(12.0)
    signals = recorded(plant, Run(highest_hz=18.0, seconds=6.0, noise=np.radians(1e-3)))
    table = np.column_stack([signals["time"], signals["position"], signals["torque"]])
    text = "\n".join(["time,q_1,tau_1", *(",".join(f"{cell:.9g}" for cell in row) for row in table)])
    robot = client.post("/v1/robots", json=to_description(robot_of())).json()["id"]
    log = client.post("/v1/logs", content=text.encode(), headers=CSV).json()["id"]
    return {"kind": "joint_model", "robot": robot, "logs": [log], "options": {"joint": 1}}


def test_the_service_answers_stiffness_and_mode_with_their_deviations(client, asked):
    job = client.post("/v1/jobs", json=asked, headers={"Prefer": "wait=60"}).json()
    assert job["state"] == "successful"
    result = client.get(job["links"]["results"])
    document = JointModelDocument.model_validate_json(result.content)
    assert document.flexibility.seen is True
    flexible = document.models[-1]
    stiffness = next(row for row in flexible.parameters if row.name == "stiffness")
    assert stiffness.unit == "N m/rad"
    assert stiffness.value == pytest.approx(Plant.with_mode(12.0).stiffness, rel=0.01)
    assert stiffness.interval_95[0] < stiffness.value < stiffness.interval_95[1]
    assert [row.name for row in flexible.frequencies] == ["natural", "antiresonance"]
    assert flexible.frequencies[0].value == pytest.approx(12.0, rel=0.01)
    response = document.response
    assert len(response.frequency_hz) == len(response.measured) == len(response.models[-1].gain)
    console = Console(file=io.StringIO(), width=120)
    KINDS["joint_model"].show(console, result.json())
    assert "stiffness (k)" in console.file.getvalue()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({}, "joint is missing"),
        ({"joint": 2}, "no joint 2"),
        ({"joint": 1, "order": "stiff"}, "order"),
        ({"joint": 1, "bootstrap": {"draws": 0}}, "bootstrap"),
        ({"joint": 1, "estimator": "clsrivc"}, "does not show"),
    ],
)
def test_what_cannot_succeed_is_refused_at_once(client, asked, options, said):
    answer = client.post("/v1/jobs", json=asked | {"options": options})
    assert_problem(answer, 422, "option")
    assert said in answer.json()["cause"]
    assert answer.json()["remedy"]
