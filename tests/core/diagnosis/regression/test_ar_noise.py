"""Hold the model of a residual's memory to dense matrices and to what white noise is."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from tests.core.diagnosis.processes import SLOW, WAVY, WHITE, dense_covariance, drawn, exact_noise, ljung_box
from veritorque.core.diagnosis.regression.ar_noise import ARNoise, fit_ar_noise, run_indices
from veritorque.core.diagnosis.thresholds.regression import NOISE

every_process = pytest.mark.parametrize("weights", [WHITE, SLOW, WAVY], ids=["white", "slow", "wavy"])
GAPS = np.array([True] * 25 + [False] + [True] * 4 + [False] * 2 + [True, False] + [True] * 26)


def one_run(count: int) -> np.ndarray:
    return np.arange(count)


def runs(mask: np.ndarray) -> np.ndarray:
    """Give the places within their runs of the rows that a mask keeps."""
    return run_indices(np.diff(np.flatnonzero(mask), prepend=-2) == 1)


def log_likelihood(noise: ARNoise, series: np.ndarray, place: np.ndarray) -> float:
    white = noise.whitened(series[:, None], place)[:, 0]
    return -0.5 * float(white @ white) - noise.log_deviations(place) - 0.5 * len(series) * np.log(2.0 * np.pi)


def test_noise_of_one_kind_departs_from_another_by_the_likelihood_it_loses_on_average():
    rng, slow, wavy = np.random.default_rng(0), exact_noise(SLOW), exact_noise(WAVY)
    place = one_run(2000)
    lost = []
    for _ in range(40):
        series = drawn(SLOW, rng, len(place))[:, 0]
        lost.append(log_likelihood(slow, series, place) - log_likelihood(wavy, series, place))
    assert slow.departure(slow, series, place) == 0.0
    assert slow.departure(wavy, series, place) == pytest.approx(np.mean(lost), rel=0.1)


@every_process
@pytest.mark.parametrize("seed", range(5))
def test_what_was_learned_from_coloured_noise_makes_it_white(weights, seed):
    series = drawn(weights, np.random.default_rng(seed), 3000)
    place = one_run(len(series))
    white = fit_ar_noise(series[:, 0], place).whitened(series, place)[:, 0]
    assert ljung_box(white, fitted=NOISE.order) > 1e-3
    assert np.var(white) == pytest.approx(1.0, abs=0.02)
    if weights:
        assert ljung_box(series[:, 0]) < 1e-12


@every_process
def test_the_likelihood_of_gappy_rows_is_that_of_the_dense_normal_distribution(weights):
    place = runs(GAPS)
    series = drawn(weights, np.random.default_rng(1), len(place))[:, 0]
    dense = multivariate_normal(np.zeros(len(place)), dense_covariance(weights, place))
    assert log_likelihood(exact_noise(weights), series, place) == pytest.approx(
        dense.logpdf(series), rel=1e-10
    )


@every_process
def test_whatever_is_learned_is_one_stationary_process(weights):
    """The covariance that the whitening implies depends on the lag alone, from the first row on."""
    series = drawn(weights, np.random.default_rng(2), 600)[:, 0]
    noise = fit_ar_noise(series, one_run(600))
    whitening = noise.whitened(np.eye(60), one_run(60))
    root = np.linalg.solve(whitening, np.eye(60))
    covariance = root @ root.T
    for lag in range(40):
        band = np.diag(covariance, lag)
        np.testing.assert_allclose(band, band[0], atol=1e-9 * covariance[0, 0])


def test_a_row_after_a_gap_knows_nothing_of_the_rows_before_it():
    place = runs(GAPS)
    series = drawn(WAVY, np.random.default_rng(3), len(place))
    other = series.copy()
    other[:25] += 100.0
    noise = exact_noise(WAVY)
    np.testing.assert_array_equal(noise.whitened(series, place)[25:], noise.whitened(other, place)[25:])


@every_process
def test_one_column_has_the_innovations_that_the_matrix_gives(weights):
    place, noise = runs(GAPS), exact_noise(weights)
    series = drawn(weights, np.random.default_rng(8), len(place))
    np.testing.assert_allclose(
        noise.innovations(series[:, 0], place), noise.whitened(series, place)[:, 0], atol=1e-13
    )


def test_gaps_do_not_bias_what_is_learned():
    rng = np.random.default_rng(4)
    kept = rng.random(20_000) > 0.05
    series = drawn(SLOW, rng, 20_000)[kept, 0]
    found = fit_ar_noise(series, runs(kept), order=1)
    assert found.predictors[1][0] == pytest.approx(SLOW[0], abs=0.02)
    assert found.deviations[1] == pytest.approx(1.0, abs=0.02)


def test_the_deviation_allows_for_what_a_fit_took_out():
    """The mean over draws of the innovations' variance is one although sixty columns were fitted."""
    rng = np.random.default_rng(5)
    basis = np.linalg.qr(rng.normal(size=(600, 60)))[0]
    left = rng.normal(size=(600, 200))
    left -= basis @ (basis.T @ left)
    found = [fit_ar_noise(one, one_run(600), order=0, taken=60.0).deviations[0] ** 2 for one in left.T]
    assert np.mean(found) == pytest.approx(1.0, abs=4.0 * np.std(found) / np.sqrt(len(found)))


def test_the_order_is_no_higher_than_a_short_series_allows():
    assert fit_ar_noise(np.random.default_rng(6).normal(size=100), one_run(100)).order == 3


def test_rows_that_stand_alone_are_taken_for_independent():
    series, place = np.random.default_rng(7).normal(size=500), np.zeros(500, dtype=int)
    assert fit_ar_noise(series, place).order == 0
