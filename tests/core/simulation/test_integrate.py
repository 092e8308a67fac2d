"""The integrator against laws of mechanics: its order, energy, power, stiff damping and divergence."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.core.simulation.worlds import block, mechanism, pendulum, play
from tests.tools import random_bodies, random_robot
from veritorque.core.dynamics.newton_euler import inverse_dynamics
from veritorque.core.dynamics.terms.friction_viscous_nonlinear import NonlinearViscous
from veritorque.core.errors import SolverError
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.mechanism import mechanism_of


def _arm(**drives):
    rng = np.random.default_rng(21)
    robot = random_robot(rng, 4, prismatic=0.25)
    return mechanism(robot, random_bodies(rng, 4), IA=0.1, **drives)


def _ends(arm, steps):
    moved = play(
        arm,
        np.full(4, 0.3),
        np.array([0.5, -0.4, 0.3, 0.6]),
        0.3,
        steps,
        lambda time: 3 * np.cos(9 * time + np.arange(4)),
    )
    return np.concatenate([moved.position[-1, :, 0], moved.velocity[-1, :, 0]])


@pytest.mark.parametrize("drives", [{}, {"FV": 0.5}, {"FV": 0.5, "OFF": 1.0}], ids=str)
def test_halving_the_step_divides_the_error_by_four(drives):
    arm = _arm(**drives)
    finest = _ends(arm, 4800)
    errors = [np.abs(_ends(arm, steps) - finest).max() for steps in (75, 150, 300)]
    assert all(3.6 < one / other < 4.4 for one, other in pairwise(errors))


def test_the_order_survives_reversals_of_coulomb_friction():
    def end(steps):
        moved = play(
            block(FC=0.5, FV=0.2), 0.0, 0.1, 1.0, steps, lambda time: np.array([2.0 * np.cos(7 * time)])
        )
        return moved.position[-1, 0, 0]

    finest = end(12_800)
    errors = np.abs([end(steps) - finest for steps in (100, 200, 400, 800)])
    assert np.log2(errors[0] / errors[-1]) / 3.0 > 1.6
    assert errors[0] < 3e-5


def _energy(arm, position, velocity):
    kinetic = 0.5 * np.einsum("si,sij,sj->s", velocity, arm.mass_matrices(position), velocity)
    return kinetic + 9.81 * (1.0 - np.cos(position[:, 0]))


def test_without_friction_energy_is_kept_to_the_order_of_the_scheme():
    drift = []
    for steps in (200, 400):
        moved = play(pendulum(), 1.0, 0.0, 1.0, steps)
        energy = _energy(pendulum(), moved.position[:, :, 0], moved.velocity[:, :, 0])
        drift.append(np.abs(energy - energy[0]).max())
    assert drift[1] < 1e-3
    assert drift[0] / drift[1] > 3.6


def test_friction_and_drives_balance_the_energy():
    arm = pendulum(FV=0.3, FC=0.4)
    moved = play(arm, 1.0, 0.5, 1.0, 4000, lambda time: np.array([np.sin(5.0 * time)]))
    position, velocity = moved.position[:, :, 0], moved.velocity[:, :, 0]
    speed = velocity[:, 0]
    power = moved.torque[:, 0, 0] * speed - 0.3 * speed**2 - 0.4 * np.abs(speed)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]))]) / 4000
    energy = _energy(arm, position, velocity)
    assert np.ptp(energy) > 1.0
    np.testing.assert_allclose(energy - energy[0], work, atol=2e-5)


def test_damping_ten_thousand_times_too_stiff_for_the_step_stops_the_joint_at_once():
    moved = play(block(FV=2e7), 0.0, 1.0, 0.1, 100)
    assert np.abs(moved.velocity[1:]).max() < 1e-3
    assert np.abs(moved.position).max() < 2e-3


def test_stiff_damping_creeps_at_the_speed_that_balances_the_torque():
    moved = play(block(FV=2e5), 0.0, 0.0, 0.1, 100, lambda time: np.array([10.0]))
    np.testing.assert_allclose(moved.velocity[-1], 10.0 / 2e5, rtol=1e-6)


def test_the_simulated_motion_needs_the_torque_that_drove_it():
    arm = _arm()
    moved = play(arm, np.full(4, 0.3), np.zeros(4), 0.2, 2000, lambda time: np.full(4, 2.0))
    acceleration = np.gradient(moved.velocity[:, :, 0], 1e-4, axis=0)
    state = MotionState(moved.position[:, :, 0], moved.velocity[:, :, 0], acceleration)
    needed = inverse_dynamics(arm.robot, arm.bodies[8], state) + 0.1 * acceleration
    np.testing.assert_allclose(needed[2:-2], 2.0, atol=1e-4)


def test_states_side_by_side_move_as_they_do_alone():
    arm = _arm(FV=0.1, FC=0.4)
    rng = np.random.default_rng(5)
    position, velocity = rng.normal(size=(70, 4)), 0.2 * rng.normal(size=(70, 4))
    together = play(arm, position, velocity, 0.1, 50)
    for lane in (0, 13, 69):
        alone = play(arm, position[lane], velocity[lane], 0.1, 50)
        np.testing.assert_allclose(together.position[:, :, lane], alone.position[:, :, 0], atol=1e-12)


def test_a_motion_that_diverges_is_reported_with_its_time_and_joint():
    with pytest.raises(SolverError, match="diverges") as refusal:
        play(block(), 0.0, 0.0, 1.0, 100, lambda time: np.array([1e6]))
    assert refusal.value.evidence["joint"] == 1
    assert 0.01 < refusal.value.evidence["time"] < 0.05


def test_friction_that_drives_with_a_power_of_speed_is_reported_as_a_motion_that_diverges():
    """Within a step the power is beyond all numbers."""
    plain = block().model
    model = replace(plain, terms=(*plain.terms, NonlinearViscous(1, 60.0)))
    pushed = mechanism_of(model, np.array([*block().parameters, -1.0]))
    with pytest.raises(SolverError, match=r"diverges|cannot be accelerated"):
        play(pushed, 0.0, 2.0, 1.0, 100)


def test_a_robot_with_negative_mass_is_reported_as_one_that_cannot_be_accelerated():
    arm = mechanism(block().robot, np.array([[0.0] * 9 + [-1.0]]))
    with pytest.raises(SolverError, match="not positive definite"):
        play(arm, 0.0, 0.0, 0.1, 10)
