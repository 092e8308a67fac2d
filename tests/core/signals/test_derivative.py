"""The two local operations: what they leave alone and what they remove."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import signal

from veritorque.core.signals.derivative import (
    absurd_reach,
    differentiate,
    differentiate_throughout,
    median,
    without_absurd,
)


@given(st.lists(st.floats(-10.0, 10.0), min_size=7, max_size=7), st.floats(10.0, 5000.0))
def test_the_derivative_of_a_polynomial_of_order_six_is_exact_at_the_same_instant(coefficients, rate_hz):
    time = np.arange(40) / rate_hz
    curve = np.polynomial.Polynomial(coefficients)
    slope = differentiate(curve(time)[:, None], rate_hz)[:, 0]
    rounding = 1e-15 * rate_hz * (1.0 + np.abs(curve(time)).max())
    assert np.max(np.abs(slope - curve.deriv()(time)[3:-3])) <= 8.0 * rounding


@pytest.mark.parametrize("samples_per_period", [20.0, 27.3, 100.0])
def test_a_sine_at_a_twentieth_of_the_rate_or_below_is_differentiated_within_a_hundred_thousandth(
    samples_per_period,
):
    turn = 2.0 * np.pi / samples_per_period
    phase = turn * np.arange(400)
    velocity = differentiate(np.sin(phase)[:, None], 1.0)[:, 0]
    acceleration = differentiate(velocity[:, None], 1.0)[:, 0]
    assert np.max(np.abs(velocity - turn * np.cos(phase[3:-3]))) < 1e-5 * turn
    assert np.max(np.abs(acceleration + turn**2 * np.sin(phase[6:-6]))) < 2e-5 * turn**2


@pytest.mark.parametrize("samples", [1, 2, 3, 5, 50])
def test_a_straight_line_is_differentiated_exactly_up_to_its_ends_however_short_it_is(samples):
    line = np.arange(samples)[:, None] * np.array([2.0, -1.0])
    slope = differentiate_throughout(line, 10.0)
    expected = np.array([20.0, -10.0]) if samples > 1 else np.zeros(2)
    np.testing.assert_allclose(slope, np.broadcast_to(expected, line.shape), atol=1e-12)


@pytest.mark.parametrize("order", [3, 5, 7, 31])
def test_the_median_is_scipys_away_from_the_ends(order):
    noise = np.random.default_rng(1).normal(size=(200, 3))
    inside = slice(order // 2, len(noise) - order // 2)
    expected = np.column_stack([signal.medfilt(column, order)[inside] for column in noise.T])
    assert np.array_equal(median(noise, order), expected)


SWING = 20.0 * np.sin(np.arange(100.0) / 7.0)[:, None]


@pytest.mark.parametrize("spike", [1e6, -1e6, 100.0])
@pytest.mark.parametrize("curve", [np.arange(100.0)[:, None], SWING], ids=["ramp", "swing"])
@pytest.mark.parametrize(("order", "most"), [(3, 1), (5, 2), (9, 4)])
def test_absurd_samples_are_removed_if_they_are_fewer_than_half_of_the_median(spike, curve, order, most):
    reach = absurd_reach(order)
    for count in range(1, most + 1):
        spoilt = curve.copy()
        spoilt[50 : 50 + count] += spike
        left = without_absurd(spoilt, order) - curve[reach:-reach]
        assert np.max(np.abs(left)) <= 2.0 * most * np.abs(np.diff(curve, axis=0)).max()


@pytest.mark.parametrize("order", [3, 5, 31])
def test_what_is_not_absurd_stays_to_the_last_bit(order):
    reach = absurd_reach(order)
    kick = np.cumsum(np.cumsum(np.where(np.arange(200) < 100, 0.0, 1.0)))[:, None]
    slow = np.sin(np.arange(2000.0) / 40.0)[:, None]
    for smooth in (slow, kick):
        assert np.array_equal(without_absurd(smooth, order), smooth[reach:-reach])
    noise = np.random.default_rng(3).normal(size=(20_000, 1))
    assert np.mean(without_absurd(noise, order) == noise[reach:-reach]) > 0.96


def test_a_median_leaves_a_ramp_alone():
    ramp = np.arange(50.0)[:, None]
    assert np.array_equal(median(ramp, 5), ramp[2:-2])


def test_a_median_of_order_one_leaves_everything_alone():
    noise = np.random.default_rng(2).normal(size=(20, 2))
    assert np.array_equal(median(noise, 1), noise)
    assert np.array_equal(without_absurd(noise, 1), noise)
