"""Set-valued friction: what stands stays, what slides loses what it must, against analysis and MuJoCo."""

import mujoco
import numpy as np
import pytest

from tests.core.simulation.worlds import block, mechanism, pendulum, play, slope
from tests.tools import mujoco_model, random_bodies, random_robot
from veritorque.core.robot.model import Coupling, RobotModel
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.drive import Drive, Feedback
from veritorque.core.simulation.rollout import rollout
from veritorque.core.simulation.stage import States, accelerations


def test_a_body_on_a_slope_below_its_coulomb_level_does_not_move_at_all():
    moved = play(slope(FC=2.0001), 0.3, 0.0, 1.0, 200)
    assert np.array_equal(moved.position, np.full_like(moved.position, 0.3))
    assert np.array_equal(moved.velocity, np.zeros_like(moved.velocity))


def test_a_body_on_a_slope_above_its_coulomb_level_slides_with_what_is_left():
    moved = play(slope(FC=1.5), 0.0, 0.0, 1.0, 200)
    np.testing.assert_allclose(moved.velocity[-1, 0, 0], (2.0 - 1.5) / 2.0, rtol=1e-12)


def test_a_sliding_body_stops_where_its_energy_is_spent_and_stays():
    moved = play(block(FC=1.0), 0.0, 0.37, 2.0, 60)
    np.testing.assert_allclose(moved.position[-1, 0, 0], 0.5 * 2.0 * 0.37**2 / 1.0, rtol=1e-9)
    assert moved.velocity[-1, 0, 0] == 0.0


def test_a_body_lets_go_when_the_torque_passes_its_level():
    moved = play(block(FC=1.0), 0.0, 0.0, 1.0, 1000, lambda time: np.array([2.0 * time]))
    speed = moved.velocity[:, 0, 0]
    assert np.all(speed[:501] == 0.0)
    np.testing.assert_allclose(speed[-1], 0.5 * 0.5**2, rtol=3e-3)


def test_a_pendulum_loses_four_times_its_friction_over_its_stiffness_each_cycle():
    # Small swings: the amplitude falls by 2 FC / (m g l) per half swing (Den Hartog 1956, ch. 8).
    friction, first = 2e-4, 2e-3
    moved = play(pendulum(FC=friction), first, 0.0, 20.0, 20_000)
    position = moved.position[:, 0, 0]
    turns = np.flatnonzero(np.diff(np.sign(np.diff(position))) != 0)
    expected = first - 2.0 * friction / 9.81 * np.arange(1, len(turns) + 1)
    np.testing.assert_allclose(np.abs(position[turns + 1]), expected, atol=2e-8)


def test_stick_slip_on_a_belt_has_the_period_of_its_analysis():
    # A spring (k) to a belt at speed u drags a body with level FC and no drop of friction: after sticking for
    # FC / (k u) it slides and comes to move with the belt, oscillating about it at sqrt(k / m).
    stiffness, speed, friction = 50.0, 0.1, 1.0
    body = block(FC=friction)
    times = np.linspace(0.0, 1.0, 2001)
    start = States.starting(body, MotionState(*(np.zeros((1, 1)) for _ in range(3))))
    none = np.zeros((2001, 1, 1))
    pull = Feedback(np.array([stiffness]), np.zeros(1), speed * times[:, None, None], none)
    moved = rollout(body, start, Drive(5e-4, none, pull), longest_step=1.0)
    stuck = friction / (stiffness * speed)
    rate, later = np.sqrt(stiffness / 2.0), np.maximum(times - stuck, 0.0)
    expected = speed * (later - np.sin(rate * later) / rate)
    assert np.all(moved.position[times < stuck - 1e-3, 0, 0] == 0.0)
    np.testing.assert_allclose(moved.position[:, 0, 0], expected, atol=2e-6)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_joints_at_rest_are_held_or_let_go_as_mujocos_friction_loss_decides(seed):
    rng = np.random.default_rng([31, seed])
    robot, bodies = random_robot(rng, 5, prismatic=0.0), random_bodies(rng, 5)
    arm = mechanism(robot, bodies, IA=0.05, FC=3.0)
    model = mujoco_model(robot, bodies)
    model.dof_armature[:], model.dof_frictionloss[:] = 0.05, 3.0
    # friction as hard as the engine allows: its own regularisation sets the tolerance
    model.dof_solimp[:] = [0.9999, 0.9999, 0.001, 0.5, 2.0]
    model.opt.tolerance, model.opt.iterations, model.opt.solver = 1e-14, 500, mujoco.mjtSolver.mjSOL_NEWTON
    data = mujoco.MjData(model)
    position, torque = rng.uniform(-2, 2, (20, 5)), rng.normal(scale=12.0, size=(20, 5))
    still = np.zeros_like(position)
    found = accelerations(arm, MotionState(position, still, still), torque)
    assert 10 < np.count_nonzero(found == 0.0) < 90
    for row in range(20):
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = position[row], 0.0, torque[row]
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(found[row], data.qacc, atol=2e-3 * np.abs(data.qacc_smooth).max())


def test_what_holds_the_joints_never_exceeds_its_level_and_never_drives():
    rng = np.random.default_rng(33)
    robot, bodies = random_robot(rng, 6), random_bodies(rng, 6)
    arm, free = mechanism(robot, bodies, FC=2.0), mechanism(robot, bodies)
    position, torque = rng.uniform(-2, 2, (40, 6)), rng.normal(scale=10.0, size=(40, 6))
    still = np.zeros_like(position)
    found = accelerations(arm, MotionState(position, still, still), torque)
    friction = torque - free.torque(MotionState(position, still, found))
    assert np.abs(friction).max() <= 2.0 + 1e-8
    assert np.all((found == 0.0) | (np.abs(friction - 2.0 * np.sign(found)) < 1e-7))


def test_a_coupled_motor_holds_the_sum_of_its_joints_and_lets_their_difference_move():
    rng = np.random.default_rng(34)
    plain, bodies = random_robot(rng, 2, gravity=False, prismatic=0.0), random_bodies(rng, 2)
    wrist = Coupling("wrist", 2, (1, 2), (1.0, 1.0))
    robot = RobotModel(plain.name, plain.links, plain.joints, plain.gravity, (wrist,))
    arm = mechanism(robot, bodies, FCM=50.0)
    still = np.zeros((1, 2))
    found = accelerations(arm, MotionState(still, still, still), np.array([[3.0, -1.0]]))
    assert abs(found.sum()) < 1e-10 * np.abs(found).max()
    assert np.abs(found).max() > 0.1
