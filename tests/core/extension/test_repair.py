"""A repaired description is the robot as it is, can be sent again, and reads back as it was written."""

import json

import numpy as np
import pytest

from tests.core.diagnosis.scenes import skew_arm
from tests.core.estimate.worlds import wrist_robot
from tests.tools import random_bodies, random_motion
from veritorque.core.diagnosis.causes.registry import BY_ID
from veritorque.core.diagnosis.causes.repairs import corrects
from veritorque.core.document.numbers import plain
from veritorque.core.document.repairs import read_repairs, repaired_description
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.newton_euler import inverse_dynamics
from veritorque.core.extension.repair import Repair, repaired_robot
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.differences import differences
from veritorque.core.robot.model import RobotModel
from veritorque.core.robot.writing import to_description
from veritorque.core.signals.state import MotionState

LARGE = 0.3


def repair(cause: str, *joints: int, mended: str = "robot", **numbers: float) -> Repair:
    return Repair(cause, joints, mended, "", numbers)


REPAIRS = {
    "gravity_misalignment": repair("gravity_misalignment", 1, 2, 3, tilt_x=LARGE, tilt_y=-0.1),
    "encoder_offset": repair("encoder_offset", 2, offset=LARGE),
    "kinematic_error": repair("kinematic_error", 3, error=LARGE, d=LARGE),
    "rotor_inertia_missing": repair("rotor_inertia_missing", 1, IA=0.1),
    "joint_coupling": repair("joint_coupling", 2, 3, Fvm=0.1, Fcm=0.1, Iam=0.1, weight=-1.0),
}
every_repair = pytest.mark.parametrize("one", REPAIRS.values(), ids=REPAIRS)


def mimicking_arm() -> RobotModel:
    """Give two joints, the second of which moves two links, one of them backwards at half the angle."""
    upright = {"rotation": np.eye(3).tolist(), "translation": [0.3, 0.0, 0.1], "type": "revolute"}
    joints = [
        {**upright, "name": "shoulder", "rotation": [[1, 0, 0], [0, 0, -1], [0, 1, 0]]},
        {**upright, "name": "elbow"},
        {**upright, "name": "wrist", "mimics": "elbow", "ratio": -0.5, "offset": 0.2},
    ]
    return robot_from_description({"name": "mimic", "convention": "frames", "joints": joints})


def torque(robot: RobotModel, position: np.ndarray) -> np.ndarray:
    rng = np.random.default_rng(1)
    motion = random_motion(rng, len(robot.joints), samples=len(position))
    state = MotionState(position, motion.velocity, motion.acceleration)
    return inverse_dynamics(robot, random_bodies(rng, len(robot.links)), state)


def test_every_cause_that_corrects_the_description_is_repaired_here():
    assert set(REPAIRS) == {name for name, one in BY_ID.items() if corrects(one) == "robot"}


@every_repair
def test_a_repaired_description_is_another_robot_that_can_be_sent_and_reads_back_the_same(one):
    arm = skew_arm()
    sent = json.loads(json.dumps(plain(repaired_description(arm, [one]))))
    assert differences(arm, repaired_robot(arm, [one]))
    read = robot_from_description(sent)
    assert differences(read, repaired_robot(arm, [one])) == ()
    assert to_description(read) == sent
    assert sent["convention"] == to_description(arm)["convention"]


@every_repair
def test_a_sentence_says_what_goes_from_what_to_what(one):
    sentence = BY_ID[one.cause].repair(skew_arm(), one.joints, one.numbers)
    assert " from " in sentence
    assert " to " in sentence


@pytest.mark.parametrize("arm", [skew_arm(), mimicking_arm()], ids=["table", "frames"])
def test_a_robot_with_a_corrected_zero_has_at_a_reading_the_torque_of_the_true_angle(arm):
    true = np.random.default_rng(2).uniform(-3.0, 3.0, (5, len(arm.joints)))
    reading = true + LARGE * np.eye(len(arm.joints))[1]
    mended = repaired_robot(arm, [repair("encoder_offset", 2, offset=LARGE)])
    np.testing.assert_allclose(torque(mended, reading), torque(arm, true), rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("name", ["kinematic_error", "encoder_offset", "gravity_misalignment"])
def test_an_error_and_its_opposite_leave_the_robot_as_it_was(name):
    one = REPAIRS[name]
    opposite = Repair(name, one.joints, one.mends, "", {key: -value for key, value in one.numbers.items()})
    assert differences(repaired_robot(skew_arm(), [one, opposite]), skew_arm()) == ()


def test_gravity_turns_and_keeps_its_size():
    mended = repaired_robot(skew_arm(), [REPAIRS["gravity_misalignment"]])
    assert np.linalg.norm(mended.gravity) == pytest.approx(9.81)
    assert np.arccos(-mended.gravity[2] / 9.81) == pytest.approx(np.hypot(LARGE, 0.1))


def test_a_tilt_that_does_not_show_leaves_gravity_where_it_is_about_that_axis():
    mended = repaired_robot(skew_arm(), [repair("gravity_misalignment", 1, 2, 3, tilt_y=LARGE)])
    assert mended.gravity[1] == 0.0


def test_a_declared_coupling_brings_its_motor_into_the_model_under_a_number_of_its_own():
    mended = repaired_robot(wrist_robot(), [repair("joint_coupling", 1, 3, weight=1.0)])
    assert [one.number for one in mended.couplings] == [3, 4]
    names = {one.name for one in standard_model(mended).parameters}
    assert names - {one.name for one in standard_model(wrist_robot()).parameters} == {"IAM4", "FVM4", "FCM4"}


def test_repairs_of_one_robot_add_up():
    both = repaired_robot(skew_arm(), [REPAIRS["kinematic_error"], REPAIRS["encoder_offset"]])
    assert both.links[2].row.d == pytest.approx(0.3 + LARGE)
    assert both.links[1].row.theta == pytest.approx(-LARGE)


def test_where_nothing_in_the_description_changes_none_is_given():
    elsewhere = repair("torque_gain", 1, mended="log", relative_error=0.1)
    not_sure = repair("kinematic_error", 3, mended="nothing")
    assert repaired_description(skew_arm(), [elsewhere, not_sure]) is None


def test_repairs_are_read_from_a_result_as_they_were_written():
    listed = tuple(REPAIRS.values())
    document = {"diagnosis": {"repairs": json.loads(json.dumps(plain(listed)))}}
    assert read_repairs(document) == listed
    assert read_repairs({"diagnosis": None}) == ()
