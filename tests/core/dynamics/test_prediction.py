"""What a frozen model predicts, and that asking twice costs once."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from tests.core.dynamics.terms.chains import motion_of
from tests.tools import random_robot
from veritorque.core.arrays import JointSeries, LinkTable, Samples
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.newton_euler import inverse_dynamics
from veritorque.core.dynamics.prediction import Prediction, shift_joint
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.state import MotionState


def believed_with_friction(seed: int, joints: int = 4) -> Prediction:
    """Believe in numbers for every parameter of a standard model."""
    rng = np.random.default_rng(seed)
    model = standard_model(random_robot(rng, joints))
    return Prediction(model, rng.normal(size=len(model.parameters)))


def change_of(described: Prediction, state: MotionState, joint: int, shift: Sequence[Samples]) -> JointSeries:
    """Give the change of the load by a shift of one joint, once it was added to another change."""
    other = np.ones(state.position.shape[::-1])
    described.add_change(state, joint, tuple(shift), other)
    return other.T - 1.0


def test_a_prediction_is_the_torque_of_its_model():
    described, state = believed_with_friction(1), motion_of(1)
    expected = described.model.torque(described.standard, state)
    np.testing.assert_allclose(described.torque(state), expected, rtol=1e-12, atol=1e-12)


def test_load_friction_and_rotors_add_up_to_the_torque():
    described, state = believed_with_friction(2), motion_of(2)
    rotors = np.array([one.symbol == "IA" for one in described.model.parameters])
    alone = described.model.torque(np.where(rotors, described.standard, 0.0), state)
    whole = described.load(state) + described.friction(state) + alone
    np.testing.assert_allclose(described.torque(state), whole, rtol=1e-12, atol=1e-12)


def test_a_state_that_was_asked_for_is_not_computed_again():
    asked = []

    def counted(robot: RobotModel, links: LinkTable, state: MotionState) -> JointSeries:
        asked.append(state)
        return inverse_dynamics(robot, links, state)

    described, state = replace(believed_with_friction(3), newton_euler=counted), motion_of(3)
    for _ in range(2):
        described.torque(state)
        described.load(state)
    assert len(asked) == 1
    for _ in range(2):
        change_of(described, state, 0, [np.full(len(state.position), size) for size in (0.1, 0.2, 0.3)])
        described.slopes(state, 0)
    assert len(asked) == 7


@pytest.mark.parametrize(("joint", "joints"), [(0, 4), (1, 4), (2, 4), (3, 4), (0, 1)])
def test_a_small_shift_of_a_joint_changes_the_load_by_its_slopes(joint, joints):
    described, state = believed_with_friction(6, joints), motion_of(6, joints=joints)
    rng = np.random.default_rng(7)
    shift = [rng.normal(size=len(state.position)) for _ in range(3)]
    size = 1e-6
    small = MotionState(*(size * part[:, None] for part in shift))
    found = (described.load(shift_joint(state, joint, small)) - described.load(state)) / size
    change = change_of(described, state, joint, shift)
    # What is left is of second order: a millionth, times how much slopes change over one radian.
    np.testing.assert_allclose(found, change, atol=1e-4 * np.abs(change).max())


def test_the_slope_by_acceleration_is_the_mass_matrix():
    described, state = believed_with_friction(8), motion_of(8)
    matrix = np.stack([described.slopes(state, joint)[2] for joint in range(4)], axis=2)
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, 1, 2), atol=1e-9 * np.abs(matrix).max())


def test_what_is_kept_cannot_be_changed_by_who_asked():
    described, state = believed_with_friction(4), motion_of(4)
    for series in (described.torque(state), described.load(state), *described.slopes(state, 1)):
        with pytest.raises(ValueError, match="read-only"):
            series[0] = 1.0


def test_another_robot_with_the_same_bodies_is_computed_for_itself():
    described, state = believed_with_friction(5), motion_of(5)
    weightless = replace(described.model.robot, gravity=np.zeros(3))
    bodies = described.standard[: 10 * len(weightless.links)].reshape(-1, 10)
    expected = inverse_dynamics(weightless, bodies, state)
    np.testing.assert_array_equal(described.load(state, weightless), expected)
    assert np.abs(described.load(state) - expected).max() > 1e-3
