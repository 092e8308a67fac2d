"""The compiled columns against the plain terms and against pinocchio's own regressor, in every regime.

Tolerance: two correct recursions of 30 joints differ by rounding, about 1e-13 of the joint's largest torque;
1e-10 leaves room for cancellation and none for a wrong formula.
"""

import numpy as np
import pinocchio as pin
import pytest

from tests.tools import (
    pinocchio_model,
    pinocchio_torque,
    random_bodies,
    random_motion,
    random_robot,
    relative_difference,
    with_mimics,
)
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.regressor.columns import ColumnPlan, all_columns, dense
from veritorque.core.regressor.kernel import BLOCK
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.model import Coupling, RobotModel
from veritorque.core.signals.state import MotionState

TOLERANCE = 1e-10
PINOCCHIO_OF_KHALIL = [9, 6, 7, 8, 0, 1, 3, 2, 4, 5]
"""Place in Khalil's order of pinocchio's m, mx, my, mz, Ixx, Ixy, Iyy, Ixz, Iyz, Izz."""


def _state(rng: np.random.Generator, joints: int, samples: int, *, speed: float = 1.0) -> MotionState:
    motion = random_motion(rng, joints, samples, speed=speed)
    return MotionState(motion.position, motion.velocity, motion.acceleration)


def _torque(model: DynamicModel, parameters: np.ndarray, state: MotionState) -> np.ndarray:
    return (dense(all_columns(model), state) @ parameters).reshape(state.position.shape)


def _coupled(robot: RobotModel) -> RobotModel:
    wrist = Coupling("wrist", 1, (2, 3), (1.0, -2.0))
    return RobotModel(robot.name, robot.links, robot.joints, robot.gravity, couplings=(wrist,))


@pytest.mark.parametrize("tree", [False, True], ids=["chain", "tree"])
@pytest.mark.parametrize("links", [1, 2, 7, 14, 30])
@pytest.mark.parametrize("prismatic", [0.0, 0.4, 1.0], ids=["revolute", "mixed", "prismatic"])
def test_compiled_columns_times_bodies_give_pinocchios_torque(links, tree, prismatic):
    rng = np.random.default_rng([links, tree, int(10 * prismatic)])
    robot = random_robot(rng, links, tree=tree, prismatic=prismatic)
    bodies, motion = random_bodies(rng, links), random_motion(rng, links)
    model = standard_model(robot, ("rigid_body",))
    found = _torque(model, bodies.ravel(), MotionState(motion.position, motion.velocity, motion.acceleration))
    assert relative_difference(found, pinocchio_torque(robot, bodies, motion)) < TOLERANCE


@pytest.mark.parametrize("tree", [False, True], ids=["chain", "tree"])
@pytest.mark.parametrize("links", [1, 3, 7])
def test_compiled_columns_are_pinocchios_regressor_column_by_column(links, tree):
    rng = np.random.default_rng([links, tree])
    robot = random_robot(rng, links, tree=tree)
    state = _state(rng, links, 4)
    ours = dense(all_columns(standard_model(robot, ("rigid_body",))), state).reshape(4, links, links, 10)
    theirs = pinocchio_model(robot, random_bodies(rng, links))
    data = theirs.createData()
    for sample in range(4):
        columns = pin.computeJointTorqueRegressor(
            theirs, data, state.position[sample], state.velocity[sample], state.acceleration[sample]
        ).reshape(links, links, 10)
        assert (
            np.max(np.abs(ours[sample][..., PINOCCHIO_OF_KHALIL] - columns)) < 1e-10 * np.abs(columns).max()
        )


@pytest.mark.parametrize("prismatic", [0.0, 0.5], ids=["revolute", "mixed"])
@pytest.mark.parametrize("links", [3, 9])
def test_compiled_columns_are_the_terms_own_series_with_friction_couplings_and_mimics(links, prismatic):
    rng = np.random.default_rng([links, int(10 * prismatic)])
    robot = random_robot(rng, links, tree=True, prismatic=prismatic)
    model = standard_model(_coupled(with_mimics(robot, rng) if links > 3 else robot))
    parameters = rng.normal(size=len(model.parameters))
    state = _state(rng, len(model.robot.joints), 40)
    assert relative_difference(_torque(model, parameters, state), model.torque(parameters, state)) < TOLERANCE


def test_links_that_mimic_joints_get_pinocchios_torque():
    rng = np.random.default_rng(5)
    robot = with_mimics(random_robot(rng, 12, tree=True), rng)
    bodies, motion = random_bodies(rng, 12), random_motion(rng, len(robot.joints))
    model = standard_model(robot, ("rigid_body",))
    found = _torque(model, bodies.ravel(), MotionState(motion.position, motion.velocity, motion.acceleration))
    assert relative_difference(found, pinocchio_torque(robot, bodies, motion)) < TOLERANCE


@pytest.mark.parametrize("speed", [0.0, 1e-6, 30.0], ids=["at rest", "creeping", "spinning"])
def test_compiled_columns_hold_at_every_speed(speed):
    rng = np.random.default_rng(6)
    robot, bodies = random_robot(rng, 7), random_bodies(rng, 7)
    motion = random_motion(rng, 7, speed=speed)
    model = standard_model(robot, ("rigid_body",))
    found = _torque(model, bodies.ravel(), MotionState(motion.position, motion.velocity, motion.acceleration))
    assert relative_difference(found, pinocchio_torque(robot, bodies, motion)) < TOLERANCE


@pytest.mark.parametrize("samples", [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK + 5])
def test_a_samples_columns_do_not_depend_on_its_neighbours(samples):
    rng = np.random.default_rng(7)
    model = standard_model(builtin_robot("yumi-left"))
    state = _state(rng, 7, 4 * BLOCK)
    whole = all_columns(model).series(state)
    part = MotionState(state.position[:samples], state.velocity[:samples], state.acceleration[:samples])
    assert np.array_equal(all_columns(model).series(part), whole[:, :samples])


def test_a_plan_for_some_columns_gives_these_columns_in_the_order_asked_for():
    rng = np.random.default_rng(8)
    model = standard_model(_coupled(random_robot(rng, 5, tree=True)))
    state = _state(rng, 5, 33)
    chosen = tuple(int(one) for one in rng.permutation(len(model.parameters))[:23])
    assert np.array_equal(
        dense(ColumnPlan(model, chosen), state), dense(all_columns(model), state)[:, list(chosen)]
    )


def test_nothing_that_is_structurally_zero_is_computed():
    model = standard_model(builtin_robot("yumi-left"), ("rigid_body",))
    assert len(all_columns(model).entries) == 10 * (7 * 8) // 2


def test_a_joint_without_columns_has_no_rows():
    model = standard_model(builtin_robot("yumi-left"))
    place = next(index for index, one in enumerate(model.parameters) if one.name == "FV3")
    plan = ColumnPlan(model, (place,))
    assert [len(rows) for rows in plan.rows_of] == [0, 0, 1, 0, 0, 0, 0]


def test_columns_of_a_series_that_is_not_contiguous_are_the_same():
    rng = np.random.default_rng(9)
    model = standard_model(random_robot(rng, 4))
    state = _state(rng, 4, 64)
    strided = MotionState(state.position[::2], state.velocity[::2], state.acceleration[::2])
    assert np.array_equal(all_columns(model).series(strided), all_columns(model).series(state)[:, ::2])
