"""Torques that were smoothed forwards and backwards are told by the joints that agree on it."""

from copy import copy
from functools import partial

import numpy as np
import pytest
from scipy.ndimage import uniform_filter1d
from scipy.signal import butter, lfilter, sosfiltfilt

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.arrays import JointSeries
from veritorque.core.diagnosis.causes.torque_filter_lag import TorqueFilterLag
from veritorque.core.diagnosis.checks.alternatives import compare_alternatives
from veritorque.core.diagnosis.checks.between_logs import BetweenLogs
from veritorque.core.diagnosis.checks.findings import finding
from veritorque.core.diagnosis.checks.instruments import Instruments
from veritorque.core.diagnosis.checks.smoothed_channels import Smoothing, beside_smoothing, smoothing
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


def test_what_is_found_in_smoothed_torques_is_doubtful():
    fitter = fitter_of(scene_of(TIME, POSITION, noisy(late(0.02))), (TorqueFilterLag(),))
    state, (own,) = compare_alternatives(search_stepwise(fitter))
    after, instruments = residual(state.fitter, state.chosen), Instruments(state.fitter, state.chosen)
    checks = instruments, StructureLeft(state.fitter, state.chosen)
    made = finding(state, own, after, 0.0, checks, BetweenLogs(state.fitter, state.chosen))
    joints = np.arange(TORQUE.shape[1])
    smoothed = Smoothing(0.1, np.ones(len(joints)), np.full(len(joints), 0.05), 100.0)
    own_springs = Smoothing(0.1, np.where(joints == 0, 1.0, 0.1), np.full(len(joints), 0.05), 100.0)
    (doubtful,), (as_before,) = (
        beside_smoothing([made], partial(copy, each)) for each in (smoothed, own_springs)
    )
    assert as_before is made
    assert made.confidence > CONFIDENCE.doubtful >= doubtful.confidence
    assert doubtful.evidence[-1].statistic == "smoothed torques"
