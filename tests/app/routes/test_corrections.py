"""A correction that is pasted, as the page does it, makes robot and log agree."""

import json

import numpy as np
import pytest

from tests.app.conftest import service
from tests.app.planar_arm import columns, description
from tests.app.stubs import InlineExecutor

CSV = {"Content-Type": "text/csv"}
ROBOT = description()


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A service which computes with the real science, in the tests' own process."""
    with service(tmp_path_factory.mktemp("data"), InlineExecutor()) as client:
        yield client


def table(change):
    time, position, torque = columns(seconds=8.0, noise=0.02)
    velocity = np.gradient(position, time, axis=0)
    series = change(time, position, velocity, torque)
    head = "time,q_1,q_2,qd_1,qd_2,tau_1,tau_2"
    rows = [",".join(f"{value:.7f}" for value in row) for row in np.column_stack(series)]
    return "\n".join([head, *rows]).encode()


def checked(client, robot, log):
    body = {"kind": "check", "robot": robot, "logs": [log], "options": {}}
    job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=60"}).json()
    assert job["state"] == "successful", job["problem"]
    return client.get(job["links"]["results"]).json()


SPOILT = {
    "channels_swapped": (lambda t, q, dq, tau: (t, q, dq, tau[:, ::-1]), {}),
    "mounting": (lambda *series: series, {"gravity": [9.81, 0.0, 0.0]}),
    "convention": (
        lambda *series: series,
        {"joints": [joint | {"d": 0.0, "r": joint["d"]} for joint in ROBOT["joints"]]},
    ),
    "time_base": (lambda t, q, dq, tau: (2.0 * t, q, dq, tau), {}),
}


def test_one_correction_takes_all_conflicts_of_all_logs(client):
    def clocks(slower):
        return table(lambda t, q, dq, tau: (slower * t, q, dq, tau))

    logs = [client.post("/v1/logs", content=clocks(slower), headers=CSV).json() for slower in (1.0, 2.0)]
    tilted = client.post("/v1/robots", json=ROBOT | {"gravity": [9.81, 0.0, 0.0]}).json()["id"]
    body = {"kind": "check", "robot": tilted, "logs": [log["id"] for log in logs], "options": {}}
    job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=60"}).json()
    found = client.get(job["links"]["results"]).json()["conflicts"]
    assert "time_base" in [conflict["conflict"] for conflict in found]
    assert len({json.dumps(conflict["correction"]) for conflict in found}) == 1
    sound, slow = found[0]["correction"]["mappings"]
    assert (sound.get("rate_hz"), slow["time"]) == (None, None)
    assert slow["rate_hz"] == pytest.approx(logs[0]["rate_hz"], rel=0.01)


@pytest.mark.parametrize("conflict", SPOILT)
def test_a_pasted_correction_makes_robot_and_log_agree(client, conflict):
    change, described = SPOILT[conflict]
    log = client.post("/v1/logs", content=table(change), headers=CSV).json()["id"]
    robot = client.post("/v1/robots", json=ROBOT | described).json()["id"]
    before = checked(client, robot, log)
    assert conflict in [found["conflict"] for found in before["conflicts"]]
    correction = before["conflicts"][0]["correction"]
    if correction["mapping"]:
        again = client.post(f"/v1/logs/{log}/readings", json={"mapping": correction["mapping"]})
        assert again.status_code == 201, again.text
        log = again.json()["id"]
    if correction["robot"]:
        whole = client.get(f"/v1/robots/{robot}").json()["description"]
        edited = client.post("/v1/robots", json=whole | correction["robot"])
        assert edited.status_code == 201, edited.text
        robot = edited.json()["id"]
    after = checked(client, robot, log)
    assert (after["agreement"], after["conflicts"]) == ("yes", [])
