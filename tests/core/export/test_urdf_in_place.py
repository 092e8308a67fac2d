"""A URDF that somebody has gets the identified bodies and friction, and keeps every other byte.

Tolerance: a body is expressed about its mass centre and turned into the URDF's frame and back; 1e-12 of its
largest number leaves room for the rounding of that and none for a wrong frame.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.export import engines
from tests.core.export.robots import ROBOTS, brisk, identified
from tests.core.robot.urdf.makers import random_urdf
from tests.core.robot.urdf.test_urdf import TREE
from tests.tools import shared
from veritorque.core.errors import RobotError
from veritorque.core.export.movers import movers
from veritorque.core.export.urdf import write_urdf
from veritorque.core.export.urdf_in_place import urdf_with_inertials
from veritorque.core.robot.differences import differences
from veritorque.core.robot.urdf.read import robot_from_urdf

CHANGED = re.compile(rb"<inertial>.*?</inertial>|<dynamics[^>]*>|<!--.*?-->|\s+", re.DOTALL)

DRESSED = b"""<?xml version='1.0' encoding="UTF-8"?>
<!-- drawn by hand -->
<robot name='dressed' xmlns:other="urn:other">
  <material name="grey"><color rgba=".5 .5 .5 1"/></material>
  <link name="base"/>
  <link name="arm \xc3\xa9 > 1"  />
  <link name="cover"><visual><geometry><mesh filename="package://arm/cover.stl" /></geometry></visual>
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="finger"><inertial>
    <mass value="0.1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint type='revolute' name='turn'><parent link="base"/><child link="arm \xc3\xa9 > 1"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1"/><dynamics damping="7"/><other:gear ratio="5"/></joint>
  <joint name="bolt" type="fixed"><parent link="arm \xc3\xa9 > 1"/><child link="cover"/></joint>
  <joint name="grip" type="prismatic"><parent link="cover"/><child link="finger"/></joint>
