"""Hold the banded way of taking columns out of rows to dense projections."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from tests.core.diagnosis.processes import SLOW, exact_noise
from veritorque.core.diagnosis.regression.ar_noise import run_indices
from veritorque.core.diagnosis.regression.nuisance import (
    independent_columns,
    independent_nuisance,
    nuisance_of,
)
from veritorque.core.numerics.short_columns import short_columns

ROWS = 300


def bumps(count: int, *, width: int = 20, seed: int = 0) -> np.ndarray:
    """Put groups of three filtered polynomials, of any size, every so many rows: neighbours overlap."""
    rng = np.random.default_rng(seed)
    out = np.zeros((ROWS, 3 * count))
    for group, start in enumerate(np.linspace(0, ROWS - width, count).astype(int)):
        shape = (
            np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, width), 2) * np.hanning(width)[:, None]
        )
        out[start : start + width, 3 * group : 3 * group + 3] = shape * 10.0 ** rng.uniform(-3, 3, 3)
    return out


def dense_remainder(columns: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Take the span of columns out by their singular vectors."""
    left, sizes, _ = np.linalg.svd(columns / np.linalg.norm(columns, axis=0), full_matrices=False)
    basis = left[:, sizes > 1e-7 * sizes[0]]
    return rows - basis @ (basis.T @ rows)


@pytest.mark.parametrize("count", [1, 12, 25])
def test_what_is_left_is_what_a_dense_projection_leaves(count):
    columns = bumps(count)
    rows = np.random.default_rng(1).normal(size=(ROWS, 4))
    found = independent_nuisance(csr_array(columns)).without_nuisance(rows)
    np.testing.assert_allclose(found, dense_remainder(columns, rows), atol=1e-9)


def test_combinations_of_free_columns_vanish_whatever_their_size():
    columns = bumps(20)
    rows = columns @ np.random.default_rng(2).normal(size=(columns.shape[1], 3))
    left = independent_nuisance(csr_array(columns)).without_nuisance(rows)
    assert np.abs(left).max() < 1e-9 * np.abs(rows).max()


def test_columns_that_others_span_are_dropped_and_the_span_stays():
    columns = bumps(12)
    repeated = np.hstack([columns[:, :20], columns[:, 10:20] @ np.ones((10, 1)), columns[:, 15:]])
    kept = independent_columns(csr_array(repeated))
    assert kept.shape[1] == columns.shape[1]
    rows = np.random.default_rng(3).normal(size=(ROWS, 2))
    np.testing.assert_allclose(
        nuisance_of(short_columns(kept)).without_nuisance(rows), dense_remainder(columns, rows), atol=1e-9
    )


def test_independent_columns_all_stay():
    columns = bumps(12)
    np.testing.assert_array_equal(independent_columns(csr_array(columns)).toarray(), columns)


def test_rounding_does_not_decide_which_columns_are_independent():
    columns, rows = _fading(18), np.random.default_rng(5).normal(size=(ROWS, 4))
    rounded = columns * (1.0 + 2e-16 * np.random.default_rng(6).standard_normal(columns.shape))
    left, again = (independent_nuisance(csr_array(one)).without_nuisance(rows) for one in (columns, rounded))
    np.testing.assert_allclose(left, again, atol=1e-9)


def _fading(count: int, *, shapes: int = 9, width: int = 20, smooth: float = 4.0) -> np.ndarray:
    """Put equal groups of polynomials, of which a low pass leaves ever less, every so many rows."""
    place = np.arange(width)
    low_pass = np.exp(-0.5 * ((place[:, None] - place) / smooth) ** 2)
    window = np.hanning(width)[:, None]
    group = low_pass @ (np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, width), shapes - 1) * window)
    out = np.zeros((ROWS, shapes * count))
    for number, start in enumerate(np.linspace(0, ROWS - width, count).astype(int)):
        out[start : start + width, shapes * number : shapes * (number + 1)] = group
    return out


@pytest.mark.parametrize("count", [1, 12, 25])
def test_products_less_those_of_the_parts_inside_are_products_of_what_is_left(count):
    free = independent_nuisance(csr_array(bumps(count)))
    rows = np.random.default_rng(4).normal(size=(ROWS, 4))
    inside = free.in_span(rows)
    left = free.without_nuisance(rows)
    np.testing.assert_allclose(rows.T @ rows - inside.T @ inside, left.T @ left, atol=1e-6)
    assert free.in_span(rows[:, :0]).shape == (free.count, 0)


@pytest.mark.parametrize(
    "columns", [np.zeros((ROWS, 0)), np.full((ROWS, 2), 1e-9)], ids=["none", "elsewhere"]
)
def test_nothing_is_taken_where_no_column_acts(columns):
    rows = np.ones((ROWS, 2))
    free = independent_nuisance(csr_array(columns))
    assert free.count == 0
    np.testing.assert_array_equal(free.without_nuisance(rows), rows)


def test_whitening_short_columns_sparsely_is_whitening_them():
    place = run_indices(np.arange(ROWS) % 70 > 0)
    noise, columns = exact_noise(SLOW), bumps(9)
    sparse = noise.whitening(place) @ csr_array(columns)
    np.testing.assert_allclose(sparse.toarray(), noise.whitened(columns, place), atol=1e-9)
    assert sparse.nnz < 0.2 * columns.size
