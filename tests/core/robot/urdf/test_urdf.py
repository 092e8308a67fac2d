"""The URDF reader against another reader of the same files, and what it does with every kind of joint.

Tolerance: both readers compute the same products of rotations in another order; 1e-10 of a joint's largest
torque leaves room for rounding and none for a wrong frame.
"""

import json
from xml.etree import ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.robot.urdf.makers import joint, link, random_urdf, robot
from tests.tools import Motion, pinocchio_torque, random_motion, shared
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.inertia import from_mass_properties, mass_properties
from veritorque.core.robot.model import RobotModel
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.robot.writing import to_description

BODY = from_mass_properties(2.0, np.array([0.1, 0.0, 0.0]), np.diag([0.02, 0.03, 0.04]))
ARM = robot(
    link("base", BODY)
    + link("upper", BODY)
    + link("lower", BODY)
    + link("hand", BODY)
    + joint("wrist", "fixed", "lower", "hand")
    + joint("elbow", "revolute", "upper", "lower", axis=np.array([0, 2, 0]))
    + joint("shoulder", "continuous", "base", "upper", axis=np.array([0, 0, 1]))
)


def _torque_by_pinocchio(text: str, ours: RobotModel, motion: Motion) -> np.ndarray:
    """Let pinocchio read the URDF, move its joints as ours move, and gather mimic joints by virtual work."""
    model = pin.buildModelFromXML(text)
    data = model.createData()
    joint_of = {one.find("child").get("link"): one.get("name") for one in ET.fromstring(text).iter("joint")}
    total = np.zeros_like(motion.position)
    for sample in range(len(total)):
        q, dq, ddq = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        for one in ours.links:
            theirs = model.joints[model.getJointId(joint_of[one.name])]
            angle = one.ratio * motion.position[sample, one.joint - 1] + one.offset
            q[theirs.idx_q : theirs.idx_q + theirs.nq] = (
                angle if theirs.nq == 1 else (np.cos(angle), np.sin(angle))
            )
            dq[theirs.idx_v] = one.ratio * motion.velocity[sample, one.joint - 1]
            ddq[theirs.idx_v] = one.ratio * motion.acceleration[sample, one.joint - 1]
        torque = pin.rnea(model, data, q, dq, ddq)
        for one in ours.links:
            theirs = model.joints[model.getJointId(joint_of[one.name])]
            total[sample, one.joint - 1] += one.ratio * torque[theirs.idx_v]
    return total


def _difference(one: np.ndarray, other: np.ndarray) -> float:
    """Compare with the largest torque of all joints: a URDF may hold joints that need none at all."""
    return float(np.abs(one - other).max() / np.abs(other).max())


@given(st.integers(0, 2**32 - 1), st.integers(2, 14))
def test_any_tree_needs_the_torque_that_another_reader_of_the_same_urdf_finds(seed, links):
    rng = np.random.default_rng(seed)
    text = random_urdf(rng, links)
    ours = robot_from_urdf(text)
    motion = random_motion(rng, len(ours.joints), samples=3)
    theirs = _torque_by_pinocchio(text, ours, motion)
    assert _difference(pinocchio_torque(ours, ours.prior, motion), theirs) < 1e-10


@pytest.mark.parametrize("name", ["ur10e_open", "staubli_tx40"])
def test_a_real_robot_needs_the_torque_that_another_reader_of_its_urdf_finds(name):
    text = shared(f"data/{name}/robot.urdf").read_text()
    ours = robot_from_urdf(text)
    motion = random_motion(np.random.default_rng(0), 6, samples=20)
    theirs = _torque_by_pinocchio(text.partition("?>")[2], ours, motion)
    assert _difference(pinocchio_torque(ours, ours.prior, motion), theirs) < 1e-10


@given(st.integers(0, 2**32 - 1))
def test_a_urdf_can_be_kept_as_a_description(seed):
    rng = np.random.default_rng(seed)
    ours = robot_from_urdf(
        robot(link("base") + link("tip", BODY) + joint("a", "revolute", "base", "tip", rng=rng))
    )
    document = json.dumps(to_description(ours))
    assert json.dumps(to_description(robot_from_description(json.loads(document)))) == document