</robot>
"""


def untouched(text):
    """Leave out what may change, and open or close empty links alike."""
    return CHANGED.sub(b"", text).replace(b"></link>", b"/>")


def assert_same_bodies(one, other):
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * float(np.abs(other).max()))


@given(st.integers(0, 2**32 - 1), st.integers(1, 12))
def test_any_urdf_comes_back_with_the_identified_bodies_and_everything_else_as_it_was(seed, links):
    text = random_urdf(np.random.default_rng(seed), links).encode()
    found = identified(robot_from_urdf(text), seed % 1000)
    written = urdf_with_inertials(text, found)
    again = robot_from_urdf(written)
    assert differences(again, found.robot) == ()
    assert_same_bodies(again.prior, found.links)
    assert untouched(written) == untouched(text)


@pytest.mark.parametrize("name", ["ur10e_open", "staubli_tx40"])
def test_a_real_urdf_comes_back_with_the_identified_bodies_and_everything_else_as_it_was(name):
    text = shared(f"data/{name}/robot.urdf").read_bytes()
    found = identified(robot_from_urdf(text))
    written = urdf_with_inertials(text, found)
    assert_same_bodies(robot_from_urdf(written).prior, found.links)
    assert untouched(written) == untouched(text)


def test_pinocchio_needs_our_torque_for_the_changed_urdf():
    text = random_urdf(np.random.default_rng(12), 10).encode()
    found = identified(robot_from_urdf(text))
    written = urdf_with_inertials(text, found).decode()
    names, state = [joint.name for joint in found.robot.joints], brisk(found.robot)
    model = engines.pinocchio_of_urdf(written)
    theirs = engines.pinocchio_torque(model, names, state, engines.mimics_of_urdf(written))
    standing = found.model.torque(found.standard, state) - sum(
        found.of_joints(symbol) * series
        for symbol, series in (
            ("IA", state.acceleration),
            ("FV", state.velocity),
            ("FC", np.sign(state.velocity)),
            ("OFF", np.ones_like(state.velocity)),
        )
    )
    np.testing.assert_allclose(theirs, standing, rtol=0, atol=1e-9)
    places = [model.joints[model.getJointId(name)].idx_v for name in names]
    np.testing.assert_array_equal(model.damping[places], found.of_joints("FV"))


def test_meshes_comments_extensions_and_quotes_stay():
    found = identified(robot_from_urdf(DRESSED, tip_link="arm \u00e9 > 1"))
    written = urdf_with_inertials(DRESSED, found, tip_link="arm \u00e9 > 1")
    for kept in (b"<!-- drawn by hand -->", b"package://arm/cover.stl", b'<other:gear ratio="5"/>', b"rgba="):
        assert kept in written
    assert untouched(written) == untouched(DRESSED.replace(b"prismatic", b"fixed"))
    assert written.count(b"<dynamics") == 1


def test_what_rode_at_zero_beside_the_chain_is_fixed_and_counted_once():
    found = identified(robot_from_urdf(DRESSED, tip_link="arm \u00e9 > 1"))
    written = urdf_with_inertials(DRESSED, found, tip_link="arm \u00e9 > 1")
    whole = robot_from_urdf(written)
    assert [joint.name for joint in whole.joints] == ["turn"]
    assert_same_bodies(whole.prior, found.links)
    assert written.count(b"<inertial>") == 1


def test_a_joint_that_the_base_carries_beside_the_chain_keeps_moving():
    text = TREE.encode()
    found = identified(robot_from_urdf(text, base_link="torso", tip_link="left"))
    written = urdf_with_inertials(text, found, base_link="torso", tip_link="left")
    kinds = dict(re.findall(r'<joint name="(\w+)" type="(\w+)"', written.decode()))
    assert kinds == {
        "waist": "revolute",
        "left_arm": "revolute",
        "right_arm": "revolute",
        "grip": "fixed",
        "mount": "fixed",
    }


@pytest.mark.parametrize("name", ROBOTS)
def test_a_urdf_written_anew_is_read_as_the_same_bodies(name):
    found = identified(ROBOTS[name])
    again = robot_from_urdf(write_urdf(found))
    names = [joint.name for joint in found.robot.joints]
    assert sorted(joint.name for joint in again.joints) == sorted(names)
    # The reader turns a frame so that z is the axis: where the axis is -z, x stays and y and z turn round.
    backwards = {mover.link.name for mover in movers(found.robot) if mover.sign < 0.0}
    turned = np.array([1, -1, -1, 1, 1, 1, 1, -1, -1, 1])
    own = {link.name: body for link, body in zip(found.robot.links, found.links, strict=True)}
    for link, body in zip(again.links, again.prior, strict=True):
        assert_same_bodies(body, own[link.name] * (turned if link.name in backwards else 1.0))


def test_another_robots_urdf_is_refused():
    found = identified(robot_from_urdf(TREE))
    with pytest.raises(RobotError, match="another robot"):
        urdf_with_inertials(DRESSED, found)
    moved = replace(found.robot.links[1], translation=np.array([0.0, 0.0, 1e-6]))
    robot = replace(found.robot, links=(found.robot.links[0], moved, *found.robot.links[2:]))
    with pytest.raises(RobotError, match="another robot") as caught:
        urdf_with_inertials(TREE.encode(), identified(robot))
    assert caught.value.evidence["differ"] == ["the placement of link 2"]


def test_a_urdf_in_wide_characters_is_refused_with_what_to_do():
    text = DRESSED.decode().replace("UTF-8", "UTF-16").encode("utf-16")
    found = identified(robot_from_urdf(text))
    with pytest.raises(RobotError, match="UTF-8"):
        urdf_with_inertials(text, found)


@pytest.mark.parametrize(
    ("own", "other"),
    [
        (b"<?xml version='1.0'", b"\n \n<?xml version='1.0'"),
        (b"<?xml version='1.0'", b"\xef\xbb\xbf\n<?xml version='1.0'"),
        (b' xmlns:other="urn:other"', b""),
        (b"name='dressed'", b"name=''"),
        (
            b'<link name="base"/>',
            (
                b'<link name="base"/><link name="world"/><joint name="root" type="floating">'
                b'<parent link="world"/><child link="base"/></joint>'
            ),
        ),
        (b'<limit lower="-1" upper="1"/>', b'<limit lower="1" upper="-1"/>'),
    ],
)
def test_what_is_odd_and_read_all_the_same_stays_in_the_file(own, other):
    text = DRESSED.replace(own, other)
    assert text != DRESSED
    found = identified(robot_from_urdf(text, base_link="base"))
    written = urdf_with_inertials(text, found, base_link="base")
    assert untouched(written) == untouched(text)
    assert_same_bodies(robot_from_urdf(written, base_link="base").prior, found.links)


def test_the_chains_of_several_tips_are_those_that_are_changed():
    text = TREE.encode()
    tips = ("left", "right")
    found = identified(robot_from_urdf(text, tip_link=tips))
    written = urdf_with_inertials(text, found, tip_link=tips)
    assert_same_bodies(robot_from_urdf(written, tip_link=tips).prior, found.links)
