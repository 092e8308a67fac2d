"""Hold what is taken for noise of the positions to noise of known size, and to what such noise looks like."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tests.core.diagnosis.scenes import ARM_RATE_HZ, fitter_of, recording, scene_of, skew_arm
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters
from veritorque.core.diagnosis.bandwidth import Fitted, beyond_cubics, few_off, limit_bandwidth
from veritorque.core.diagnosis.dataset.dataset import build_dataset, identification_width
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.diagnosis.thresholds.dataset import BAND
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.signals.recipe import FilterOptions, choose_recipe
from veritorque.core.study import IdentifyRequest, diagnose

SCATTER = 6e-5
"""Of the stamps, s."""


def scattered(time: np.ndarray, seed: int = 4, scatter: float = SCATTER) -> np.ndarray:
    return time + scatter * np.random.default_rng(seed).normal(size=len(time))


def rms(values: np.ndarray) -> np.ndarray:
    return np.sqrt(np.mean(values**2, axis=0))


def test_noise_keeps_its_size_whatever_the_stamps():
    rng = np.random.default_rng(1)
    time = np.cumsum(rng.uniform(0.5, 1.5, 20_000)) / ARM_RATE_HZ
    noise = rng.normal(size=(len(time), 2)) * [1e-4, 3e-5]
    swing = np.sin(6.0 * time)[:, None] * [1.0, 0.5]
    np.testing.assert_allclose(rms(beyond_cubics(time, swing + noise)), [1e-4, 3e-5], rtol=0.05)


def test_stamps_that_scatter_are_noise_in_proportion_to_speed():
    time = np.arange(20_000) / ARM_RATE_HZ
    swing = np.sin(6.0 * time)[:, None]
    speed = 6.0 / np.sqrt(2.0)
    assert rms(beyond_cubics(scattered(time), swing))[0] == pytest.approx(SCATTER * speed, rel=0.05)
    assert rms(beyond_cubics(time, swing))[0] < 0.01 * SCATTER * speed


@pytest.mark.slow
@pytest.mark.parametrize("off", [1, 12])
def test_few_stamps_that_are_off_hide_no_late_torque(off):
    """Of 3000: they spoil the rows beside them, and say nothing of the rest."""
    state, late = swinging(3, 12.0), 1e-3
    model = standard_model(skew_arm())
    torque = model.torque(true_parameters(model), state)
    time = np.arange(len(torque)) / ARM_RATE_HZ
    torque = CubicSpline(time, torque)(np.clip(time - late, 0.0, None))
    torque += 0.02 * np.random.default_rng(6).normal(size=torque.shape)
    some = np.random.default_rng(3).choice(np.arange(100, len(time) - 100), off, replace=False)
    stamps = time.copy()
    stamps[some] += 0.3 / ARM_RATE_HZ
    log = log_from_arrays("arm", stamps, state.position, torque)
    found = diagnose(IdentifyRequest(skew_arm(), (log,), {"bootstrap": {"draws": 0}}))["diagnosis"]
    assert {"torque_filter_lag", "time_delay"} & {one["cause"] for one in found["findings"]}


@pytest.mark.slow
@pytest.mark.parametrize(("scatter", "noise"), [(SCATTER, 0.02), (3e-4, 0.05)])
def test_stamps_that_scatter_though_the_samples_do_not_are_not_used_and_make_no_finding(scatter, noise):
    state, rng = swinging(3, 12.0), np.random.default_rng(11)
    model = standard_model(skew_arm())
    torque = model.torque(true_parameters(model), state)
    torque += noise * rng.normal(size=torque.shape)
    time = scattered(np.arange(len(torque)) / ARM_RATE_HZ, scatter=scatter)
    log = log_from_arrays("arm", time, state.position, torque)
    found = diagnose(IdentifyRequest(skew_arm(), (log,), {"bootstrap": {"draws": 0}}))["diagnosis"]
    assert found["findings"] == []


def test_a_stamp_is_off_beside_others_that_scatter_less():
    time, off = np.arange(5000) / ARM_RATE_HZ, 0.3 / ARM_RATE_HZ
    assert not few_off(time).any()
    assert not few_off(scattered(time)).any()
    stamps = scattered(time)
    stamps[[700, 3000]] += off
    assert set(np.flatnonzero(few_off(stamps))) >= {698, 2998}
    assert few_off(stamps).sum() <= 10
    stamps[::100] += off
    assert not few_off(stamps).any()


@pytest.mark.slow
def test_noise_of_positions_narrows_the_band_below_the_usual_least_as_the_identification_s():
    state, rng = swinging(3, 40.0), np.random.default_rng(3)
    model = standard_model(skew_arm())
    torque = model.torque(true_parameters(model), state)
    torque += 0.02 * rng.normal(size=torque.shape)
    time = np.arange(len(torque)) / ARM_RATE_HZ
    position = state.position + 1e-2 * np.random.default_rng(4).normal(size=torque.shape)
    sound = log_from_arrays("sound", time, state.position, torque)
    log = log_from_arrays("arm", time, position, torque)
    answer = diagnose(IdentifyRequest(skew_arm(), (log,), {"bootstrap": {"draws": 0}}))["diagnosis"]
    recipe = choose_recipe(log, FilterOptions())
    assert recipe.motion_band_hz == pytest.approx(choose_recipe(sound, FilterOptions()).motion_band_hz)
    assert recipe.cutoff_hz <= answer["band_hz"] < 0.6 * BAND.narrowest * recipe.motion_band_hz
    assert all(finding["confidence"] <= CONFIDENCE.doubtful for finding in answer["findings"])


@pytest.mark.parametrize("noise", [1e-3, 0.3])
def test_no_band_is_searched_in_which_noise_drowns_the_motion(noise):
    time, position, torque = recording()
    scene = scene_of(time, position + noise * np.random.default_rng(4).normal(size=position.shape), torque)
    (log,) = (motion.log for motion in scene.dataset.motions)
    asked: list[float] = []

    def fitted_at(width: float) -> Fitted:
        asked.append(width)
        model = standard_model(skew_arm())
        dataset = build_dataset(model, (log,), held_out=frozenset({(0, 4)}), blocks=5, width=width)
        found = fitter_of(replace(scene, dataset=dataset), ()).fit(())
        return dataset, scene.operating_point, tuple(joint.noise for joint in found.fit.joints)

    chosen = limit_bandwidth(fitted_at)[0]
    most = BAND.drowned * choose_recipe(log, FilterOptions()).outweighed_hz / chosen.motion_band_hz
    assert chosen.width <= max(most, identification_width(chosen))
    assert (most < BAND.over_motion) == (len(asked) > 1 and asked[1] == pytest.approx(most, rel=0.01))
