"""Only the chosen part of a URDF is judged, and what others write oddly but harmlessly is read and said."""

import numpy as np
import pytest

from tests.core.robot.urdf.makers import joint, link, robot
from veritorque.core.errors import RobotError
from veritorque.core.robot.inertia import from_mass_properties
from veritorque.core.robot.model import Limits
from veritorque.core.robot.plausibility import plausibility_warnings
from veritorque.core.robot.urdf.read import robot_from_urdf

BODY = from_mass_properties(2.0, np.array([0.1, 0.0, 0.0]), np.diag([0.02, 0.03, 0.04]))
PAIR = link("base") + link("tip", BODY)
HINGE = joint("a", "revolute", "base", "tip")
BODIES = "".join(link(name, BODY) for name in ("base", "left", "right", "finger", "head"))
HAND = (
    joint("l", "revolute", "base", "left")
    + joint("r", "revolute", "base", "right")
    + joint("f", "prismatic", "right", "finger")
    + joint("h", "revolute", "base", "head")
)


def _said(text: str) -> str:
    return " ".join(plausibility_warnings(robot_from_urdf(text)))


def _names(text: str, **part: object) -> list[str]:
    return [one.name for one in robot_from_urdf(text, **part).joints]


@pytest.mark.parametrize(
    "above",
    [
        joint("root", "floating", "world", "base"),
        joint("root", "planar", "world", "base"),
        joint("root", "revolute", "world", "base", axis=np.zeros(3)),
        joint("root", "revolute", "world", "base", '<limit lower="low"/>'),
        joint("root", "revolute", "world", "base", '<mimic joint="nobody"/>'),
        joint("root", "fixed", "world", "base") + joint("again", "fixed", "world", "base"),
        joint("root", "floating", "nowhere", "base"),
    ],
)
def test_what_lies_above_the_chosen_base_is_not_judged(above):
    assert _names(robot(link("world") + PAIR + above + HINGE), base_link="base") == ["a"]


def test_a_part_beside_the_chosen_chain_may_be_what_cannot_be_identified():
    text = robot(PAIR + link("ball") + HINGE + joint("free", "floating", "base", "ball"))
    assert _names(text, tip_link="tip") == ["a"]


def test_the_remedy_for_a_floating_base_names_the_link_to_start_at():
    with pytest.raises(RobotError) as caught:
        robot_from_urdf(robot(link("world") + PAIR + joint("root", "floating", "world", "base") + HINGE))
    assert "base_link=base" in caught.value.remedy


def test_several_tips_keep_several_chains():
    text = robot(BODIES + HAND)
    assert _names(text, tip_link=("left", "finger")) == ["l", "r", "f"]
    assert _names(text, tip_link="left, finger") == ["l", "r", "f"]
    assert _names(text.replace("left", "a,b"), tip_link="a,b") == ["l"]
    assert _names(text, tip_link=["left"]) == _names(text, tip_link="left") == ["l"]
    with pytest.raises(RobotError, match="does not exist"):
        robot_from_urdf(text, tip_link=("left", "nowhere"))


@pytest.mark.parametrize(
    "limit", ['<limit lower="1" upper="-1"/>', '<limit lower="0" upper="0"/>', '<limit effort="3"/>']
)
@pytest.mark.parametrize("kind", ["continuous", "fixed"])
def test_limits_of_joints_that_have_none_are_not_judged(kind, limit):
    text = robot(PAIR + link("more", BODY) + HINGE + joint("b", kind, "tip", "more", limit))
    assert [one.limits.position for one in robot_from_urdf(text).joints if one.name == "b"] in ([], [None])
    assert "limit" not in _said(text)


def test_a_lower_limit_above_the_upper_one_is_taken_for_none_and_said():
    text = robot(PAIR + joint("a", "revolute", "base", "tip", '<limit lower="1" upper="-1" effort="5"/>'))
    limits = robot_from_urdf(text).joints[0].limits
    assert (limits.position, limits.torque) == (None, 5.0)
    assert "taken to have no limit" in _said(text)
    assert "swap" not in _said(text)


