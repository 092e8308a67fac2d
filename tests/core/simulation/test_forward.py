"""Accelerations against pinocchio and MuJoCo, and against our own inverse dynamics, in every regime.

Tolerance: 1e-9 of the joint's largest acceleration. Two correct recursions differ by rounding times the
condition of the mass matrix, which for thirty links in a chain is some 1e4.
"""

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from tests.core.simulation.worlds import mechanism
from tests.tools import (
    Motion,
    mujoco_model,
    pinocchio_model,
    random_bodies,
    random_motion,
    random_robot,
    relative_difference,
    with_mimics,
)
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.errors import OptionError
from veritorque.core.robot.model import Coupling, RobotModel
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.mechanism import mechanism_of
from veritorque.core.simulation.stage import accelerations

TOLERANCE = 1e-9
SAMPLES = 5


def _state(motion: Motion) -> MotionState:
    return MotionState(motion.position, motion.velocity, np.zeros_like(motion.position))


def _aba(robot, bodies, motion, torque, armature):
    model = pinocchio_model(robot, bodies)
    model.armature = np.full(model.nv, armature)
    data = model.createData()
    rows = zip(motion.position, motion.velocity, torque, strict=True)
    return np.array([pin.aba(model, data, *row).copy() for row in rows])


def _mujoco(robot, bodies, motion, torque, armature):
    model = mujoco_model(robot, bodies)
    data = mujoco.MjData(model)
    places = [int(model.joint(link.name).dofadr[0]) for link in robot.links]
    model.dof_armature[:] = armature
    found = np.empty_like(torque)
    for row, values in enumerate(zip(motion.position, motion.velocity, torque, strict=True)):
        data.qpos[places], data.qvel[places], data.qfrc_applied[places] = values
        mujoco.mj_forward(model, data)
        found[row] = data.qacc_smooth[places]
    return found


@pytest.mark.parametrize("engine", [_aba, _mujoco], ids=["pinocchio", "mujoco"])
@pytest.mark.parametrize("tree", [False, True], ids=["chain", "tree"])
@pytest.mark.parametrize("links", [1, 2, 7, 30])
@pytest.mark.parametrize("prismatic", [0.0, 0.4, 1.0], ids=["revolute", "mixed", "prismatic"])
def test_accelerations_are_those_of_other_engines_with_rotors_as_armature(engine, tree, links, prismatic):
    rng = np.random.default_rng([links, tree, int(10 * prismatic)])
    robot = random_robot(rng, links, tree=tree, prismatic=prismatic)
    bodies, motion = random_bodies(rng, links), random_motion(rng, links, SAMPLES)
    torque = rng.normal(scale=5.0, size=(SAMPLES, links))
    found = accelerations(mechanism(robot, bodies, IA=0.03), _state(motion), torque)
    assert relative_difference(found, engine(robot, bodies, motion, torque, 0.03)) < TOLERANCE


def test_a_prismatic_joint_without_rotor_is_pinocchios_too():
    rng = np.random.default_rng(3)
    robot, bodies = random_robot(rng, 6, prismatic=0.5), random_bodies(rng, 6)
    motion, torque = random_motion(rng, 6, SAMPLES), rng.normal(size=(SAMPLES, 6))
    found = accelerations(mechanism(robot, bodies), _state(motion), torque)
    assert relative_difference(found, _aba(robot, bodies, motion, torque, 0.0)) < TOLERANCE


def _coupled(robot: RobotModel) -> RobotModel:
    wrist = Coupling("wrist", 1, (2, 3), (1.0, -2.0))
    return RobotModel(robot.name, robot.links, robot.joints, robot.gravity, couplings=(wrist,))


@pytest.mark.parametrize("mimics", [False, True], ids=["own joints", "mimics"])
@pytest.mark.parametrize("links", [6, 20])
def test_the_acceleration_of_the_torque_of_a_motion_is_that_of_the_motion(links, mimics):
    rng = np.random.default_rng([links, mimics])
    robot = random_robot(rng, links, tree=True)
    robot = _coupled(with_mimics(robot, rng) if mimics else robot)
    model = standard_model(robot)
    values = rng.uniform(0.1, 1.0, len(model.parameters))
    values[: 10 * links] = random_bodies(rng, links).ravel()
    motion = random_motion(rng, len(robot.joints), 70)
    state = MotionState(motion.position, motion.velocity, motion.acceleration)
    found = accelerations(mechanism_of(model, values), state, model.torque(values, state))
    assert relative_difference(found, motion.acceleration) < TOLERANCE


def test_the_compiled_torque_is_the_models():
    rng = np.random.default_rng(8)
    robot = _coupled(with_mimics(random_robot(rng, 9, tree=True), rng))
    model = standard_model(robot)
    values = np.abs(rng.normal(size=len(model.parameters)))
    motion = random_motion(rng, len(robot.joints), 130)
    state = MotionState(motion.position, motion.velocity, motion.acceleration)
    found = mechanism_of(model, values).torque(state)
    assert relative_difference(found, model.torque(values, state)) < 1e-11


def test_the_order_in_which_terms_are_added_does_not_matter():
    rng = np.random.default_rng(9)
    robot = random_robot(rng, 4)
    forth = standard_model(robot)
    back = DynamicModel(robot, tuple(reversed(forth.terms)))
    place = {parameter.name: position for position, parameter in enumerate(forth.parameters)}
    values = rng.uniform(0.1, 1.0, len(forth.parameters))
    values[:40] = random_bodies(rng, 4).ravel()
    turned = values[[place[parameter.name] for parameter in back.parameters]]
    state, torque = _state(random_motion(rng, 4)), rng.normal(size=(5, 4))
    one = accelerations(mechanism_of(forth, values), state, torque)
    other = accelerations(mechanism_of(back, turned), state, torque)
    assert relative_difference(one, other) < 1e-12


def test_the_mass_matrix_is_pinocchios_with_the_rotors_on_its_diagonal():
    rng = np.random.default_rng(10)
    # a chain: pinocchio's crba wants a tree numbered depth first, and leaves entries out otherwise
    robot, bodies = random_robot(rng, 7), random_bodies(rng, 7)
    motion = random_motion(rng, 7, 3)
    model = pinocchio_model(robot, bodies)
    for found, position in zip(
        mechanism(robot, bodies, IA=0.2).mass_matrices(motion.position), motion.position, strict=True
    ):
        upper = np.triu(pin.crba(model, model.createData(), position))
        expected = upper + np.triu(upper, 1).T + 0.2 * np.eye(7)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


def test_a_negative_coulomb_friction_is_refused():
    rng = np.random.default_rng(11)
    with pytest.raises(OptionError, match="negative Coulomb friction"):
        mechanism(random_robot(rng, 2), random_bodies(rng, 2), FC=-0.1)


def test_a_coulomb_friction_that_a_solver_leaves_below_zero_is_none():
    rng = np.random.default_rng(11)
    robot, bodies = random_robot(rng, 2), random_bodies(rng, 2)
    assert mechanism(robot, bodies, FC=-1e-10).levels.size == mechanism(robot, bodies, FC=0.0).levels.size


def test_parameters_of_another_model_are_refused():
    model = standard_model(random_robot(np.random.default_rng(12), 2))
    with pytest.raises(OptionError, match="do not belong"):
        mechanism_of(model, np.zeros(3))
