"""Every file says what its numbers are, what it leaves out, and refuses what it cannot hold."""

import io
import json
import re
from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from scipy.io import loadmat

from tests.core.export.robots import ROBOTS, identified
from veritorque.core.document.model.caveats import REPRESENTATIVE
from veritorque.core.document.model.identified import IdentifiedRobot
from veritorque.core.document.model.model_file import write_model
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import OptionError, RobotError
from veritorque.core.export.c_header import write_c_header
from veritorque.core.export.matlab import write_matlab
from veritorque.core.export.mjcf import write_mjcf
from veritorque.core.export.sdf import write_sdf
from veritorque.core.export.urdf import write_urdf
from veritorque.core.export.yaml import write_yaml
from veritorque.core.reduction.base import base_model
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.inertia import from_mass_properties
from veritorque.core.robot.model import Link, RobotModel


def write_mat_as_text(found):
    notes = loadmat(io.BytesIO(write_matlab(found)), simplify_cells=True)["identified"]["notes"]
    return " ".join(notes)


SIMULATORS = {"URDF": write_urdf, "MJCF": write_mjcf, "SDFormat": write_sdf}
WRITERS = SIMULATORS | {
    "YAML": write_yaml,
    "MATLAB": write_mat_as_text,
    "C": write_c_header,
    "model": write_model,
}


def in_one_line(text):
    """Take line breaks, indentation and comment signs out."""
    return re.sub(r"\s+", " ", re.sub(r"\n(# |\s+)", " ", text))


@pytest.fixture(scope="module")
def found():
    robot = builtin_robot("yumi-left")
    base = base_model(standard_model(robot))
    known = identified(robot)
    return replace(
        known,
        identifiable=tuple(base.identifiability(column) for column in range(len(known.standard))),
        remarks=("The wrist was repaired.",),
    )


@pytest.mark.parametrize("name", WRITERS)
def test_every_file_says_that_it_shows_one_of_many_robots_with_the_same_torque(found, name):
    text = in_one_line(WRITERS[name](found))
    assert REPRESENTATIVE in text
    assert "The wrist was repaired." in text


@pytest.mark.parametrize("name", [name for name in WRITERS if name != "model"])
def test_every_file_lists_what_is_known_individually_only_in_combination_and_not_at_all(found, name):
    text = in_one_line(WRITERS[name](found))
    for title, kind in (
        ("Identifiable individually", "individually"),
        ("Identifiable only in combination", "in_combination"),
        ("Not identifiable (no effect on the torque)", "no"),
    ):
        (listed,) = re.findall(rf"{re.escape(title)}: (.*?)\.", text)[:1]
        wanted = [
            parameter.name
            for parameter, known in zip(found.model.parameters, found.identifiable, strict=True)
            if known == kind
        ]
        assert listed.split(", ") == wanted
        assert wanted


def test_the_model_file_marks_every_parameter_and_lists_the_groupings(found):
    document = json.loads(write_model(found))
    marks = [row["identifiable"] for term in document["terms"] for row in term["parameters"]]
    assert tuple(marks) == found.identifiable
    assert document["base_parameters"][0]["grouping"] == "ZZ1 + IA1"


@pytest.mark.parametrize("name", ["URDF", "SDFormat"])
def test_what_has_no_place_stands_in_a_comment_with_its_numbers(name):
    found = identified(ROBOTS["two coupled motors"])
    text = in_one_line(SIMULATORS[name](found))
    for symbol in ("IA1", "OFF3", "IAM4", "FCM9"):
        assert repr(found.values[symbol]) in text
    assert f"{name} cannot represent coupled motors" in text
    assert "motor wrist rotates with 1 joint_3 + -0.5 joint_4" in text


def test_what_is_not_there_is_not_said_to_be_left_out():
    robot = ROBOTS["in free fall"]
    model = standard_model(robot, ("rigid_body",))
    whole = identified(robot)
    bare = IdentifiedRobot(model, whole.links.ravel(), ("no",) * 30)
    assert "no place" not in write_urdf(bare)


@pytest.mark.parametrize("name", ["URDF", "MJCF", "SDFormat"])
def test_any_name_that_a_robot_may_have_stays_whole(name):
    plain = ROBOTS["yumi-left"]
    odd = 'arm --> "7" <&> */ \u00e9'
    joints = (replace(plain.joints[0], name=odd), *plain.joints[1:])
    links = (replace(plain.links[0], name="base"), *plain.links[1:])
    found = identified(replace(plain, name=odd, joints=joints, links=links))
    root = ET.fromstring(SIMULATORS[name](found))
    assert odd in [element.get("name") or element.get("model") for element in root.iter()]
    names = [one.get("name") for one in root.iter() if one.tag in ("link", "body")]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("of_joint", [False, True])
