"""URDFs that cannot be used: each is refused with a cause that says why, evidence and a remedy."""

import numpy as np
import pytest

from tests.core.robot.urdf.makers import joint, link, robot
from veritorque.core.errors import RobotError
from veritorque.core.robot.inertia import from_mass_properties
from veritorque.core.robot.plausibility import plausibility_warnings
from veritorque.core.robot.urdf.read import robot_from_urdf

PAIR = link("base") + link("tip")
HINGE = joint("a", "revolute", "base", "tip")
BOMB = '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><robot name="&b;"/>'
INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="{}"/>'


def _with_inertial(inside: str) -> str:
    return robot(f'<link name="base"/><link name="tip"><inertial>{inside}</inertial></link>' + HINGE)


BAD = {
    "nothing": ("", "not well-formed"),
    "broken XML": ("<robot", "not well-formed"),
    "bytes that are no text": (b"\xff\xfe\x00\x01", "not well-formed"),
    "an encoding that does not exist": (
        b'<?xml version="1.0" encoding="klingon"?><robot/>',
        "not well-formed",
    ),
    "an entity bomb": (BOMB, "document type or entities"),
    "an external entity": (
        '<!DOCTYPE r SYSTEM "file:///dev/null"><robot name="r"/>',
        "document type or entities",
    ),
    "another document": ('<sdf version="1.7"/>', "its root element is not robot"),
    "a robot without a name": ("<robot/>", "the document: the element robot has no name"),
    "a xacro": ('<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arm/></robot>', "is a xacro"),
    "a xacro without its namespace": ('<robot name="r"><xacro:arm/></robot>', "is a xacro"),
    "an unexpanded value": (robot(PAIR + HINGE.replace("0.0 0.0 0.0", "0 0 ${height}", 1)), "is a xacro"),
    "no links": (robot(""), "has no link"),
    "nothing that moves": (robot(PAIR + joint("a", "fixed", "base", "tip")), "no joint moves"),
    "two roots": (robot(PAIR + link("other") + HINGE), "several root links"),
    "a circle": (
        robot(
            PAIR
            + link("root")
            + joint("a", "revolute", "base", "tip")
            + joint("b", "revolute", "tip", "base")
        ),
        "form a loop",
    ),
    "a link on itself": (robot(PAIR + joint("a", "revolute", "tip", "tip")), "form a loop"),
    "a link on two joints": (
        robot(PAIR + HINGE + joint("b", "revolute", "base", "tip")),
        "has two parent joints",
    ),
    "an unknown parent": (robot(link("tip") + HINGE), "a names a parent link that does not exist"),
    "an unknown child": (robot(link("base") + HINGE), "a names a child link that does not exist"),
    "two links of one name": (robot(PAIR + link("tip") + HINGE), "two links have the same name"),
    "two joints of one name": (robot(PAIR + HINGE + HINGE), "two joints have the same name"),
    "a link without a name": (robot("<link/>"), "the element link has no name"),
    "a name of a thousand letters": (robot(link("x" * 1000)), "too long"),
    "an axis of length zero": (
        robot(PAIR + joint("a", "revolute", "base", "tip", axis=np.zeros(3))),
        "without a direction",
    ),
    "an axis that is not a number": (
        robot(PAIR + HINGE.replace("<limit", '<axis xyz="0 0 nan"/><limit')),
        "xyz does not hold 3",
    ),
    "an axis without end": (
        robot(PAIR + HINGE.replace("<limit", '<axis xyz="0 0 1e400"/><limit')),
        "xyz does not hold 3",
    ),
    "an axis of two numbers": (
        robot(PAIR + HINGE.replace("<limit", '<axis xyz="0 1"/><limit')),
        "xyz does not hold 3",
    ),
    "a limit in words": (
        robot(PAIR + joint("a", "revolute", "base", "tip", '<limit lower="low"/>')),
        "lower does not hold",
    ),
    "a floating joint": (robot(PAIR + joint("a", "floating", "base", "tip")), "cannot be identified"),
    "a planar joint": (robot(PAIR + joint("a", "planar", "base", "tip")), "cannot be identified"),
    "a joint without a parent": (
        robot(PAIR + '<joint name="a" type="revolute"><child link="tip"/></joint>'),
        "has no parent",
    ),
    "an inertial without mass": (_with_inertial(INERTIA.format(1)), "has no mass element"),
    "an inertial without inertia": (_with_inertial('<mass value="1"/>'), "has no inertia element"),
    "a mass in words": (
        _with_inertial('<mass value="heavy"/>' + INERTIA.format(1)),
        "value does not hold 1 finite",
    ),
    "a mimic of nobody": (
        robot(PAIR + joint("a", "revolute", "base", "tip", '<mimic joint="b"/>')),
        "mimics a joint that does not move",
    ),
    "a mimic of itself": (
        robot(PAIR + joint("a", "revolute", "base", "tip", '<mimic joint="a"/>')),
        "form a loop",
    ),
    "65 moving joints": (
        robot(
            "".join(link(f"l{n}") for n in range(66))
            + "".join(joint(f"j{n}", "revolute", f"l{n}", f"l{n + 1}") for n in range(65))
        ),
        "too many joints move",
    ),
    "more than 5 MB": (" " * 5_000_001, "too large"),
}


