"""A torque from which a controller's model took gravity is named with the share of gravity that is left."""

import numpy as np
import pytest

from tests.core.conflicts.skew_arm import PLAIN, four_joints
from tests.core.estimate.worlds import FRICTION, swing, true_parameters
from tests.measured import measured_log, measured_robot
from veritorque.core.conflicts.registry import CONFLICTS
from veritorque.core.diagnosis.causes.registry import BY_ID
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, diagnose, identify, identify_in_full


def compensated(share: float, noise: float = 0.01) -> tuple[RobotModel, JointLog]:
    """Give an arm whose torque holds a share of gravity, and noise relative to what is left."""
    robot = four_joints()
    model, state = standard_model(robot), swing(4, seed=5)
    truth = true_parameters(model, seed=3)
    torque = model.torque(truth, state) - (1.0 - share) * gravity_at(state.position, model, truth)
    noise_rms = noise * np.sqrt(np.mean(torque**2, axis=0))
    torque += noise_rms * np.random.default_rng(8).normal(size=torque.shape)
    return robot, log_from_arrays("log", np.arange(len(torque)) / 100.0, state.position, torque)


def gravity_of(robot: RobotModel, log: JointLog) -> np.ndarray:
    """Give the gravity that an identification of a log finds, as a controller's model may have it."""
    found = identify_in_full(IdentifyRequest(robot, (log,), PLAIN))
    position = whole_rows(log).position
    return gravity_at(position, found.base.model, found.estimate.standard)


def gravity_at(position: np.ndarray, model: DynamicModel, parameters: np.ndarray) -> np.ndarray:
    """Give the torque of the bodies at rest."""
    rest = np.zeros_like(position)
    of_bodies = parameters * np.array([one.symbol not in FRICTION for one in model.parameters])
    return model.torque(of_bodies, MotionState(position, rest, rest))


@pytest.mark.parametrize(
    ("share", "said"),
    [
        (0.0, "the torque holds no gravity"),
        (0.1, "the torque holds about 10 % of gravity"),
        (0.3, "the torque holds about 30 % of gravity"),
        (-0.1, "about 110 % of gravity was taken from the torque, more than all of it"),
    ],
)
def test_the_share_that_is_left_is_named(share, said):
    robot, log = compensated(share)
    (found,) = identify(IdentifyRequest(robot, (log,), PLAIN))["conflicts"]
    assert (found["conflict"], found["statement"]) == ("gravity_compensated", said)
    pasted = found["correction"]["robot"]["gravity"]
    np.testing.assert_allclose(pasted, share * np.array(robot.gravity), atol=1e-9)
    assert not np.signbit(pasted)[np.equal(pasted, 0.0)].any()


def test_what_lowers_the_error_by_less_than_a_seventh_is_still_a_conflict():
    robot, log = compensated(0.1, noise=0.2)
    (found,) = identify(IdentifyRequest(robot, (log,), PLAIN))["conflicts"]
    assert found["conflict"] == "gravity_compensated"
    assert found["error_after_percent"] > 0.85 * found["error_before_percent"]


def test_on_a_measured_arm_it_is_named_and_no_friction_by_position_is_sure():
    robot, rows = (
        measured_robot("ur10e_open"),
        whole_rows(measured_log("ur10e_open", "fourier_30s_12h", 635, 3510)),
    )
    log = log_from_arrays("whole", rows.time, rows.position, rows.torque)
    gravity = gravity_of(robot, log)
    less = log_from_arrays("less", rows.time, rows.position, rows.torque - 0.9 * gravity)
    found = diagnose(IdentifyRequest(robot, (less,), PLAIN))
    assert [one["conflict"] for one in found["conflicts"]] == ["gravity_compensated"]
    sure = {one["cause"] for one in found["diagnosis"]["findings"] if one["confidence"] > 0.5}
    assert not sure & {"friction_position_dependent", "friction_load_dependent"}


@pytest.mark.parametrize("share", [0.8, 1.0, 1.2])
def test_gravity_that_a_small_error_of_gain_makes_larger_or_smaller_is_there(share):
    robot, log = compensated(share)
    assert identify(IdentifyRequest(robot, (log,), PLAIN))["conflicts"] == []


def test_rotors_whose_inertia_is_not_modelled_do_not_make_gravity_less():
    robot = four_joints()
    model, state = standard_model(robot), swing(4, seed=5)
    heavy = np.array([8.0 if one.symbol == "IA" else 1.0 for one in model.parameters])
    torque = model.torque(heavy * true_parameters(model, seed=3), state)
    noise_rms = 0.01 * np.std(torque, axis=0)
    torque += noise_rms * np.random.default_rng(1).normal(size=torque.shape)
    log = log_from_arrays("log", np.arange(len(torque)) / 100.0, state.position, torque)
    found = identify(IdentifyRequest(four_joints(rotor_inertia=False), (log,), PLAIN))
    assert "gravity_compensated" not in {one["conflict"] for one in found["conflicts"]}


@pytest.mark.parametrize("conflict", CONFLICTS.values(), ids=lambda one: one.name)
def test_what_stays_doubtful_beside_a_conflict_is_a_cause(conflict):
    assert conflict.doubtful_causes <= {*BY_ID}
