"""Files loaded into MuJoCo and pinocchio need the torque that our model predicts.

Tolerance: 1e-9 N m (N) of torques up to some hundreds. A file holds every digit of a number, so that what is
left is the rounding of another order of summation, about 1e-12.
"""

import numpy as np
import pytest

from tests.core.export import engines
from tests.core.export.robots import ROBOTS, brisk, identified
from veritorque.core.dynamics.model import standard_model
from veritorque.core.export.mjcf import write_mjcf
from veritorque.core.export.sdf import write_sdf
from veritorque.core.export.urdf import write_urdf

TOLERANCE = 1e-9


@pytest.fixture(params=ROBOTS, scope="module")
def found(request):
    return identified(ROBOTS[request.param])


@pytest.fixture
def names(found):
    return [joint.name for joint in found.robot.joints]


def of_terms(found, state, *terms):
    """Give our torque of some of the terms."""
    model = standard_model(found.robot, terms)
    return model.torque(np.array([found.values[one.name] for one in model.parameters]), state)


def levelled(model, robot):
    """Let an engine's world have the robot's gravity where the file counts on 9.81 m/s2."""
    model.gravity.linear = np.array([0.0, 0.0, -float(np.linalg.norm(robot.gravity))])
    return model


def test_pinocchio_reads_the_bodies_of_the_urdf(found, names):
    state, text = brisk(found.robot), write_urdf(found)
    model = levelled(engines.pinocchio_of_urdf(text), found.robot)
    theirs = engines.pinocchio_torque(model, names, state, engines.mimics_of_urdf(text))
    np.testing.assert_allclose(theirs, of_terms(found, state, "rigid_body"), rtol=0, atol=TOLERANCE)


def test_pinocchio_reads_the_friction_of_the_urdf(found, names):
    model = engines.pinocchio_of_urdf(write_urdf(found))
    places = [model.joints[model.getJointId(name)].idx_v for name in names]
    np.testing.assert_array_equal(model.damping[places], found.of_joints("FV"))
    np.testing.assert_array_equal(model.upperDryFrictionLimit[places], found.of_joints("FC"))


def test_mujoco_reads_bodies_and_friction_of_the_urdf(found, names):
    state, text = brisk(found.robot), write_urdf(found)
    model = engines.mujoco_model(text)
    model.opt.gravity[:] = [0.0, 0.0, -float(np.linalg.norm(found.robot.gravity))]
    theirs = engines.mujoco_torque(model, names, state, engines.mimics_of_urdf(text))
    ours = of_terms(found, state, "rigid_body", "viscous", "coulomb")
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=TOLERANCE)


def test_mujoco_reads_everything_of_the_mjcf_but_offsets_which_are_its_actuators(found, names):
    state, text = brisk(found.robot), write_mjcf(found)
    theirs = engines.mujoco_torque(engines.mujoco_model(text), names, state, engines.mimics_of_mjcf(text))
    ours = found.model.torque(found.standard, state) - found.of_joints("OFF")
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=TOLERANCE)


# MuJoCo makes a mimic by a soft spring, whose acceleration is not the joint's at once.
@pytest.mark.parametrize("name", [name for name, one in ROBOTS.items() if len(one.links) == len(one.joints)])
def test_driven_by_the_torque_that_a_log_holds_the_mjcf_moves_as_the_log(name):
    found = identified(ROBOTS[name])
    names, state = [joint.name for joint in found.robot.joints], brisk(found.robot)
    model = engines.mujoco_model(write_mjcf(found))
    theirs = engines.mujoco_acceleration(model, names, state, found.model.torque(found.standard, state))
    np.testing.assert_allclose(theirs, state.acceleration, rtol=0, atol=TOLERANCE)


def test_pinocchio_reads_bodies_and_armature_of_the_mjcf(found, names, tmp_path):
    state, text = brisk(found.robot), write_mjcf(found)
    model = engines.pinocchio_of_mjcf(text, tmp_path)
    theirs = engines.pinocchio_torque(model, names, state, engines.mimics_of_mjcf(text))
    ours = of_terms(found, state, "rigid_body", "rotor_inertia")
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=TOLERANCE)


def test_what_sdformat_says_of_the_bodies_needs_our_torque(found, names):
    state, text = brisk(found.robot), write_sdf(found)
    model = levelled(engines.pinocchio_of_sdf(text), found.robot)
    theirs = engines.pinocchio_torque(model, names, state, engines.mimics_of_sdf(text))
    np.testing.assert_allclose(theirs, of_terms(found, state, "rigid_body"), rtol=0, atol=TOLERANCE)