@pytest.mark.parametrize(("text", "cause"), BAD.values(), ids=BAD)
def test_a_urdf_that_cannot_be_used_is_refused_with_cause_evidence_and_remedy(text, cause):
    with pytest.raises(RobotError, match=cause) as caught:
        robot_from_urdf(text)
    assert caught.value.evidence
    assert caught.value.remedy
    assert len(str(caught.value)) < 2000


def test_the_remedy_for_a_xacro_is_to_expand_it():
    with pytest.raises(RobotError) as caught:
        robot_from_urdf(BAD["a xacro"][0])
    assert caught.value.remedy == "expand it first: xacro robot.urdf.xacro > robot.urdf"


@pytest.mark.parametrize(
    ("case", "name", "seen"),
    [("a xacro", "found", "the element xacro:arm"), ("an unexpanded value", "found", "0 0 ${height}")],
)
def test_evidence_quotes_a_urdf_as_it_is_written(case, name, seen):
    with pytest.raises(RobotError) as caught:
        robot_from_urdf(BAD[case][0])
    assert caught.value.evidence[name] == seen


def test_a_xacro_namespace_that_is_declared_and_not_used_is_no_xacro():
    text = robot(PAIR + HINGE).replace('name="made-up"', 'name="r" xmlns:xacro="http://ros.org/wiki/xacro"')
    assert len(robot_from_urdf(text).joints) == 1


def test_a_default_namespace_changes_nothing():
    text = robot(PAIR + HINGE).replace('name="made-up"', 'name="r" xmlns="http://example.org/urdf"')
    assert len(robot_from_urdf(text).joints) == 1


@pytest.mark.parametrize(
    ("choice", "cause"),
    [
        ({"base_link": "nowhere"}, "does not exist"),
        ({"tip_link": "nowhere"}, "does not exist"),
        ({"base_link": "tip", "tip_link": "base"}, "does not descend from base_link"),
        ({"base_link": "tip"}, "no joint moves"),
        ({"gravity": (0.0, 0.0)}, "not three finite numbers"),
        ({"gravity": (0.0, 0.0, float("nan"))}, "not three finite numbers"),
        ({"gravity": (0.0, 0.0, 1e300)}, "not three finite numbers of at most 1e"),
    ],
)
def test_a_choice_that_makes_no_sense_is_refused(choice, cause):
    with pytest.raises(RobotError, match=cause):
        robot_from_urdf(robot(PAIR + HINGE), **choice)


def test_a_base_may_be_chosen_where_there_are_several_roots():
    assert len(robot_from_urdf(robot(PAIR + link("other") + HINGE), base_link="base").joints) == 1


def test_elements_nested_a_hundred_thousand_deep_do_no_harm():
    depth = 100_000
    text = robot("<a>" * depth + "</a>" * depth + PAIR + HINGE)
    assert len(robot_from_urdf(text).joints) == 1


def test_five_thousand_welded_links_are_read():
    links = 5_000
    text = robot(
        "".join(f'<link name="l{n}"/>' for n in range(links))
        + "".join(
            f'<joint name="j{n}" type="fixed"><parent link="l{n}"/><child link="l{n + 1}"/></joint>'
            for n in range(1, links - 1)
        )
        + '<joint name="j0" type="revolute"><parent link="l0"/><child link="l1"/></joint>'
    )
    assert len(robot_from_urdf(text).joints) == 1


def test_an_inconsistent_body_is_kept_and_reported():
    arm = robot_from_urdf(_with_inertial('<mass value="1"/>' + INERTIA.format(3)))
    assert arm.prior is not None
    assert any(
        "link 1 (tip): the body of the prior is not physically" in line for line in plausibility_warnings(arm)
    )


def test_a_consistent_body_is_not_reported():
    body = from_mass_properties(1.0, np.ones(3), np.zeros((3, 3)))
    assert plausibility_warnings(robot_from_urdf(robot(link("base") + link("tip", body) + HINGE))) == ()
