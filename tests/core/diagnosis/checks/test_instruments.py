"""Hold instruments to their laws: an effect of the robot is in both estimates, one of noise in one alone."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.conflicts.score import PLAIN
from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from tests.hidden.plan import Order, drawn
from veritorque.core.diagnosis.causes.joint_elasticity import JointElasticity
from veritorque.core.diagnosis.causes.protocol import Cause
from veritorque.core.diagnosis.causes.spring_compensator import SpringCompensator
from veritorque.core.diagnosis.checks.instruments import Instruments
from veritorque.core.diagnosis.dataset.smooth_motion import with_smooth_motion
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE, POSITION_NOISE
from veritorque.core.estimate.gaussian_prior import GaussianPrior
from veritorque.core.study import IdentifyRequest, diagnose

JOINT, STIFFNESS = 2, 1.5
NOISY = 2e-5
"""Noise of the encoders, rad: five hundred times less than the motion moves in a sample."""
LEVEL = float(np.log(POSITION_NOISE.level))


@cache
def _found(cause: type[Cause], stiffness: float, noise: float) -> tuple[Instruments, float]:
    """Look for a cause where a joint has a spring and encoders are noisy; give what least squares finds."""
    time, position, torque = recording()
    torque[:, JOINT - 1] += stiffness * position[:, JOINT - 1]
    seen = position + noise * np.random.default_rng(8).normal(size=position.shape)
    fitter = fitter_of(scene_of(time, seen, torque), (cause(),))
    none = fitter.fit(())
    best = next(one for one in fitter.scan(none) if one.candidate.site == (JOINT,))
    whole = fitter.fit((best.candidate,), none)
    return Instruments(fitter, whole), float(whole.fit.values[-1])


def _by_instruments(instruments: Instruments) -> float:
    return float(instruments.values[-1])


def test_where_encoders_are_good_both_estimates_are_the_same():
    instruments, spring = _found(SpringCompensator, STIFFNESS, 0.0)
    assert spring == pytest.approx(STIFFNESS, rel=0.02)
    assert _by_instruments(instruments) == pytest.approx(STIFFNESS, rel=0.02)
    assert instruments.log_p(0) < LEVEL < instruments.log_p_of_difference(0)


def test_instruments_find_a_spring_where_noise_biases_least_squares():
    instruments, spring = _found(SpringCompensator, STIFFNESS, NOISY)
    assert abs(spring - STIFFNESS) > STIFFNESS
    assert _by_instruments(instruments) == pytest.approx(STIFFNESS, rel=0.1)
    assert max(instruments.log_p(0), instruments.log_p_of_difference(0)) < LEVEL


def test_a_flexible_joint_that_noise_makes_is_not_as_large_by_instruments():
    instruments, compliance = _found(JointElasticity, 0.0, NOISY)
    assert abs(_by_instruments(instruments)) < 0.25 * abs(compliance)
    assert instruments.change(0) == pytest.approx(1.0 - _by_instruments(instruments) / compliance)
    assert instruments.log_p_of_difference(0) < LEVEL


def test_a_prior_holds_both_estimates():
    instruments, _ = _found(SpringCompensator, STIFFNESS, NOISY)
    fitter, fit = instruments.fitter, instruments.whole.fit
    known = len(fit.values)
    prior = GaussianPrior(1e9 * np.eye(known), 1e9 * np.arange(1.0, known + 1.0))
    held = Instruments(replace(fitter, prior=prior), instruments.whole)
    assert held.values == pytest.approx(np.arange(1.0, known + 1.0), rel=1e-3)


def test_a_smooth_motion_keeps_its_rows_and_loses_the_noise():
    noisy = _found(SpringCompensator, STIFFNESS, NOISY)[0].fitter.dataset
    sound = _found(SpringCompensator, STIFFNESS, 0.0)[0].fitter.dataset
    smooth, beside = with_smooth_motion(noisy), with_smooth_motion(sound)
    rows = np.flatnonzero(noisy.usable.all(axis=1))
    before, after = (
        float(np.std((one.state.acceleration - other.state.acceleration)[rows]))
        for one, other in ((noisy, sound), (smooth, beside))
    )
    assert np.array_equal(smooth.torque, noisy.torque)
    assert after < 0.05 * before


def test_columns_without_motion_say_nothing_of_a_size():
    """Of a payload's ten columns four act on a planar arm; rounding in the others is no difference."""
    case = drawn(Order("single", 510100003, cause="payload_change", strength=1.0))
    (found,) = diagnose(IdentifyRequest(case.believed, (case.log,), PLAIN))["diagnosis"]["findings"]
    assert found["cause"] == "payload_change"
    (difference,) = [one for one in found["evidence"] if one["statistic"] == "log10 p of the difference"]
    assert difference["value"] > np.log10(POSITION_NOISE.level)
    assert found["confidence"] > CONFIDENCE.doubtful
