"""The two local operations: what they leave alone and what they remove."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import signal

from veritorque.core.signals.derivative import centred_difference, median


@given(*(st.floats(-10.0, 10.0) for _ in range(3)), st.floats(10.0, 5000.0))
def test_the_derivative_of_a_quadratic_is_exact_at_the_same_instant(zeroth, first, second, rate_hz):
    time = np.arange(40) / rate_hz
    quadratic = zeroth + first * time + second * time**2
    slope = centred_difference(quadratic[:, None], rate_hz)[:, 0]
    rounding = 1e-15 * rate_hz * (1.0 + np.abs(quadratic).max())
    assert np.max(np.abs(slope - (first + 2.0 * second * time)[1:-1])) <= 4.0 * rounding


@pytest.mark.parametrize("order", [3, 5, 7, 31])
def test_the_median_is_scipys_away_from_the_ends(order):
    noise = np.random.default_rng(1).normal(size=(200, 3))
    inside = slice(order // 2, len(noise) - order // 2)
    expected = np.column_stack([signal.medfilt(column, order)[inside] for column in noise.T])
    assert np.array_equal(median(noise, order), expected)


@pytest.mark.parametrize("spike", [1e6, -1e6])
def test_a_median_of_five_removes_one_absurd_sample_and_two_neighbouring_ones(spike):
    ramp = np.arange(50.0)[:, None]
    for absurd in ([20], [20, 21]):
        spoilt = ramp.copy()
        spoilt[absurd] = spike
        assert np.max(np.abs(median(spoilt, 5) - ramp[2:-2])) <= 2.0


def test_a_median_leaves_a_ramp_alone():
    ramp = np.arange(50.0)[:, None]
    assert np.array_equal(median(ramp, 5), ramp[2:-2])


def test_a_median_of_order_one_leaves_everything_alone():
    noise = np.random.default_rng(2).normal(size=(20, 2))
    assert np.array_equal(median(noise, 1), noise)
