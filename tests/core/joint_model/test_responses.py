"""Filters agree with closed forms, and the noise's factor with its definition."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lsim

from veritorque.core.joint_model.orders import FLEXIBLE, RIGID, differences
from veritorque.core.joint_model.responses import (
    feedthrough,
    filtered,
    powers,
    spectral_factor,
    stabilised,
    transients,
)

STEP = 0.05
DENOMINATOR = np.poly([-0.7, -0.3 + 2.0j, -0.3 - 2.0j]).real


@pytest.mark.parametrize(("hold", "interpolated"), [("zero", False), ("first", True)])
def test_a_filter_is_exact_for_what_it_assumes_between_samples(hold, interpolated):
    series = np.random.default_rng(0).standard_normal(200)
    series[0] = 0.0
    numerator = np.array([0.4, -1.0, 2.0])
    time = STEP * np.arange(len(series))
    _, expected, _ = lsim((numerator, DENOMINATOR), series, time, interp=interpolated)
    np.testing.assert_allclose(
        filtered(numerator, DENOMINATOR, series, STEP, hold), expected, rtol=1e-9, atol=1e-12
    )


def test_the_powers_of_s_over_a_polynomial_add_up_to_the_series():
    series = np.random.default_rng(1).standard_normal(100)
    np.testing.assert_allclose(
        powers(DENOMINATOR, series, STEP, "first") @ DENOMINATOR[::-1], series, atol=1e-12
    )


def test_a_sample_enters_its_own_residual_by_the_feedthrough():
    impulse = np.zeros(8)
    impulse[4] = 1.0
    numerator = np.poly([0.0, -1.0, -2.0])
    states = powers(DENOMINATOR, impulse, STEP, "first")
    at_once = (states @ numerator[::-1])[4]
    assert feedthrough(numerator, DENOMINATOR, STEP) == pytest.approx(at_once, abs=1e-12)


def test_transients_span_every_beginning():
    columns = transients(DENOMINATOR, 60, STEP)
    time = STEP * np.arange(60)
    beginnings = np.column_stack([np.exp(-0.7 * time), np.exp(-0.3 * time) * np.sin(2.0 * time + 0.4)])
    left = beginnings - columns @ np.linalg.lstsq(columns, beginnings, rcond=None)[0]
    np.testing.assert_allclose(left, 0.0, atol=1e-9)


@given(st.floats(0.01, 100.0), st.floats(0.05, 5.0), st.floats(0.01, 1.0))
def test_the_factor_of_the_noise_has_its_spectrum_and_decays(ratio, frequency, decay):
    denominator = np.array([1.0, decay, frequency**2, 0.3, 0.0])
    numerator = np.array([1.0, 0.1, 0.5])
    factor = spectral_factor(denominator, numerator, ratio)
    at = 1j * np.geomspace(0.1, 10.0, 9)
    spectrum = np.abs(np.polyval(denominator, at)) ** 2 + ratio**2 * np.abs(np.polyval(numerator, at)) ** 2
    np.testing.assert_allclose(np.abs(np.polyval(factor, at)) ** 2, spectrum, rtol=1e-3)
    assert np.roots(factor).real.max() < 0.0


def test_a_polynomial_is_made_stable_without_a_change_of_its_gain():
    polynomial = np.poly([1.0, -2.0, 0.5 + 3.0j, 0.5 - 3.0j]).real
    stable, at = stabilised(polynomial), 1j * np.linspace(0.0, 5.0, 7)
    assert np.roots(stable).real.max() < 0.0
    np.testing.assert_allclose(np.abs(np.polyval(stable, at)), np.abs(np.polyval(polynomial, at)), rtol=1e-9)


@pytest.mark.parametrize(
    ("order", "quantities"), [(RIGID, [2.0, 5.0]), (FLEXIBLE, [0.5, 1.2, 2000.0, 2.0, 5.0])]
)
def test_quantities_and_coefficients_are_one_model(order, quantities):
    coefficients = order.coefficients(np.array(quantities))
    np.testing.assert_allclose(order.physical(coefficients), quantities, rtol=1e-12)
    both = differences(lambda values: order.physical(order.coefficients(values)), np.array(quantities))
    np.testing.assert_allclose(both, np.eye(len(quantities)), atol=1e-4)
    # at low frequency both move as their whole inertia with friction
    assert order.inertia(coefficients) > 0.0
