"""Descriptions in and out: kinematics as written, exact round trips, refusals that name joint and field."""

import copy
import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tools import Motion, pinocchio_torque, random_bodies, random_robot, shared, with_mimics
from veritorque.core.errors import RobotError
from veritorque.core.robot.builtin import builtin_description
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.inertia import mass_properties
from veritorque.core.robot.model import Joint, Link, RobotModel
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.robot.writing import to_description

QUARTER = np.pi / 2
ROW = {"type": "revolute", "alpha": 0.0, "d": 0.0, "r": 0.1, "theta_offset": 0.0}


def _document(robot: RobotModel) -> str:
    return json.dumps(to_description(robot))


def _two_joints(**changes: object) -> dict:
    return {"name": "two", "joints": [dict(ROW), dict(ROW)], "gravity": [0.0, 0.0, -9.81]} | changes


def _changed(**changes: object) -> dict:
    """Give two joints, the second with changed fields; None removes one."""
    row = {name: value for name, value in (ROW | changes).items() if value is not ...}
    return _two_joints(joints=[dict(ROW), row])


@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.booleans(), st.booleans())
def test_any_robot_comes_back_from_its_description_byte_for_byte(seed, links, tree, mimics):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, links, tree=tree)
    robot = with_mimics(robot, rng) if mimics else robot
    robot = RobotModel(
        robot.name,
        robot.links,
        robot.joints,
        robot.gravity,
        prior=random_bodies(rng, links) if tree else None,
    )
    document = _document(robot)
    again = robot_from_description(json.loads(document))
    assert _document(again) == document
    for before, after in zip(robot.links, again.links, strict=True):
        assert np.array_equal(before.rotation, after.rotation)
        assert np.array_equal(before.translation, after.translation)
        for field in ("kind", "antecedent", "joint", "ratio", "offset"):
            assert getattr(before, field) == getattr(after, field)


@pytest.mark.parametrize("name", ["yumi-left", "yumi"])
def test_a_table_comes_back_as_the_same_table(name):
    description = builtin_description(name)
    assert json.dumps(description) == _document(robot_from_description(json.loads(json.dumps(description))))


def test_couplings_priors_and_drives_come_back():
    standard = dict(zip(("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"), range(10), strict=True))
    description = to_description(
        robot_from_description(
            _two_joints(
                joints=[
                    ROW
                    | {
                        "limits": {"position": [-1, 2], "velocity": 3},
                        "torque_constant": 0.2,
                        "gear_ratio": -48,
                    },
                    ROW | {"rotor_inertia": False, "friction": ["coulomb"], "type": "prismatic"},
                ],
                couplings=[{"name": "motor 2", "joints": [1, 2], "weights": [1, 1]}],
                prior=[{"standard": standard}, {"standard": standard}],
            )
        )
    )
    first, second = description["joints"]
    assert first["limits"] == {"position": [-1.0, 2.0], "velocity": 3.0, "torque": None}
    assert (first["torque_constant"], first["gear_ratio"]) == (0.2, -48.0)
    assert (second["rotor_inertia"], second["friction"], second["type"]) == (False, ["coulomb"], "prismatic")
    assert description["couplings"] == [
        {"name": "motor 2", "number": 2, "joints": [1, 2], "weights": [1.0, 1.0]}
    ]
    assert description["prior"][1]["standard"] == standard
    assert json.dumps(description) == _document(robot_from_description(description))


def test_a_prior_by_mass_and_centre_is_the_same_body_about_the_frame_origin():
    body = {
        "mass": 2.0,
        "center_of_mass": [0.1, 0.2, 0.3],
        "inertia_at_com": [0.04, 0.001, 0.0, 0.05, 0.0, 0.06],
    }
    robot = robot_from_description(_two_joints(prior=[body, body]))
    mass, centre, inertia = mass_properties(robot.prior[1])
    assert mass == 2.0
    np.testing.assert_allclose(centre, body["center_of_mass"], rtol=1e-15)
    np.testing.assert_allclose(inertia, [[0.04, 0.001, 0], [0.001, 0.05, 0], [0, 0, 0.06]], atol=1e-15)


@pytest.mark.parametrize("turned", [False, True], ids=["shifted", "turned"])
def test_a_repaired_link_is_not_written_as_the_row_it_was_read_from(turned):
    robot = robot_from_description(_two_joints())
    old = robot.links[1]
    place = (
        (np.diag([1.0, -1.0, -1.0]), old.translation) if turned else (old.rotation, np.array([0.0, 0.0, 0.2]))
    )
    moved = Link("moved", "revolute", 1, 2, *place, row=old.row)
    description = to_description(RobotModel("two", (robot.links[0], moved), robot.joints, robot.gravity))
    assert description["convention"] == "frames"
    assert description["joints"][1]["rotation"] == place[0].tolist()
    assert description["joints"][1]["translation"] == place[1].tolist()


