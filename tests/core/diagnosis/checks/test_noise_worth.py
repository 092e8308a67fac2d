"""Hold what noise of the positions may account for to its laws."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.diagnosis.causes.protocol import Cause
from veritorque.core.diagnosis.causes.spring_compensator import SpringCompensator
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.checks.alternatives import compare_alternatives
from veritorque.core.diagnosis.checks.findings import finding
from veritorque.core.diagnosis.checks.noise_worth import noise_worth
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio
from veritorque.core.diagnosis.search.residuals import residual
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE

LATE_S = 4e-3


def _worth(cause: Cause, noise: float) -> tuple[float, float | None]:
    """Give the statistic of a late torque's candidate, and what noise of a torque of such a size is worth."""
    time, position, torque = recording()
    late = CubicSpline(time, torque)(np.clip(time - LATE_S, time[0], None))
    scene = scene_of(time, position, late)
    drawn = noise * np.random.default_rng(2).normal(size=scene.dataset.torque.shape)
    scene = replace(scene, dataset=replace(scene.dataset, position_torque=drawn))
    fitter = fitter_of(scene, (cause,))
    none = fitter.fit(())
    (best, *_) = fitter.scan(none)
    found = fitter.fit((best.candidate,), none)
    return likelihood_ratio(none, found), noise_worth(fitter, none, found, 0)


def test_noise_is_worth_its_square_and_changes_no_statistic():
    statistics, worths = zip(*(_worth(TimeDelay(), noise) for noise in (0.0, 0.01, 0.03)), strict=True)
    assert statistics[0] == statistics[1] == statistics[2] > 100.0
    assert worths[0] == 0.0
    assert worths[2] == pytest.approx(9.0 * worths[1])
    assert worths[1] > 0.0


@pytest.mark.parametrize(("times", "doubtful"), [(1.5, True), (3.0, False)])
def test_a_delay_is_doubtful_below_twice_what_noise_is_worth(times, doubtful):
    time, position, torque = recording()
    late = CubicSpline(time, torque)(np.clip(time - LATE_S, time[0], None))
    fitter = fitter_of(scene_of(time, position, late), (TimeDelay(),))
    none = fitter.fit(())
    (best, *_) = fitter.scan(none)
    state, (own,) = compare_alternatives(SearchState(fitter, none, fitter.fit((best.candidate,), none)))
    drawn = np.random.default_rng(2).normal(size=late[: len(fitter.dataset.time)].shape)
    worth = noise_worth(_noisy(state, drawn).fitter, own.without, state.chosen, 0)
    assert worth is not None
    noisy = _noisy(state, drawn * np.sqrt(own.statistic / times / worth))
    after = residual(noisy.fitter, noisy.chosen)
    assert finding(state, own, after, 0.0).confidence > CONFIDENCE.doubtful
    assert (finding(noisy, own, after, 0.0).confidence <= CONFIDENCE.doubtful) == doubtful


def _noisy(state: SearchState, drawn: np.ndarray) -> SearchState:
    """Give a state of which the positions have noise of such a torque."""
    dataset = replace(state.fitter.dataset, position_torque=drawn)
    return replace(state, fitter=replace(state.fitter, dataset=dataset))


def test_a_cause_unlike_such_noise_is_not_weighed_against_it():
    assert _worth(SpringCompensator(), 0.03)[1] is None
