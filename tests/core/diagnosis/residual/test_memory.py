"""Hold the memory of a noise model to closed forms and to dense matrices."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import toeplitz

from veritorque.core.diagnosis.regression.ar_noise import ARNoise
from veritorque.core.diagnosis.residual.memory import covariance_of_sums, memory, spectrum


def _first_order(weight: float, deviation: float = 1.0) -> ARNoise:
    before = deviation / np.sqrt(1.0 - weight**2)
    return ARNoise((np.zeros(0), np.array([weight])), np.array([before, deviation]))


@given(weight=st.floats(-0.9, 0.95), deviation=st.floats(0.1, 10.0))
def test_the_mean_of_the_spectrum_is_the_variance(weight, deviation):
    noise = _first_order(weight, deviation)
    both_sides = np.concatenate([(power := spectrum(noise, 4096)), power[1:-1]])
    assert np.mean(both_sides) == pytest.approx(deviation**2 / (1.0 - weight**2), rel=1e-9)


@given(weight=st.floats(-0.9, 0.9), seed=st.integers(0, 99))
def test_the_covariance_of_sums_is_that_of_the_dense_matrix(weight, seed):
    rng = np.random.default_rng(seed)
    weights = rng.normal(size=(240, 3))
    dense = toeplitz(weight ** np.arange(240) / (1.0 - weight**2))
    dense[:100, 100:] = dense[100:, :100] = 0.0  # stretches do not know of each other
    found = covariance_of_sums(_first_order(weight), weights, np.array([0, 100]))
    # The circle of twice the length closes where 0.9^100 is left.
    np.testing.assert_allclose(found, weights.T @ dense @ weights, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize(("weight", "rows"), [(0.0, 1), (0.5, 4), (0.9, 22), (-0.9, 22)])
def test_an_autoregression_is_forgotten_once_its_weight_to_that_power_is_below_a_tenth(weight, rows):
    assert memory(_first_order(weight)) == rows