@pytest.mark.parametrize("name", ["joint_2", "base", "world", "world_to_base", "left::elbow", "__model__"])
def test_sdformat_calls_links_and_joints_by_names_that_nothing_else_has(name, of_joint):
    """A reader of SDFormat refuses a name that is given twice, and the names that are its own."""
    plain = ROBOTS["with mimics"]
    links = (replace(plain.links[0], name=name), *plain.links[1:])
    joints = (replace(plain.joints[1], name=name), *plain.joints[2:])
    named = replace(plain, name=name, links=links)
    robot = replace(named, joints=(plain.joints[0], *joints)) if of_joint else named
    model = ET.fromstring(write_sdf(identified(robot))).find("model")
    known = {tag: [one.get("name") for one in model.iter(tag)] for tag in ("link", "joint")}
    names = known["link"] + known["joint"]
    assert len(set(names)) == len(names) == len(robot.links) + len(robot.links) + 2
    for one in (*names, model.get("name")):
        assert one != "world"
        assert not re.search("::|^__.*__$", one)
    meant = {one.text for tag in ("parent", "child") for one in model.iter(tag)}
    assert meant == {"world", *known["link"]}
    assert {one.get("joint") for one in model.iter("mimic")} <= set(known["joint"])


def test_sdformat_holds_rotors_and_mimics_where_drake_reads_them():
    found = identified(ROBOTS["with mimics"])
    joints = {one.get("name"): one for one in ET.fromstring(write_sdf(found)).iter("joint")}
    namespace = {"drake": "drake.mit.edu"}
    for joint, inertia in zip(found.robot.joints, found.of_joints("IA"), strict=True):
        gear = (
            joints[joint.name].findtext(f"drake:{tag}", None, namespace)
            for tag in ("rotor_inertia", "gear_ratio")
        )
        assert [float(one) for one in gear] == [inertia, 1.0]
    for joint in joints.values():
        ours, theirs = joint.find("axis/mimic"), joint.find("drake:mimic", namespace)
        assert (ours is None) == (theirs is None)
        if ours is not None:
            told = [ours.get("joint"), ours.findtext("multiplier"), ours.findtext("offset")]
            assert list(theirs.attrib.values()) == told


def test_joints_keep_their_names_in_sdformat_by_which_logs_call_them():
    found = identified(ROBOTS["yumi-left"])
    root = ET.fromstring(write_sdf(found))
    moving = [one.get("name") for one in root.iter("joint") if one.get("type") != "fixed"]
    assert moving == [joint.name for joint in found.robot.joints]


def test_a_c_header_holds_names_that_would_end_its_comments_and_strings():
    found = identified(replace(ROBOTS["yumi-left"], name='7*/ "arm" \\'))
    text = write_c_header(found)
    assert r'"7*/ \"arm\" \\"' in text
    assert "static const veritorque_robot robot_7_arm = {" in text


@pytest.mark.parametrize("name", SIMULATORS)
@pytest.mark.parametrize(
    "body",
    [
        from_mass_properties(2.0, np.zeros(3), np.diag([0.1, 0.1, 0.3])),
        np.array([0, 0, 0, 0, 0, 0.1, 0, 0, 0, 0.0]),
        from_mass_properties(-1.0, np.zeros(3), -np.eye(3)),
    ],
    ids=["against the triangle inequality", "without mass", "negative"],
)
def test_an_inconsistent_body_is_refused_with_what_to_do(name, body):
    whole = identified(ROBOTS["yumi-left"])
    standard = whole.standard.copy()
    standard[10:20] = body
    broken = replace(whole, standard=standard)
    with pytest.raises(OptionError, match="link 2 is physically inconsistent") as caught:
        SIMULATORS[name](broken)
    assert "sdp" in caught.value.remedy
    for table in (write_yaml, write_c_header, write_model):
        assert table(broken)


@pytest.mark.parametrize("name", [*SIMULATORS, "C"])
def test_a_model_without_bodies_is_no_robots_file(name):
    model = standard_model(ROBOTS["yumi-left"], ("viscous",))
    found = IdentifiedRobot(model, np.ones(7), ("individually",) * 7)
    with pytest.raises(OptionError, match="no bodies") as caught:
        WRITERS[name](found)
    assert "rigid_body" in caught.value.remedy
    assert "FV7" in write_yaml(found)


@pytest.mark.parametrize("name", SIMULATORS)
def test_a_scaled_coordinate_is_refused_where_a_format_cannot_say_it(name):
    plain = ROBOTS["yumi-left"]
    scaled: Link = replace(plain.links[2], ratio=2.0)
    robot: RobotModel = replace(plain, links=(*plain.links[:2], scaled, *plain.links[3:]))
    with pytest.raises(RobotError, match="joint_3") as caught:
        SIMULATORS[name](identified(robot))
    assert caught.value.evidence["ratios"] == [2.0]
