"""Hold the effects of drive, channel and surroundings to what they are made of."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.dynamics.terms.motions import cycle, swinging
from tests.tools import Motion, pinocchio_torque, random_bodies, random_robot
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.cable_force import Cable
from veritorque.core.dynamics.terms.coupling import GearCoupling
from veritorque.core.dynamics.terms.effect import OneJointTerm
from veritorque.core.dynamics.terms.joint_coupling import MissingCoupling
from veritorque.core.dynamics.terms.rotor_inertia import RotorInertia
from veritorque.core.dynamics.terms.rotor_inertia_missing import MissingRotor
from veritorque.core.dynamics.terms.spring_compensator import Spring
from veritorque.core.dynamics.terms.torque_gain_nonlinear import CubicGain
from veritorque.core.dynamics.terms.torque_offset_drift import Drift
from veritorque.core.dynamics.terms.torque_ripple import Ripple
from veritorque.core.dynamics.terms.torque_saturation import Saturation
from veritorque.core.robot.inertia import from_mass_properties
from veritorque.core.robot.model import Coupling
from veritorque.core.signals.state import MotionState

ROBOT = random_robot(np.random.default_rng(3), 3, prismatic=0.0)
STATE = swinging(3)
FLYWHEEL = random_robot(np.random.default_rng(0), 1, prismatic=0.0, gravity=False)
"""With a body of 1 kg m2 about its axis its torque is its acceleration."""


def flywheel_prediction() -> Prediction:
    body = from_mass_properties(2.0, np.zeros(3), np.eye(3))
    return Prediction(standard_model(FLYWHEEL, ("rigid_body",)), body)


def accelerated(torque: np.ndarray, time: np.ndarray) -> MotionState:
    still = np.zeros((len(time), 1))
    return MotionState(still, still, torque[:, None], time)


def test_a_curved_gain_adds_the_cube_of_the_torque_that_an_independent_engine_finds() -> None:
    bodies = random_bodies(np.random.default_rng(4), 3)
    described = Prediction(standard_model(ROBOT, ("rigid_body",)), bodies.ravel())
    torque = pinocchio_torque(ROBOT, bodies, Motion(STATE.position, STATE.velocity, STATE.acceleration))
    (column,) = CubicGain(2, described).series(ROBOT, STATE)
    np.testing.assert_allclose(column, torque[:, 1] ** 3, rtol=1e-9, atol=1e-9 * np.abs(torque).max() ** 3)


@pytest.mark.parametrize("time_constant", [0.5, 5.0, 200.0])
def test_a_drift_goes_from_nothing_to_all_of_it(time_constant: float) -> None:
    (column,) = Drift(1, 0.0, float(STATE.time[-1]), time_constant).series(ROBOT, STATE)
    assert column[0] == 0.0
    assert column[-1] == pytest.approx(1.0)
    assert (np.diff(column) > 0.0).all()


def test_a_drift_that_takes_far_longer_than_the_log_is_even() -> None:
    time = np.asarray(STATE.time)
    (column,) = Drift(1, 0.0, float(time[-1]), 1e4 * time[-1]).series(ROBOT, STATE)
    np.testing.assert_allclose(column, time / time[-1], atol=1e-4)


def test_a_command_above_the_limit_is_explained_by_the_arch_it_makes() -> None:
    time = np.arange(0.0, 10.0, 0.004)
    command = np.sin(2.0 * np.pi * 0.4 * time) + 0.5 * np.sin(2.0 * np.pi * 0.17 * time)
    limit = 1.1
    applied = np.clip(command, -limit, limit)
    columns = Saturation(1, flywheel_prediction(), 0.999 * limit).series(FLYWHEEL, accelerated(applied, time))
    excess = command - applied
    found, *_ = np.linalg.lstsq(columns.T, excess, rcond=None)
    assert np.abs(excess).max() > 0.2
    assert found[0] > 0.0
    # Arches of different peaks share one curvature: what is left is their difference.
    assert np.linalg.norm(excess - columns.T @ found) < 0.2 * np.linalg.norm(excess)


def test_nothing_exceeds_a_limit_that_the_torque_does_not_reach() -> None:
    time = np.arange(0.0, 4.0, 0.004)
    state = accelerated(np.sin(time), time)
    assert not Saturation(1, flywheel_prediction(), 1.01).series(FLYWHEEL, state).any()


def test_the_excess_does_not_jump_as_the_limit_moves_past_a_sample() -> None:
    time = np.arange(0.0, 4.0, 0.05)
    state, described = accelerated(np.sin(time), time), flywheel_prediction()
    limits = np.linspace(0.3, 0.9, 1201)
    columns = np.array([Saturation(1, described, limit).series(FLYWHEEL, state)[0] for limit in limits])
    moved = np.abs(np.diff(columns, axis=0)).max()
    # A limit that moves by 5e-4 moves an arch 2 s wide by less than its slope, 1 s, times 5e-4 / 0.43.
    assert moved < 2e-3


@pytest.mark.parametrize("term", [Spring(1), Cable(1, 0.2, 1.0), Cable(1, 0.2, -1.0), Ripple(1, 5.0, 0.1)])
def test_what_depends_on_the_angle_alone_gives_back_over_a_closed_path_what_it_took(
    term: OneJointTerm,
) -> None:
    state = cycle()
    for torque in term.series(FLYWHEEL, state):
        power = torque * state.velocity[:, 0]
        assert abs(np.trapezoid(power, state.time)) < 1e-6 * np.trapezoid(np.abs(power), state.time)


def test_a_cable_pulls_on_one_side_only_and_two_cables_make_a_spring() -> None:
    above, below = (Cable(2, 0.1, side).series(ROBOT, STATE)[0] for side in (1.0, -1.0))
    beyond = STATE.position[:, 1] > 0.1
    assert not above[~beyond].any()
    assert not below[beyond].any()
    np.testing.assert_allclose(above + below, Spring(2).series(ROBOT, STATE)[0] - 0.1, atol=1e-15)


def test_a_ripple_repeats_with_every_wave() -> None:
    turned = replace(STATE, position=STATE.position + 2.0 * np.pi / 7.0)
    term = Ripple(1, 7.0, 0.3)
    np.testing.assert_allclose(term.series(ROBOT, turned), term.series(ROBOT, STATE), atol=1e-12)


def test_a_missing_rotor_acts_as_a_declared_one() -> None:
    declared = RotorInertia().series(ROBOT, STATE)
    for joint in (1, 2, 3):
        np.testing.assert_array_equal(MissingRotor(joint).series(ROBOT, STATE)[0], declared[joint - 1])


def test_a_missing_coupling_acts_as_a_declared_one_whatever_else_is_declared() -> None:
    hidden = Coupling("undeclared", 3, (2, 3), (-1.0, 1.0))
    alone = replace(ROBOT, couplings=(hidden,))
    other = replace(ROBOT, couplings=(Coupling("other", 2, (1, 2), (1.0, 1.0)),))
    term = MissingCoupling(hidden)
    for robot in (ROBOT, other):
        assert term.entries(robot) == GearCoupling().entries(alone)
        np.testing.assert_array_equal(term.series(robot, STATE), GearCoupling().series(alone, STATE))


def test_the_friction_of_a_missing_coupling_never_gives_energy() -> None:
    term = MissingCoupling(Coupling("undeclared", 3, (2, 3), (-1.0, 1.0)))
    power = np.zeros((3, len(STATE.position)))
    for (joint, parameter), row in zip(term.entries(ROBOT), term.series(ROBOT, STATE), strict=True):
        power[parameter] += row * STATE.velocity[:, joint]
    assert (power[1:] >= -1e-15).all()
