"""Lagged products are the sums they stand for, however the rows are cut."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.regressor.memory import LaggedProducts

LAGS = LaggedProducts.LAGS


def _direct(rows: np.ndarray) -> np.ndarray:
    return np.array(
        [
            sum((np.outer(rows[t], rows[t + lag]) for t in range(len(rows) - lag)), np.zeros((3, 3)))
            for lag in range(LAGS + 1)
        ]
    )


@given(st.integers(0, 2**32 - 1), st.lists(st.integers(0, 30), min_size=1, max_size=8))
def test_products_equal_the_direct_sums_however_the_rows_are_cut(seed, lengths):
    rows = np.random.default_rng(seed).normal(size=(sum(lengths), 3))
    memory, done = LaggedProducts.empty(3), 0
    for length in lengths:
        known = min(done, LAGS)
        memory = memory.extended(rows[done - known : done + length], known, length)
        done += length
    assert memory.rows == len(rows)
    assert np.allclose(memory.products, _direct(rows), rtol=0.0, atol=1e-11)


def test_joining_two_stretches_adds_their_products_and_nothing_across():
    one, other = np.random.default_rng(1).normal(size=(2, 40, 3))
    joined = LaggedProducts.empty(3).extended(one, 0, 40)
    joined = joined.merged(LaggedProducts.empty(3).extended(other, 0, 40))
    assert np.allclose(joined.products, _direct(one) + _direct(other), atol=1e-11)
    assert joined.rows == 80


def test_the_autocovariance_is_that_of_the_residual():
    rows = np.random.default_rng(2).normal(size=(100, 3))
    parameters = np.array([0.7, -2.0])
    memory = LaggedProducts.empty(3).extended(rows, 0, 100)
    rest = rows[:, -1] - rows[:, :-1] @ parameters
    expected = [rest[: len(rest) - lag] @ rest[lag:] for lag in range(LAGS + 1)]
    assert np.allclose(memory.autocovariance(parameters), expected, atol=1e-10)


@pytest.mark.parametrize("width", [1, 2, 5, LAGS + 1])
def test_the_spread_is_that_of_a_toeplitz_covariance_with_a_triangular_taper(width):
    rows = np.random.default_rng(3).normal(size=(60, 3))
    correlation = 0.8 ** np.arange(width)
    taper = np.zeros(60)
    taper[:width] = correlation * (1.0 - np.arange(width) / width)
    lag = np.abs(np.subtract.outer(np.arange(60), np.arange(60)))
    memory = LaggedProducts.empty(3).extended(rows, 0, 60)
    W = rows[:, :-1]
    assert np.allclose(memory.spread(correlation), W.T @ taper[lag] @ W, atol=1e-10)