def test_joints_numbered_against_their_links_are_refused_rather_than_renumbered():
    place = (np.eye(3), np.zeros(3))
    links = (Link("a", "revolute", 0, 2, *place), Link("b", "revolute", 1, 1, *place))
    with pytest.raises(RobotError, match="numbered against the order"):
        to_description(RobotModel("crossed", links, (Joint("one"), Joint("two")), np.zeros(3)))


def test_what_is_not_said_takes_its_default():
    robot = robot_from_description({"name": "plain", "joints": [ROW, ROW | {"antecedent": 0}, ROW]})
    assert [link.antecedent for link in robot.links] == [0, 0, 2]
    assert [joint.name for joint in robot.joints] == ["joint_1", "joint_2", "joint_3"]
    assert robot.joints[0].friction == ("viscous", "coulomb", "offset")
    assert list(robot.gravity) == [0.0, 0.0, -9.81]


def test_the_table_and_the_urdf_of_a_staubli_tx40_need_the_same_torque_for_the_same_bodies():
    from_urdf = robot_from_urdf(shared("data/staubli_tx40/robot.urdf").read_bytes())
    table = json.loads(shared("data/staubli_tx40/model_mdh.json").read_text())
    rows = [
        ROW | {"alpha": row["alpha"], "d": row["d"], "r": row["r"], "theta_offset": row["theta"]}
        for row in table["mdh"]
    ]
    from_table = robot_from_description({"name": "tx40", "joints": rows, "gravity": table["gravity"]})
    rng = np.random.default_rng(0)
    bodies = random_bodies(rng, 6)
    position = rng.uniform(-3, 3, (20, 6))
    still = Motion(position, np.zeros_like(position), np.zeros_like(position))
    # The URDF writes pi/2 with twelve digits.
    np.testing.assert_allclose(
        pinocchio_torque(from_table, bodies, still), pinocchio_torque(from_urdf, bodies, still), atol=1e-9
    )


BAD_ROWS = {
    "a missing alpha": ({"alpha": ...}, "alpha", "an angle in rad about x"),
    "a missing d": ({"d": ...}, "d", "a distance in m along x"),
    "a missing r": ({"r": ...}, "r", "a distance in m along z"),
    "a missing theta_offset": ({"theta_offset": ...}, "theta_offset", "an angle in rad about z"),
    "a missing type": ({"type": ...}, "type", "revolute or prismatic"),
    "a text for a number": ({"alpha": "1.57"}, "alpha", "an angle in rad"),
    "a truth value for a number": ({"d": False}, "d", "a distance in m"),
    "null for a number": ({"r": None}, "r", "a distance in m"),
    "not a number": ({"alpha": float("nan")}, "alpha", "an angle"),
    "infinity": ({"r": float("inf")}, "r", "a distance"),
    "a number beyond all robots": ({"r": 1e200}, "r", "a distance"),
    "an integer beyond all floats": ({"r": 10**400}, "r", "a distance"),
    "a type that does not exist": ({"type": "spherical"}, "type", "revolute or prismatic"),
    "an antecedent that comes later": ({"antecedent": 2}, "antecedent", "0 for the base"),
    "half an antecedent": ({"antecedent": 0.5}, "antecedent", "0 for the base"),
    "friction that does not exist": ({"friction": ["stribeck"]}, "friction", "viscous, coulomb, offset"),
    "friction in one word": ({"friction": "viscous"}, "friction", "a list"),
    "a gear of ratio zero": ({"gear_ratio": 0}, "gear_ratio", "motor turns"),
    "a name taken": ({"name": "joint_1"}, "name", "a text"),
    "an empty name": ({"name": ""}, "name", "a text"),
    "a name of blanks": ({"name": "  "}, "name", "a text"),
    "a name with a line break": ({"name": "a\nb"}, "name", "a text"),
    "limits upside down": ({"limits": {"position": [1, -1]}}, "position", "[lower, upper]"),
    "a limit too few": ({"limits": {"position": [1]}}, "position", "[lower, upper]"),
    "a negative speed limit": ({"limits": {"velocity": -1}}, "velocity", "a positive number"),
}


@pytest.mark.parametrize(("changes", "field", "remedy"), BAD_ROWS.values(), ids=BAD_ROWS)
def test_a_bad_field_is_refused_with_its_joint_its_name_and_what_it_must_hold(changes, field, remedy):
    with pytest.raises(RobotError) as caught:
        robot_from_description(_changed(**changes))
    assert caught.value.cause.startswith("joint 2")
    assert caught.value.evidence["field"] == field
    assert caught.value.evidence["pointer"].startswith("/joints/1")
    assert remedy in caught.value.remedy


