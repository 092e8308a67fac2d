"""Torques that were smoothed forwards and backwards are told by the joints that agree on it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import uniform_filter1d
from scipy.signal import butter, lfilter, sosfiltfilt

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.arrays import JointSeries, Vector
from veritorque.core.diagnosis.causes.friction_viscous_nonlinear import FrictionViscousNonlinear
from veritorque.core.diagnosis.causes.torque_filter_lag import TorqueFilterLag
from veritorque.core.diagnosis.causes.torque_ripple import TorqueRipple
from veritorque.core.diagnosis.checks.alternatives import compare_alternatives
from veritorque.core.diagnosis.checks.between_logs import BetweenLogs
from veritorque.core.diagnosis.checks.findings import finding
from veritorque.core.diagnosis.checks.instruments import Instruments
from veritorque.core.diagnosis.checks.smoothed_channels import beside_smoothing, smoothing
from veritorque.core.diagnosis.checks.structure_left import StructureLeft
from veritorque.core.diagnosis.search.residuals import residual
from veritorque.core.diagnosis.search.stepwise import search_stepwise
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE

TIME, POSITION, TORQUE = recording()
STEP = float(TIME[1] - TIME[0])


def moving_mean(seconds: float) -> JointSeries:
    """Smooth the torques by a moving mean."""
    return uniform_filter1d(TORQUE, 1 + 2 * round(0.5 * seconds / STEP), axis=0, mode="nearest")


def both_ways(cutoff_hz: float) -> JointSeries:
    """Filter the torques forwards and backwards."""
    return np.asarray(sosfiltfilt(butter(2, cutoff_hz, fs=1.0 / STEP, output="sos"), TORQUE, axis=0))


def late(seconds: float) -> JointSeries:
    """Filter the torques by a first-order filter, as a drive does."""
    pole = np.exp(-STEP / seconds)
    return np.asarray(lfilter([1.0 - pole], [1.0, -pole], TORQUE, axis=0, zi=pole * TORQUE[:1])[0])


def noisy(torque: JointSeries) -> JointSeries:
    """Add noise to what was logged."""
    return torque + 0.02 * TORQUE.std(axis=0) * np.random.default_rng(3).normal(size=TORQUE.shape)


@pytest.mark.parametrize(
    ("torque", "length"),
    [(moving_mean(0.08), 0.08), (moving_mean(0.2), 0.2), (both_ways(4.0), None)],
    ids=["moving mean of 80 ms", "moving mean of 200 ms", "filter that is run in both directions"],
)
def test_smoothed_torques_are_told_with_the_length(torque, length):
    fitter = fitter_of(scene_of(TIME, POSITION, noisy(torque)), ())
    found = smoothing(fitter, fitter.fit(()))
    assert found.is_clear
    if length:
        assert found.length == pytest.approx(length, rel=0.25)


@pytest.mark.parametrize("torque", [TORQUE, late(0.02)], ids=["as measured", "late by a drive's filter"])
def test_torques_that_are_not_smoothed_are_not_called_so(torque):
    fitter = fitter_of(scene_of(TIME, POSITION, noisy(torque)), (TorqueFilterLag(),))
    state = search_stepwise(fitter)
    assert not smoothing(state.fitter, state.chosen).is_clear


def test_one_joint_that_lacks_what_is_quick_may_have_a_spring():
    fitter = fitter_of(scene_of(TIME, POSITION, noisy(moving_mean(0.1))), ())
    found = smoothing(fitter, fitter.fit(()))
    one = replace(found, shares=np.where(np.arange(TORQUE.shape[1]) == 0, 1.0, 0.1))
    assert found.is_clear
    assert not one.is_clear


def given(torque, *causes):
    """Search for causes; give the fitter, the hypothesis, and the findings before smoothing is thought of."""
    state, comparisons = compare_alternatives(
        search_stepwise(fitter_of(scene_of(TIME, POSITION, torque), causes))
    )
    fitter, chosen = state.fitter, state.chosen
    after, checks = residual(fitter, chosen), (Instruments(fitter, chosen), StructureLeft(fitter, chosen))
    logs = BetweenLogs(fitter, chosen)
    return fitter, chosen, [finding(state, own, after, 0.0, checks, logs) for own in comparisons]


def with_effect(effect: Vector) -> JointSeries:
    """Add an effect on joint 1 to the torques, smooth them by 100 ms, and add noise."""
    acts = np.arange(TORQUE.shape[1]) == 0
    torque = TORQUE + np.where(acts, effect[:, None], 0.0)
    return noisy(uniform_filter1d(torque, 1 + 2 * round(0.05 / STEP), axis=0, mode="nearest"))


def test_what_changes_with_the_direction_of_motion_is_doubtful_in_smoothed_torques():
    speed = np.gradient(POSITION[:, 0], STEP)
    drag = np.sign(speed) * np.abs(speed / speed.std()) ** 2.0
    fitter, chosen, (made,) = given(with_effect(0.3 * TORQUE[:, 0].std() * drag), FrictionViscousNonlinear())
    assert made.confidence > CONFIDENCE.doubtful
    (doubtful,) = beside_smoothing([made], fitter, chosen)
    assert doubtful.confidence == CONFIDENCE.doubtful
    assert doubtful.evidence[-1].statistic == "smoothed torques"


def test_torques_that_are_not_smoothed_put_nothing_in_doubt():
    fitter, chosen, made = given(noisy(late(0.02)), TorqueFilterLag())
    assert made[0].confidence > CONFIDENCE.doubtful
    assert beside_smoothing(made, fitter, chosen) == made


def test_what_smoothing_does_not_take_away_stays_as_sure():
    wave = 0.3 * TORQUE[:, 0].std() * np.cos(6.0 * POSITION[:, 0] + 0.4)
    fitter, chosen, made = given(with_effect(wave), TorqueRipple())
    assert smoothing(fitter, chosen).is_clear
    ripple = next(one for one in made if one.joints == (1,))
    assert ripple.confidence > CONFIDENCE.doubtful
    (kept,) = (one for one in beside_smoothing(made, fitter, chosen) if one.joints == (1,))
    assert kept == ripple
