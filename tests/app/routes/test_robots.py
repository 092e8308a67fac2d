from pathlib import Path

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import description
from tests.app.stubs import StubExecutor
from veritorque.app.schemas.examples import PENDULUM_URDF


def test_a_created_robot_is_found_where_the_answer_says(client):
    created = client.post("/v1/robots", json=description())
    assert created.status_code == 201
    assert client.get(created.headers["location"]).json() == created.json()


def test_the_same_content_is_the_same_robot_whatever_the_order_and_the_defaults(client):
    one = description()
    other = dict(reversed(one.items())) | {"couplings": [], "convention": "modified-dh"}
    assert (
        client.post("/v1/robots", json=one).json()["id"] == client.post("/v1/robots", json=other).json()["id"]
    )
    heavier = one | {"gravity": [0.0, -9.82, 0.0]}
    assert (
        client.post("/v1/robots", json=one).json()["id"]
        != client.post("/v1/robots", json=heavier).json()["id"]
    )


def test_a_description_that_was_answered_can_be_sent_again(client):
    created = client.post("/v1/robots", json=description()).json()
    assert client.post("/v1/robots", json=created["description"]).json()["id"] == created["id"]


def test_a_urdf_becomes_a_robot_with_its_inertias_as_prior(client):
    answer = client.post("/v1/robots", content=PENDULUM_URDF, headers={"Content-Type": "application/xml"})
    robot = answer.json()
    assert answer.status_code == 201
    assert (robot["name"], robot["joints"]) == ("pendulum", 1)
    assert robot["description"]["prior"][0]["standard"]["M"] == 1.0


def test_gravity_of_a_urdf_is_taken_from_the_query(client):
    answer = client.post(
        "/v1/robots?gravity=1,2,-9", content=PENDULUM_URDF, headers={"Content-Type": "application/xml"}
    )
    assert answer.json()["description"]["gravity"] == [1.0, 2.0, -9.0]


def test_built_in_robots_are_listed_first_and_stay(client):
    listed = client.get("/v1/robots").json()["robots"]
    assert [robot["id"] for robot in listed[:3]] == ["yumi-left", "yumi-right", "yumi"]
    assert_problem(client.delete("/v1/robots/yumi"), 409, "built-in")
    assert client.get("/v1/robots/yumi").json()["joints"] == 14


def test_pages_of_robots_join_without_a_gap(client, robot_id):
    for number in range(3):
        client.post("/v1/robots", json=description() | {"name": f"arm {number}"})
    everything = client.get("/v1/robots").json()
    listed, cursor = [], ""
    while cursor is not None:
        page = client.get(f"/v1/robots?limit=1{cursor}").json()
        listed += page["robots"]
        cursor = page["next"] and f"&cursor={page['next']}"
    assert (listed, everything["next"]) == (everything["robots"], None)


def test_a_deleted_robot_is_gone(client):
    created = client.post("/v1/robots", json=description() | {"name": "short-lived"})
    assert client.delete(created.headers["location"]).status_code == 204
    assert_problem(client.get(created.headers["location"]), 404, "not-found")


def test_degrees_for_radians_are_reported_in_the_answer(client):
    joint = description()["joints"][0] | {"alpha": 90.0}
    answer = client.post("/v1/robots", json=description() | {"joints": [joint]})
    assert answer.status_code == 201
    assert answer.json()["suspicions"]


def test_what_an_unfinished_job_needs_cannot_be_deleted(tmp_path: Path, log_bytes):
    with service(tmp_path, StubExecutor()) as client:
        robot = client.post("/v1/robots", json=description()).json()["id"]
        log = client.post("/v1/logs", content=log_bytes, headers={"Content-Type": "text/csv"}).json()["id"]
        job = client.post("/v1/jobs", json={"kind": "identify", "robot": robot, "logs": [log]}).json()
        assert_problem(client.delete(f"/v1/robots/{robot}"), 409, "in-use")
        assert_problem(client.delete(f"/v1/logs/{log}"), 409, "in-use")
        client.delete(f"/v1/jobs/{job['id']}")
        assert client.delete(f"/v1/robots/{robot}").status_code == 204
        assert client.delete(f"/v1/logs/{log}").status_code == 204


XML = {"Content-Type": "application/xml"}
HANDS = (
    '<robot name="hands"><link name="world"/><link name="torso"/><link name="left"/><link name="right"/>'
    '<link name="head"/><joint name="root" type="floating">'
    '<parent link="world"/><child link="torso"/></joint>'
    + "".join(
        f'<joint name="{side}_joint" type="continuous"><origin rpy="1.5708 0 0"/><parent link="torso"/>'
        f'<child link="{side}"/></joint>'
        for side in ("left", "right", "head")
    )
    + "</robot>"
)


def test_a_floating_base_is_cut_and_several_tips_are_kept(client):
    refused = client.post("/v1/robots", content=HANDS, headers=XML)
    assert "base_link=torso" in assert_problem(refused, 422, "robot")["remedy"]
    part = client.post("/v1/robots?base_link=torso&tip_link=left,head", content=HANDS, headers=XML).json()
    assert [joint["name"] for joint in part["description"]["joints"]] == ["left_joint", "head_joint"]


def test_what_is_odd_is_said_of_what_was_sent_and_not_of_what_gave_the_same_robot_before(client):
    whole = "/v1/robots?base_link=torso"
    short = client.post(whole, content=HANDS, headers=XML).json()
    exact = client.post(whole, content=HANDS.replace("1.5708", "1.5707963267948966"), headers=XML).json()
    assert short["id"] == exact["id"]
    assert any("right angles" in one for one in short["suspicions"])
    assert exact["suspicions"] == []
    assert client.get(f"/v1/robots/{short['id']}").json()["suspicions"] == short["suspicions"]


def test_base_parameters_state_how_their_number_was_decided(client, robot_id):
    rank = client.get(f"/v1/robots/{robot_id}/base-parameters").json()["rank"]
    assert rank["relative_tolerance"] < rank["least_share_kept"] <= 1.0