def test_the_joints_of_a_serial_arm_are_numbered_from_base_to_tip_whatever_their_order_in_the_file():
    arm = robot_from_urdf(ARM)
    assert [one.name for one in arm.joints] == ["shoulder", "elbow"]
    assert [one.antecedent for one in arm.links] == [0, 1]


def test_a_body_welded_to_a_link_is_carried_by_it_and_one_welded_to_the_base_is_dropped():
    masses = [mass_properties(body)[0] for body in robot_from_urdf(ARM).prior]
    assert masses == [2.0, 4.0]


def test_an_axis_of_any_length_is_a_direction():
    np.testing.assert_allclose(robot_from_urdf(ARM).links[1].rotation @ [0, 0, 1], [0, 1, 0], atol=1e-15)


def test_an_axis_that_is_not_given_is_x():
    arm = robot_from_urdf(robot(link("base") + link("tip") + joint("a", "revolute", "base", "tip")))
    np.testing.assert_allclose(arm.links[0].rotation @ [0, 0, 1], [1, 0, 0], atol=1e-15)


def test_without_any_inertial_there_is_no_prior():
    arm = robot_from_urdf(robot(link("base", BODY) + link("tip") + joint("a", "revolute", "base", "tip")))
    assert arm.prior is None


def test_limits_are_read_and_zero_means_unknown():
    limits = {one.name: one.limits for one in robot_from_urdf(ARM).joints}
    assert limits["elbow"].position == (-2.0, 2.0)
    assert (limits["elbow"].velocity, limits["elbow"].torque) == (3.0, 50.0)
    assert limits["shoulder"].position is None  # a continuous joint has no end
    unknown = '<limit lower="0" upper="0" effort="0" velocity="0"/>'
    arm = robot_from_urdf(robot(link("base") + link("tip") + joint("a", "revolute", "base", "tip", unknown)))
    assert arm.joints[0].limits.position is None
    assert (arm.joints[0].limits.velocity, arm.joints[0].limits.torque) == (None, None)


def test_gravity_is_given_in_the_base_frame():
    np.testing.assert_array_equal(robot_from_urdf(ARM, gravity=(1.0, 2.0, 3.0)).gravity, [1.0, 2.0, 3.0])


def test_a_mimic_of_a_mimic_follows_the_joint_that_moves_by_itself():
    follow = '<mimic joint="{}" multiplier="{}" offset="{}"/>'
    arm = robot_from_urdf(
        robot(
            "".join(link(name) for name in "abcd")
            + joint("third", "revolute", "a", "d", follow.format("second", 3, 0.5))
            + joint("second", "prismatic", "a", "c", follow.format("first", -2, 0.1))
            + joint("first", "revolute", "a", "b")
        )
    )
    assert [one.name for one in arm.joints] == ["first"]
    third = next(one for one in arm.links if one.name == "d")
    assert (third.ratio, third.offset) == pytest.approx((-6.0, 0.8))  # 3 (-2 q + 0.1) + 0.5


TREE = robot(
    "".join(link(name, BODY) for name in ("base", "torso", "left", "right", "finger", "tool"))
    + joint("waist", "revolute", "base", "torso")
    + joint("left_arm", "revolute", "torso", "left")
    + joint("right_arm", "revolute", "torso", "right")
    + joint("grip", "prismatic", "left", "finger")
    + joint("mount", "fixed", "left", "tool")
)


def test_all_branches_are_taken_by_default_depth_first():
    assert [one.name for one in robot_from_urdf(TREE).joints] == ["waist", "left_arm", "grip", "right_arm"]


def test_a_subtree_can_be_chosen_and_what_carries_it_is_left_out():
    part = robot_from_urdf(TREE, base_link="torso")
    assert [one.name for one in part.joints] == ["left_arm", "grip", "right_arm"]


def test_a_chain_can_be_chosen_and_goes_on_carrying_what_hangs_beside_it():
    chain = robot_from_urdf(TREE, tip_link="left")
    assert [one.name for one in chain.joints] == ["waist", "left_arm"]
    assert [mass_properties(body)[0] for body in chain.prior] == [
        4.0,
        6.0,
    ]  # torso + right; left + finger + tool
