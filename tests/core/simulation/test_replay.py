"""Closed-loop replay: the true model follows with next to no help, a wrong one shows what it lacks."""

import numpy as np
import pytest

from tests.core.simulation.logs import logged
from tests.core.simulation.worlds import block, mechanism
from tests.tools import random_motion
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.friction_presliding import Presliding
from veritorque.core.dynamics.terms.time_delay import Delay
from veritorque.core.dynamics.terms.torque_gain import CommonGain
from veritorque.core.errors import OptionError
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.inverse import inverse_dynamics
from veritorque.core.simulation.mechanism import mechanism_of, share_of
from veritorque.core.simulation.replay import Gains, ReplayOptions, default_gains, fitted_gains, replay


@pytest.mark.parametrize("feed_forward", ["measured", "model"])
def test_the_true_model_tracks_the_measured_motion_with_the_measured_torque(arm, motion, feed_forward):
    found = replay(mechanism(*arm, FC=1.0), (motion,), ReplayOptions(feed_forward))
    assert len(found.blocks) == 8
    assert np.all(found.position_rms < 5e-4)
    torque = np.vstack([one.measured_torque for one in found.blocks])
    assert np.all(found.torque_rms < 0.05 * torque.std(axis=0))


def test_without_feed_forward_the_gains_alone_give_the_torque_of_the_motion(arm, motion):
    found = replay(mechanism(*arm, FC=1.0), (motion,), ReplayOptions("none", bandwidth_hz=20.0))
    torque = np.vstack([one.measured_torque for one in found.blocks])
    assert np.all(found.torque_rms < 0.5 * torque.std(axis=0))
    assert np.all(found.position_rms < 0.05)


def test_what_the_controller_adds_is_what_the_model_lacks(arm, motion):
    found = replay(mechanism(*arm, FC=1.0, OFF=2.0), (motion,), ReplayOptions(bandwidth_hz=10.0))
    late = [(one.torque - one.measured_torque)[len(one.time) // 2 :] for one in found.blocks]
    np.testing.assert_allclose(np.vstack(late).mean(axis=0), 2.0, atol=0.2)


def test_default_gains_damp_a_joint_critically_at_the_bandwidth():
    gains = default_gains(block(), np.zeros((3, 1)), 5.0)
    rate = np.sqrt(gains.stiffness / 2.0)
    np.testing.assert_allclose(rate, 2.0 * np.pi * 5.0)
    np.testing.assert_allclose(gains.damping / (2.0 * 2.0 * rate), 1.0)


def test_gains_are_fitted_from_a_reference_and_refused_without_one(arm):
    rng = np.random.default_rng(3)
    true, real = mechanism(*arm, FC=1.0), Gains(np.array([50.0, 80.0, 20.0]), np.array([5.0, 6.0, 1.0]))
    samples = random_motion(rng, 3, 400)
    reference = MotionState(samples.position, samples.velocity, samples.acceleration)
    slip = 0.01 * rng.normal(size=(2, 400, 3))
    measured = MotionState(samples.position - slip[0], samples.velocity - slip[1], samples.acceleration)
    torque = true.torque(reference) + slip[0] * real.stiffness + slip[1] * real.damping
    found = fitted_gains(true, reference, measured, torque)
    np.testing.assert_allclose(found.stiffness, real.stiffness, rtol=1e-6)
    np.testing.assert_allclose(found.damping, real.damping, rtol=1e-6)
    with pytest.raises(OptionError, match="cannot be fitted"):
        fitted_gains(true, reference, reference, torque)


def test_blocks_that_do_not_exist_cannot_be_played(arm, motion):
    with pytest.raises(OptionError, match="no block"):
        replay(mechanism(*arm), (motion,), chosen=frozenset({(0, 99)}))


def _knowing(arm, term, value):
    """Give the mechanism that has a term, and the log of its motion."""
    plain = mechanism(*arm, FC=1.0)
    believed = Prediction(plain.model, plain.parameters, inverse_dynamics)
    model = plain.model.with_term(term(believed))
    known = mechanism_of(model, np.append(plain.parameters, value))
    alone = share_of(model.robot, [(model.terms[-1], np.array([value]))])
    return known, logged(*arm, more=alone.torque)


TERMS = {
    "late channel": (lambda believed: Delay(0, believed, 0.02), 0.02),
    "wrong gain": (lambda believed: CommonGain(0, believed), 0.3),
    "friction that builds up": (lambda _: Presliding(1, 0.05), 1.0),
}


@pytest.mark.parametrize("what", TERMS)
@pytest.mark.parametrize("feed_forward", ["measured", "model", "none"])
def test_faults_of_the_channel_and_what_remembers_are_played_as_they_were_logged(arm, what, feed_forward):
    knowing, motion = _knowing(arm, *TERMS[what])
    plain = mechanism(*arm, FC=1.0)
    options = ReplayOptions(feed_forward, bandwidth_hz=20.0)
    found, ignorant = replay(knowing, (motion,), options), replay(plain, (motion,), options)
    honest = replay(plain, (logged(*arm),), options)
    np.testing.assert_allclose(found.position_rms, honest.position_rms, rtol=0.1, atol=2e-5)
    np.testing.assert_allclose(found.torque_rms, honest.torque_rms, rtol=0.3)
    assert found.torque_rms[0] < 0.8 * ignorant.torque_rms[0]
