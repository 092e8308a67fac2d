"""The built-in robots, held against the numbers they are built from."""

import numpy as np
import pytest

from tests.tools import Motion, pinocchio_model, pinocchio_torque, random_bodies, random_motion
from veritorque.core.errors import RobotError
from veritorque.core.robot.builtin import builtin_description, builtin_robot, builtin_robots
from veritorque.core.robot.plausibility import plausibility_warnings
from veritorque.core.robot.writing import to_description

# Gravity in the frames of the tilted arm bases, m/s2, given to three decimals with the mounts' rpy.
TILTED = {"yumi-left": (-5.307, -6.843, -4.609), "yumi-right": (-5.279, 6.865, -4.609)}
LIMITS_DEGREES = [
    (-168.5, 168.5),
    (-143.5, 43.5),
    (-168.5, 168.5),
    (-123.5, 80),
    (-290, 290),
    (-88, 138),
    (-229, 229),
]


@pytest.mark.parametrize("name", TILTED)
def test_a_yumi_arm_feels_gravity_along_its_tilted_base(name):
    np.testing.assert_allclose(builtin_robot(name).gravity, TILTED[name], atol=1e-3)


@pytest.mark.parametrize("name", builtin_robots())
def test_a_builtin_robot_raises_no_warning_and_is_its_own_description(name):
    assert plausibility_warnings(builtin_robot(name)) == ()
    assert to_description(builtin_robot(name)) == builtin_description(name)


def test_the_joint_limits_of_yumi_are_those_of_the_seed_in_both_arms():
    limits = [joint.limits.position for joint in builtin_robot("yumi").joints]
    np.testing.assert_allclose(np.degrees(limits), LIMITS_DEGREES * 2, rtol=1e-14)


@pytest.mark.parametrize(("arm", "side"), [("yumi-left", 0), ("yumi-right", 7)])
def test_an_arm_on_the_body_needs_the_torque_of_the_arm_alone_under_tilted_gravity(arm, side):
    rng = np.random.default_rng(0)
    bodies, motion = random_bodies(rng, 14), random_motion(rng, 14)
    alone = Motion(
        *(series[:, side : side + 7] for series in (motion.position, motion.velocity, motion.acceleration))
    )
    np.testing.assert_allclose(
        pinocchio_torque(builtin_robot("yumi"), bodies, motion)[:, side : side + 7],
        pinocchio_torque(builtin_robot(arm), bodies[side : side + 7], alone),
        rtol=1e-10,
        atol=1e-10,
    )


def test_the_arms_stand_where_the_body_carries_them():
    robot = builtin_robot("yumi")
    model = pinocchio_model(robot, np.zeros((14, 10)))
    for first, y in ((0, 0.0725), (7, -0.0725)):
        placement = model.jointPlacements[first + 1]
        shoulder = placement.translation - 0.166 * placement.rotation[:, 2]
        np.testing.assert_allclose(shoulder, (0.05355, y, 0.41492), atol=1e-12)


def test_a_robot_that_is_not_built_in_is_refused_with_the_list_of_those_that_are():
    with pytest.raises(RobotError) as caught:
        builtin_robot("yumi-middle")
    assert caught.value.evidence["known"] == ["yumi-left", "yumi-right", "yumi"]
