"""Hold what noise of the positions may account for to its laws."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.diagnosis.causes.protocol import Cause
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.causes.torque_saturation import TorqueSaturation
from veritorque.core.diagnosis.checks.alternatives import Comparison, compare_alternatives
from veritorque.core.diagnosis.checks.between_logs import BetweenLogs
from veritorque.core.diagnosis.checks.findings import finding
from veritorque.core.diagnosis.checks.instruments import Instruments
from veritorque.core.diagnosis.checks.position_noise import NoiseTest, noise_test, noise_worth
from veritorque.core.diagnosis.checks.structure_left import StructureLeft
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio
from veritorque.core.diagnosis.search.residuals import residual
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE, POSITION_NOISE

LATE_S = 4e-3


def _worth(cause: Cause, noise: float) -> tuple[float, float]:
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
    return likelihood_ratio(none, found), noise_worth(fitter, none, found)


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
    worth = noise_worth(_noisy(state, drawn).fitter, own.without, state.chosen)
    noisy = _noisy(state, drawn * np.sqrt(own.statistic / times / worth))
    after = residual(noisy.fitter, noisy.chosen)
    assert _confidence(state, own, after) > CONFIDENCE.doubtful
    assert (_confidence(noisy, own, after) <= CONFIDENCE.doubtful) == doubtful


def _noisy(state: SearchState, drawn: np.ndarray) -> SearchState:
    """Give a state of which the positions have noise of such a torque."""
    dataset = replace(state.fitter.dataset, position_torque=drawn)
    return replace(state, fitter=replace(state.fitter, dataset=dataset))


def _confidence(state: SearchState, own: Comparison, after: np.ndarray) -> float:
    checks = Instruments(state.fitter, state.chosen), StructureLeft(state.fitter, state.chosen)
    logs = BetweenLogs(state.fitter, state.chosen)
    return finding(state, own, after, 0.0, checks, logs).confidence


@pytest.mark.parametrize("alike", [False, True])
@pytest.mark.parametrize("little", [False, True])
@pytest.mark.parametrize("seen", [False, True])
@pytest.mark.parametrize(("differs", "mostly"), [(False, False), (True, False), (True, True)])
def test_a_finding_is_doubtful_by_its_size_or_where_noise_may_be_all_of_it(
    alike, little, seen, differs, mostly
):
    clear, unclear = np.log(POSITION_NOISE.level / 10.0), np.log(POSITION_NOISE.level * 10.0)
    statistic = POSITION_NOISE.times * (0.9 if little else 1.1)
    change = POSITION_NOISE.change * (1.1 if mostly else 0.9)
    size, difference = (clear if seen else unclear), (clear if differs else unclear)
    judged = NoiseTest(statistic, 1.0, size, difference, change, alike)
    assert judged.doubts == (mostly or (little and (alike or differs or not seen)))


@pytest.mark.parametrize(("cause", "judged"), [(TorqueSaturation, False), (TimeDelay, True)])
def test_what_a_smooth_motion_does_not_reach_is_not_held_against_it(cause, judged):
    fitter = fitter_of(scene_of(*recording()), (cause(),))
    none = fitter.fit(())
    (best, *_) = fitter.scan(none)
    found = fitter.fit((best.candidate,), none)
    test = noise_test(fitter, none, Instruments(fitter, found), 0, likelihood_ratio(none, found))
    assert (test is not None) == judged