FRAME = {"type": "revolute", "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "translation": [0, 0, 0.1]}
BODY = {"mass": 1, "center_of_mass": [0, 0, 0], "inertia_at_com": [1, 0, 0, 1, 0, 1]}


def _frames(**changes: object) -> dict:
    return {"name": "frames", "convention": "frames", "joints": [dict(FRAME), FRAME | changes]}


BAD_DOCUMENTS = {
    "no object": ([1, 2], "is not an object"),
    "no name": ({"joints": [ROW]}, "name is missing"),
    "no joints": ({"name": "none"}, "joints is missing"),
    "an empty table": (_two_joints(joints=[]), "holds 0 entries"),
    "65 joints": (_two_joints(joints=[ROW] * 65), "holds 65 entries"),
    "joints that are no list": (_two_joints(joints="abc"), "is not a list"),
    "a row that is no object": (_two_joints(joints=[1]), "joint 1 is not an object"),
    "an unknown field": (_two_joints(colour="red"), "does not exist: colour"),
    "an unknown field of a joint": (_changed(sigma=0), "joint 2 holds a field that does not exist: sigma"),
    "a frame's field in a table": (_changed(rotation=[]), "does not exist: rotation"),
    "another convention": (_two_joints(convention="craig"), "is not one of modified-dh, frames"),
    "two components of gravity": (_two_joints(gravity=[0, -9.81]), "holds 2 entries"),
    "gravity without end": (_two_joints(gravity=[0, 0, float("-inf")]), "gravity is not finite"),
    "a prior for one joint": (_two_joints(prior=[BODY]), "holds 1 entries"),
    "a prior that is no object": (_two_joints(prior=[BODY, None]), "the prior of joint 2 is not an object"),
    "a prior given twice": (_two_joints(prior=[BODY, BODY | {"standard": {}}]), "is given twice"),
    "a prior without mass": (_two_joints(prior=[BODY, {"standard": {"XX": 1}}]), "XY is missing"),
    "a coupling of one joint": (
        _two_joints(couplings=[{"name": "m", "joints": [1], "weights": [1]}]),
        "holds 1 entries",
    ),
    "a coupling of a joint with itself": (
        _two_joints(couplings=[{"name": "m", "joints": [1, 1], "weights": [1, 1]}]),
        "two or more joints",
    ),
    "a coupling of joint 3 of 2": (
        _two_joints(couplings=[{"name": "m", "joints": [1, 3], "weights": [1, 1]}]),
        "joints is not between 1 and 2",
    ),
    "two couplings of one number": (
        _two_joints(couplings=[{"name": "m", "joints": [1, 2], "weights": [1, 1]}] * 2),
        "which is taken",
    ),
    "a rotation that stretches": (_frames(rotation=[[2, 0, 0], [0, 1, 0], [0, 0, 1]]), "is not a rotation"),
    "a rotation that mirrors": (_frames(rotation=[[1, 0, 0], [0, 1, 0], [0, 0, -1]]), "is not a rotation"),
    "a rotation of two rows": (_frames(rotation=[[1, 0, 0], [0, 1, 0]]), "holds 2 entries"),
    "mimicking nobody": (_frames(mimics="joint_9"), "names no joint that moves by itself"),
    "mimicking itself": (_frames(mimics="joint_2"), "names no joint that moves by itself"),
    "a mimic with limits of its own": (_frames(mimics="joint_1", limits={}), "belongs to joint_1"),
    "a table's field in a frame": (_frames(alpha=0.0), "does not exist: alpha"),
}


@pytest.mark.parametrize(("document", "cause"), BAD_DOCUMENTS.values(), ids=BAD_DOCUMENTS)
def test_a_bad_description_is_refused_with_cause_evidence_and_remedy(document, cause):
    before = copy.deepcopy(document)
    with pytest.raises(RobotError, match=cause) as caught:
        robot_from_description(document)
    assert caught.value.evidence
    assert caught.value.remedy
    assert document == before


def _turned(matrix: np.ndarray) -> np.ndarray:
    joint = {"type": "revolute", "rotation": matrix.tolist(), "translation": [0.0, 0.0, 0.0]}
    robot = robot_from_description({"name": "turned", "convention": "frames", "joints": [joint]})
    return robot.links[0].rotation


@pytest.mark.parametrize("digits", [6, 7, 10])
def test_a_rotation_written_with_few_digits_is_a_rotation(digits):
    exact = rotation_rpy(0.3, -1.1, 2.0)
    read = _turned(np.round(exact, digits))
    np.testing.assert_allclose(read @ read.T, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(read, exact, atol=2.0 * 10.0**-digits)


def test_a_rotation_with_all_its_digits_is_read_to_the_bit():
    exact = rotation_rpy(0.3, -1.1, np.pi / 2 + 3e-4)
    assert np.array_equal(_turned(exact), exact)


def test_a_matrix_computed_from_five_digits_of_a_right_angle_is_that_right_angle():
    assert np.array_equal(_turned(rotation_rpy(1.5708, 0.0, -1.5708)), rotation_rpy(QUARTER, 0.0, -QUARTER))


@pytest.mark.parametrize("letters", [{"a": 0.4, "theta": 0.0}, {"a": 0.4}, {"theta": 0.0}])
def test_nobody_is_told_to_leave_out_a_length_or_an_angle_of_another_table(letters):
    with pytest.raises(RobotError, match="field that does not exist") as refusal:
        robot_from_description(_changed(**letters))
    assert "Its a is d, its d is r" in refusal.value.remedy
    assert "docs/mdh.md" in refusal.value.remedy
