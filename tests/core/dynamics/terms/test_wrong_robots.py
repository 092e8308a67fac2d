"""Wrong tables, tilted bases, bodies and pushes that nobody declared: columns against the exact effect."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.dynamics.terms.chains import described_chain, exact, motion_of
from tests.tools import Motion, pinocchio_torque, random_bodies, random_motion
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.newton_euler import inverse_dynamics
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.external_contact import WRENCH, Contact
from veritorque.core.dynamics.terms.gravity_misalignment import Tilt, at_rest
from veritorque.core.dynamics.terms.kinematic_error import ENTRY_UNITS, KinematicError
from veritorque.core.dynamics.terms.payload_change import Payload
from veritorque.core.robot.builtin import builtin_description
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.frames import rotation_x, rotation_y
from veritorque.core.signals.state import MotionState

ERROR = 1e-4
FIRST_ORDER = 2e-3
"""An error of 1e-4 leaves a second-order remainder of about 1e-4 of the column."""


@pytest.mark.parametrize("entry", sorted(ENTRY_UNITS))
@pytest.mark.parametrize("joint", [2, 5])
def test_a_wrong_entry_changes_the_torque_as_the_column_says(entry, joint):
    rng = np.random.default_rng(joint)
    robot = robot_from_description(builtin_description("yumi-left"))
    bodies, motion = random_bodies(rng, 7), random_motion(rng, 7)
    row = robot.links[joint - 1].row
    true = replace(row, **{entry: getattr(row, entry) + ERROR})
    rotation, translation = true.placement()
    links = list(robot.links)
    links[joint - 1] = replace(links[joint - 1], rotation=rotation, translation=translation)
    other = replace(robot, links=tuple(links))
    change = pinocchio_torque(other, bodies, motion) - pinocchio_torque(robot, bodies, motion)
    described = Prediction(standard_model(robot, ("rigid_body",)), bodies.ravel())
    state = MotionState(motion.position, motion.velocity, motion.acceleration)
    (column,) = KinematicError(joint, described, entry).torques(robot, state)
    np.testing.assert_allclose(ERROR * column, change, atol=FIRST_ORDER * np.abs(change).max())


def test_gravity_that_is_turned_changes_the_torque_as_two_columns_say():
    described, bodies = described_chain(3)
    state = motion_of(3)
    robot = replace(described.model.robot, gravity=np.array([0.0, 1.0, -9.7]))
    turned = replace(robot, gravity=rotation_y(-2.0 * ERROR) @ rotation_x(ERROR) @ robot.gravity)
    change = exact(turned, bodies, state) - exact(robot, bodies, state)
    about_x, about_y = Tilt(0, described).torques(robot, state)
    np.testing.assert_allclose(
        ERROR * (about_x - 2.0 * about_y), change, atol=FIRST_ORDER * np.abs(change).max()
    )


def test_a_planar_arm_does_not_feel_a_tilt_about_the_axis_across_gravity_that_lies_in_its_plane():
    described, _ = described_chain(3)
    links = tuple(replace(link, rotation=np.eye(3)) for link in described.model.robot.links)
    robot = replace(described.model.robot, links=links, gravity=np.array([0.0, -9.81, 0.0]))
    across, within = Tilt(0, Prediction(standard_model(robot, ("rigid_body",)), described.standard)).torques(
        robot, motion_of(3)
    )
    assert not across.any()
    assert within.any()


def test_a_body_that_is_taken_up_adds_its_own_torque_from_then_on():
    described, bodies = described_chain(4)
    robot = described.model.robot
    state = replace(motion_of(4), time=np.arange(6.0))
    load = random_bodies(np.random.default_rng(9), 1)[0]
    heavier = bodies.copy()
    heavier[-1] += load
    change = exact(robot, heavier, state) - exact(robot, bodies, state)
    columns = np.array(Payload(4, 4, 3.0).torques(robot, state))
    found = np.tensordot(load, columns, axes=1)
    assert not found[:3].any()
    np.testing.assert_allclose(found[3:], change[3:], atol=1e-9)


def test_a_push_upwards_is_what_holds_a_weight():
    described, _ = described_chain(5)
    robot = described.model.robot
    state = replace(motion_of(5), time=np.full(6, 1.0))
    weight = np.zeros((4, 10))
    weight[-1, 9] = 2.0
    held = inverse_dynamics(robot, weight, at_rest(state))
    columns = Contact(4, 4, ((0.0, 2.0),)).torques(robot, state)
    force = np.array([*(2.0 * np.asarray(robot.gravity)), 0.0, 0.0, 0.0])
    found = sum(size * column for size, column in zip(force, columns, strict=True))
    np.testing.assert_allclose(found, held, atol=1e-9)


def test_every_contact_has_a_wrench_of_its_own_inside_its_span_only():
    described, _ = described_chain(5)
    robot = described.model.robot
    state = replace(motion_of(5), time=np.arange(6.0))
    term = Contact(4, 4, ((0.5, 1.5), (3.5, 5.5)))
    columns = np.array(term.torques(robot, state)).reshape(2, len(WRENCH), 6, 4)
    active = np.abs(columns).max(axis=(1, 3)) > 0.0
    np.testing.assert_array_equal(active, [[False, True, *[False] * 4], [*[False] * 4, True, True]])
    assert len({one.name for one in term.parameters(robot)}) == 2 * len(WRENCH)


def test_motion_changes_nothing_about_a_push():
    described, _ = described_chain(5)
    robot = described.model.robot
    state = replace(motion_of(5), time=np.full(6, 1.0))
    term = Contact(4, 4, ((0.0, 2.0),))
    for moving, resting in zip(term.torques(robot, state), term.torques(robot, at_rest(state)), strict=True):
        np.testing.assert_array_equal(moving, resting)


def test_pinocchio_and_the_plain_recursion_agree_on_the_chain_used_here():
    described, bodies = described_chain(6)
    state = motion_of(6)
    ours = described.load(state)
    theirs = pinocchio_torque(
        described.model.robot, bodies, Motion(state.position, state.velocity, state.acceleration)
    )
    np.testing.assert_allclose(ours, theirs, atol=1e-9)
