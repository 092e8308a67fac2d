"""An audit over HTTP and as a command: without a log at once, with logs as a job, refused in words."""

import json

import numpy as np
import pytest

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import csv_log, description
from tests.app.stubs import InlineExecutor
from tests.app.terminal.conftest import run
from tests.core.estimate.worlds import swing
from veritorque.app.schemas.audit import AuditDocument
from veritorque.app.terminal.output.exit_codes import Exit
from veritorque.core.dynamics.model import standard_model
from veritorque.core.robot.inertia import from_mass_properties, mass_properties
from veritorque.core.robot.urdf.read import robot_from_urdf

BODY = {"mass": 2.0, "center_of_mass": [0.2, 0.0, 0.0], "inertia_at_com": [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]}


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A service which computes with the real science, in the tests' own process."""
    with service(tmp_path_factory.mktemp("data"), InlineExecutor()) as client:
        yield client


def robot_with(client, **changed):
    return client.post("/v1/robots", json=description() | {"prior": [BODY | changed, BODY]}).json()["id"]


def test_without_a_log_the_answer_comes_at_once(client):
    impossible = robot_with(client, inertia_at_com=[0.01, 0.0, 0.0, 0.01, 0.0, 0.05])
    answer = client.post(f"/v1/robots/{impossible}/audit", json={"options": {"makers_mass": 5.0}})
    assert answer.status_code == 200
    document = AuditDocument.model_validate_json(answer.content)
    assert [(one.check, one.link) for one in document.remarks] == [("triangle_inequality", 1)]
    assert (document.total_mass.described, document.total_mass.maker) == (4.0, 5.0)
    assert document.judged is False


def test_with_a_log_a_job_names_what_the_log_contradicts(client):
    csv = {"Content-Type": "text/csv"}
    log = client.post("/v1/logs", content=csv_log(seconds=12.0, noise=0.05), headers=csv).json()["id"]
    far = robot_with(client, mass=0.2)
    answer = client.post(f"/v1/robots/{far}/audit", json={"logs": [log]}, headers={"Prefer": "wait=60"})
    assert (answer.status_code, answer.json()["kind"]) == (202, "audit")
    result = client.get(answer.headers["Location"] + "/results")
    document = AuditDocument.model_validate_json(result.content)
    assert document.judged
    assert document.contradicted
    assert document.corrected_robot is not None
    assert client.post("/v1/robots", json=result.json()["corrected_robot"]).status_code == 201


@pytest.mark.parametrize(
    ("body", "kind"),
    [
        ({"options": {"makers_mass": -1.0}}, "option"),
        ({"options": {"makers_mass": "heavy"}}, "option"),
        ({"options": {"estimator": "sdp"}}, "option"),
        ({"logs": ["log-none"]}, "unknown-reference"),
        ({"log": []}, "request"),
    ],
)
def test_what_cannot_be_audited_is_refused_in_words(client, body, kind):
    assert_problem(client.post(f"/v1/robots/{robot_with(client)}/audit", json=body), 422, kind)


def test_an_unknown_robot_is_not_found(client):
    assert_problem(client.post("/v1/robots/none/audit", json={}), 404, "not-found")


URDF = """<robot name="bar"><link name="base"/>
  <link name="bar"><!-- keep me --><inertial><origin xyz="0.5 0 0"/><mass value="0.4"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <joint name="pivot" type="continuous"><parent link="base"/><child link="bar"/><axis xyz="0 1 0"/></joint>
</robot>"""


def test_a_urdf_is_audited_and_corrected_in_the_terminal(tmp_path):
    arm, log, mended = (tmp_path / name for name in ("bar.urdf", "swing.csv", "mended.urdf"))
    arm.write_text(URDF)
    robot = robot_from_urdf(URDF)
    truth = from_mass_properties(2.0, robot.prior[0, 6:9] / 0.4, mass_properties(robot.prior[0])[2])
    state = swing(1, seconds=20.0)
    torque = standard_model(robot).torque(np.array([*truth, 0.05, 0.6, 0.8, 0.2]), state)
    torque += 0.02 * np.random.default_rng(1).normal(size=torque.shape)
    rows = np.column_stack([np.arange(2000) / 100.0, state.position, torque])
    np.savetxt(log, rows, delimiter=",", header="time,q_1,tau_1", comments="")
    alone = run("robots", "audit", str(arm), "--json", "--makers-mass", "9")
    assert [row["check"] for row in json.loads(alone.stdout)["remarks"]] == ["total_mass"]
    ended = run("robots", "audit", str(arm), str(log), "--urdf", str(mended), "--fail-on-findings")
    assert ended.exit_code == Exit.FOUND, ended.output
    assert "Contradicted: mass of link 1 (bar)" in " ".join(ended.stdout.split())
    assert "keep me" in mended.read_text()
    assert robot_from_urdf(mended.read_bytes()).prior[0, 9] == pytest.approx(2.0, rel=0.1)
    again = run("robots", "audit", str(mended), str(log), "--fail-on-findings")
    assert again.exit_code == 0, again.output
    refused = run("robots", "audit", str(mended), "--urdf", str(arm))
    assert refused.exit_code not in {0, Exit.FOUND}
    assert "no corrected description" in refused.output
