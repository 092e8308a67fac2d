"""Gains, filters and encoders that lie: columns against the exact effect."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tests.core.dynamics.terms.chains import JOINTS, described_chain, exact, motion_of, one_viscous_joint
from veritorque.core.dynamics.prediction import shift_joint
from veritorque.core.dynamics.terms.encoder_error import EncoderEccentricity, EncoderOffset
from veritorque.core.dynamics.terms.position_filter import PositionFilter, time_power
from veritorque.core.dynamics.terms.time_delay import Delay
from veritorque.core.dynamics.terms.torque_filter_lag import FilterLag
from veritorque.core.dynamics.terms.torque_gain import CommonGain, TorqueGain
from veritorque.core.dynamics.terms.viscous import Viscous
from veritorque.core.signals.state import MotionState

FIRST_ORDER = 1e-3
"""Errors of 1e-4 rad leave second-order remainders of about 1e-4 of the column."""
ERROR = 1e-4


def sine(frequency: float) -> MotionState:
    time = np.arange(4000) / 1000.0
    wave = np.sin(frequency * time)[:, None]
    return MotionState(np.zeros_like(wave), wave, np.zeros_like(wave), time)


@pytest.mark.parametrize("joint", range(1, JOINTS + 1))
def test_a_zero_error_changes_the_torque_as_the_column_says(joint):
    described, bodies = described_chain(joint)
    measured = motion_of(joint)
    still = np.zeros((len(measured.position), 1))
    true = shift_joint(measured, joint - 1, MotionState(still - ERROR, still, still))
    robot = described.model.robot
    change = exact(robot, bodies, true) - exact(robot, bodies, measured)
    (column,) = EncoderOffset(joint, described).torques(robot, measured)
    np.testing.assert_allclose(ERROR * column, change, atol=FIRST_ORDER * np.abs(change).max())


@pytest.mark.parametrize("joint", range(1, JOINTS + 1))
def test_an_eccentric_disc_changes_the_torque_as_its_two_columns_say(joint):
    described, bodies = described_chain(joint)
    true, own, phase = motion_of(joint), joint - 1, 0.7
    q, dq, ddq = (one[:, [own]] for one in (true.position, true.velocity, true.acceleration))
    sine_, cosine = ERROR * np.sin(q + phase), ERROR * np.cos(q + phase)
    measured = shift_joint(true, own, MotionState(sine_, cosine * dq, cosine * ddq - sine_ * dq**2))
    robot = described.model.robot
    change = exact(robot, bodies, true) - exact(robot, bodies, measured)
    along, across = EncoderEccentricity(joint, described).torques(robot, measured)
    found = ERROR * (np.cos(phase) * along + np.sin(phase) * across)
    np.testing.assert_allclose(found, change, atol=FIRST_ORDER * np.abs(change).max())


def test_a_gain_scales_its_own_channel_and_no_other():
    described, bodies = described_chain(0)
    state = motion_of(0)
    term = TorqueGain(2, described)
    robot = described.model.robot
    assert term.entries(robot) == ((1, 0),)
    np.testing.assert_allclose(term.series(robot, state)[0], exact(robot, bodies, state)[:, 1], rtol=1e-9)


@pytest.mark.parametrize("time_constant", [0.005, 0.05])
def test_a_filter_weakens_and_delays_a_sine_as_its_transfer_function_says(time_constant):
    described, state, frequency = one_viscous_joint(), sine(20.0), 20.0
    (column,) = FilterLag(0, described, time_constant).torques(described.model.robot, state)
    found = (state.velocity + time_constant * column)[2000:, 0]
    turned = frequency * time_constant
    wave = np.sin(frequency * state.time - np.arctan(turned))[2000:] / np.hypot(1.0, turned)
    np.testing.assert_allclose(
        found, wave, atol=1e-4
    )  # samples a millisecond apart, joined by straight lines


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("cutoff", [4.0, 12.0])
def test_what_a_filter_took_of_a_sine_is_given_back_as_its_gain_says(cutoff, order):
    described, state, frequency = one_viscous_joint(), sine(20.0), 20.0
    power = time_power(cutoff, order)
    (column,) = PositionFilter(0, described, power, order, 12).torques(described.model.robot, state)
    passed = 1.0 / (1.0 + power * frequency ** (2 * order))
    # The bilinear filter's frequency differs by (w h)^2 / 12 of it.
    np.testing.assert_allclose(
        (power * column)[1000:-1000, 0],
        (1.0 / passed - 1.0) * state.velocity[1000:-1000, 0],
        atol=2e-3 * (1.0 / passed - 1.0),
    )


def test_a_short_filter_is_a_delay():
    described, state = one_viscous_joint(), sine(5.0)
    robot = described.model.robot
    (filtered,) = FilterLag(0, described, 1e-3).torques(robot, state)
    (delayed,) = Delay(0, described).torques(robot, state)
    np.testing.assert_allclose(filtered[100:-2], delayed[100:-2], atol=0.006 * np.abs(delayed).max())


def test_a_delayed_torque_is_that_of_the_motion_at_hand():
    described, robot = one_viscous_joint(), one_viscous_joint().model.robot
    for state in (sine(5.0), sine(2.0), sine(5.0)):  # what delays share must not pass to another motion
        torque = described.scaled(state)
        earlier = np.clip(state.time - 0.02, state.time[0], state.time[-1])
        (column,) = Delay(0, described, 0.02).torques(robot, state)
        np.testing.assert_array_equal(column, (CubicSpline(state.time, torque)(earlier) - torque) / 0.02)


def test_the_columns_of_an_encoder_do_not_depend_on_where_the_log_begins():
    described, _ = described_chain(1)
    state = motion_of(1, 8)
    later = replace(
        state, position=state.position[4:], velocity=state.velocity[4:], acceleration=state.acceleration[4:]
    )
    robot = described.model.robot
    term = EncoderEccentricity(2, described)
    for whole, part in zip(term.torques(robot, state), term.torques(robot, later), strict=True):
        np.testing.assert_allclose(whole[4:], part, atol=1e-9)


def test_a_channel_scales_and_delays_what_joined_the_model_like_the_model_itself():
    alone, state = one_viscous_joint(), sine(20.0)
    robot = alone.model.robot
    joined = alone.joined_by([(Viscous(), np.array([3.0]))])
    heavy = replace(alone, standard=4.0 * alone.standard)
    for made in (
        lambda one: Delay(0, one, 0.02),
        lambda one: FilterLag(0, one, 0.02),
        lambda one: CommonGain(0, one),
    ):
        (ours,), (expected,) = (made(one).torques(robot, state) for one in (joined, heavy))
        np.testing.assert_allclose(ours, expected, rtol=1e-12)


def test_what_is_late_is_the_torque_as_its_channel_scales_it():
    alone, state = one_viscous_joint(), sine(20.0)
    robot = alone.model.robot
    scaled = alone.joined_by([(TorqueGain(1, alone), np.array([0.5]))])
    heavy = replace(alone, standard=1.5 * alone.standard)
    (ours,), (expected,) = (Delay(0, one, 0.02).torques(robot, state) for one in (scaled, heavy))
    np.testing.assert_allclose(ours, expected, rtol=1e-12)
    np.testing.assert_array_equal(TorqueGain(1, scaled).columns(state), alone.torque(state).T)
