"""Hold products of short columns to those of whole matrices."""

import numpy as np
import pytest
from scipy.sparse import csr_array, random_array

from veritorque.core.numerics.short_columns import prewhitened, short_columns

ROWS = 60


def drawn(columns=9):
    """Draw columns in the order of time, each on some rows, and some rows without any."""
    dense = random_array((ROWS, columns), density=0.2, rng=np.random.default_rng(columns)).toarray()
    near = np.abs(np.arange(ROWS)[:, None] * columns / ROWS - np.arange(columns)) < 1.6
    return np.where(near, dense, 0.0)


def memory(order):
    """Give weights of rows by how many are known before them, and runs of which none reaches the next."""
    weights = np.tril(np.random.default_rng(order).normal(size=(order + 1, order + 1)))
    return weights, np.arange(ROWS) % 25


def as_matrix(weights, past):
    """Write the weights as one matrix over all rows."""
    out = np.zeros((ROWS, ROWS))
    for row, known in enumerate(np.minimum(past, len(weights) - 1)):
        out[row, row - np.arange(known + 1)] = weights[known, : known + 1]
    return out


def dense_of(short):
    return csr_array((short.values, short.places, short.begins), (ROWS, short.count)).toarray()


@pytest.mark.parametrize("order", [0, 1, 12])
def test_rows_are_combined_with_those_before_them_in_their_run(order):
    weights, past = memory(order)
    columns = np.random.default_rng(3).normal(size=(ROWS, 5))
    np.testing.assert_allclose(
        prewhitened(columns, past, weights), as_matrix(weights, past) @ columns, atol=1e-13
    )


@pytest.mark.parametrize("order", [0, 1, 12])
def test_short_columns_are_combined_like_others(order):
    weights, past = memory(order)
    found = short_columns(csr_array(drawn())).prewhitened(past, weights)
    np.testing.assert_allclose(dense_of(found), as_matrix(weights, past) @ drawn(), atol=1e-13)


@pytest.mark.parametrize("columns", [0, 1, 9])
def test_products_and_combinations_are_those_of_the_matrix(columns):
    dense, others = drawn(columns), np.random.default_rng(4).normal(size=(ROWS, 3))
    short = short_columns(csr_array(dense))
    np.testing.assert_allclose(short.products(others), dense.T @ others, atol=1e-13)
    np.testing.assert_allclose(short.combined(dense.T @ others), dense @ (dense.T @ others), atol=1e-13)
    np.testing.assert_allclose(short.norms(), np.linalg.norm(dense, axis=0), atol=1e-13)


def test_the_band_holds_all_products_of_columns_that_meet():
    dense = drawn() + 0.1 * (drawn() == 0.0) * np.eye(1, 9, 4)
    gram, band = dense.T @ dense, short_columns(csr_array(dense)).banded_gram()
    found = sum(np.diag(row[: 9 - lag], -lag) for lag, row in enumerate(band))
    np.testing.assert_allclose(found, np.tril(gram), atol=1e-13)
