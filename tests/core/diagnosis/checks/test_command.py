"""The command of the drives tells delay and gain of a torque channel, whatever the robot's model lacks."""

import numpy as np
import pytest

from tests.plant.cases import World, draw_world
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.causes.torque_filter_lag import TorqueFilterLag
from veritorque.core.diagnosis.causes.torque_gain import TorqueGain
from veritorque.core.diagnosis.checks.command import channel_of, command_evidence, contradicted_by_command
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.signals.condition import condition
from veritorque.core.study import IdentifyRequest, diagnose

RATE_HZ, SEED = 250.0, 17


@pytest.fixture(scope="module")
def world() -> World:
    """Draw an arm of another engine."""
    return draw_world(np.random.default_rng(SEED), SEED, robot="planar-3", duration=20.0, rate_hz=RATE_HZ)


def logged(world: World, *, delay: float = 0.0, gain: float = 1.0, name: str = "torque_ref") -> JointLog:
    """Log torques that come later than asked for, the second one too large, with noise of the channel."""
    signals, rng = world.signals(()), np.random.default_rng(SEED)
    asked = signals.torque
    made = np.column_stack([np.interp(signals.time - delay, signals.time, column) for column in asked.T])
    made[:, 1] *= gain
    made += world.noise_rms * rng.normal(size=made.shape)
    return log_from_arrays("commanded", signals.time, signals.position, made, **{name: asked})


def motion_of(world: World, log: JointLog):
    return (condition(log, world.arm.robot),)


@pytest.mark.parametrize("delay", [-0.002, 0.0, 0.003, 0.02])
def test_the_delay_of_every_channel_is_told_within_its_deviations(world, delay):
    found = channel_of(motion_of(world, logged(world, delay=delay)))
    assert found.command == "torque_ref"
    assert (np.abs(found.delay - delay) < 4.0 * found.delay_deviation).all()
    assert (found.delay_deviation < 1e-3).all()


def test_a_gain_is_told_from_those_of_the_other_joints(world):
    motions = motion_of(world, logged(world, gain=1.05))
    (told,) = command_evidence(motions, TorqueGain.id, (2,))
    assert told.value == pytest.approx(0.05, abs=0.01)
    assert "differs by" in told.statement
    (other,) = command_evidence(motions, TorqueGain.id, (1,))
    assert abs(other.value) < 0.01


def test_commands_in_units_of_their_own_tell_delays_only(world):
    motions = motion_of(world, logged(world, delay=0.003, name="command"))
    assert command_evidence(motions, TorqueGain.id, (2,)) == ()
    (told,) = command_evidence(motions, TimeDelay.id, ())
    assert told.value == pytest.approx(0.003, abs=3e-4)
    assert "behind the logged command" in told.statement


def test_a_torque_that_is_the_command_itself_tells_nothing(world):
    signals = world.signals(())
    same = log_from_arrays("same", signals.time, signals.position, signals.torque, torque_ref=signals.torque)
    assert command_evidence(motion_of(world, same), TimeDelay.id, ()) == ()
    assert command_evidence(motion_of(world, same), TorqueGain.id, (1,)) == ()


def test_a_log_without_command_and_a_cause_elsewhere_have_no_such_evidence(world):
    signals = world.signals(())
    plain = log_from_arrays("plain", signals.time, signals.position, signals.torque)
    assert channel_of(motion_of(world, plain)) is None
    assert command_evidence(motion_of(world, logged(world)), "friction_stribeck", (1,)) == ()


@pytest.mark.parametrize(("delay", "denied"), [(0.0, True), (0.002, True), (0.004, False), (0.006, False)])
def test_a_filter_of_which_the_command_shows_less_than_half_is_denied(world, delay, denied):
    motions = motion_of(world, logged(world, delay=delay))
    assert contradicted_by_command(motions, TorqueFilterLag.id, (2,), 0.006) == denied
    assert not contradicted_by_command(motions, TimeDelay.id, (2,), 0.006)


def test_a_log_without_command_denies_nothing(world):
    signals = world.signals(())
    plain = log_from_arrays("plain", signals.time, signals.position, signals.torque)
    assert not contradicted_by_command(motion_of(world, plain), TorqueFilterLag.id, (2,), 0.006)


def test_a_finding_of_a_delay_states_what_the_command_says(world):
    request = IdentifyRequest(world.arm.robot, (logged(world, delay=0.006),), {"bootstrap": {"draws": 0}})
    findings = {finding["cause"]: finding for finding in diagnose(request)["diagnosis"]["findings"]}
    own = findings["time_delay"]
    (told,) = (one for one in own["evidence"] if one["statistic"] == "against the command")
    found = next(one for one in own["parameters"] if one["name"] == "delay")
    assert told["value"] == pytest.approx(found["value"], abs=1e-3)
    assert told["value"] == pytest.approx(0.006, abs=3e-4)