@pytest.mark.parametrize("none", ["inf", "-inf", "nan", "", "1e308"])
def test_limits_without_a_value_are_none(none):
    limit = f'<limit lower="-1" upper="{none}" effort="{none}" velocity="{none}"/>'
    limits = robot_from_urdf(robot(PAIR + joint("a", "revolute", "base", "tip", limit))).joints[0].limits
    assert limits == Limits()


@pytest.mark.parametrize(
    "slip",
    [
        ('<limit lower="-2"', '<limit drake:acceleration="9" lower="-2"'),
        ("</robot>", '<drake:joint name="no joint"/></robot>'),
        ("<robot", '<!-- a <robot> --><robot drake:x="1"'),
        ("</robot>", "<gazebo><sensor:imu/></gazebo></robot>"),
    ],
)
@pytest.mark.parametrize("coded", [str, str.encode])
def test_a_prefix_that_nobody_declared_does_no_harm(slip, coded):
    text = robot(PAIR + HINGE).replace(*slip)
    assert ":" in text
    assert len(robot_from_urdf(coded(text)).joints) == 1


@pytest.mark.parametrize("start", ["\n", " \r\n\t", "\ufeff", "\ufeff\n"])
@pytest.mark.parametrize("coded", [str, str.encode])
def test_blank_lines_before_the_declaration_do_no_harm(start, coded):
    text = f'{start}<?xml version="1.0"?>\n{robot(PAIR + HINGE)}'
    assert len(robot_from_urdf(coded(text)).joints) == 1


def test_an_empty_name_of_the_robot_is_taken_and_reported_and_of_a_link_refused_with_a_remedy():
    text = robot(PAIR + HINGE).replace('name="made-up"', 'name=""')
    assert robot_from_urdf(text).name == "robot"
    assert "empty name" in _said(text)
    with pytest.raises(RobotError) as caught:
        robot_from_urdf(robot(PAIR + link("") + HINGE))
    assert caught.value.remedy == "fill in the attribute name"


def test_angles_in_degrees_and_almost_right_ones_are_reported_on_the_way_to_what_moves():
    turned = HINGE.replace('rpy="0.0 0.0 0.0"', 'rpy="90 0 1.57"')
    said = _said(robot(PAIR + turned))
    assert "joint a: roll is 90 rad, more than a turn; were degrees meant?" in said
    assert "right angles meant?): joint a: yaw 1.57 rad" in said
    camera = joint("c", "fixed", "tip", "camera").replace('rpy="0.0 0.0 0.0"', 'rpy="90 0 1.57"')
    assert not _said(robot(PAIR + link("camera") + HINGE + camera))


def test_damping_and_friction_are_said_to_be_left_to_the_log():
    text = robot(PAIR + joint("a", "revolute", "base", "tip", '<dynamics damping="0.7" friction="0"/>'))
    assert "damping and friction of joint a" in _said(text)
    assert not _said(text.replace("0.7", "0.0"))


@pytest.mark.parametrize(("tag", "name"), [("mujoco", "MJCF"), ("sdf", "SDF")])
def test_another_format_is_named_with_how_to_convert_it(tag, name):
    with pytest.raises(RobotError, match=name) as caught:
        robot_from_urdf(f'<{tag} model="arm"/>')
    assert "convert" in caught.value.remedy


def test_five_digits_in_fixed_joints_shift_nothing():
    # As written, the tip's axis would lie 1.5 micrometres beside the one that carries it.
    def text(quarter: float) -> str:
        turn = f'rpy="{quarter} 0 0"'
        flange = joint("weld", "fixed", "tip", "flange").replace('rpy="0.0 0.0 0.0"', turn)
        last = joint("b", "revolute", "flange", "last").replace('xyz="0.0 0.0 0.0"', 'xyz="0 0 0.4"')
        return robot(PAIR + link("flange") + link("last", BODY) + HINGE + flange + last)

    exact, rounded = (robot_from_urdf(text(angle)).links[1] for angle in (np.pi / 2, 1.5708))
    assert np.array_equal(exact.rotation, rounded.rotation)
    assert np.array_equal(exact.translation, rounded.translation)
