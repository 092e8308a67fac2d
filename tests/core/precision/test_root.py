"""Hold the rows that stand for a precision to the covariance that it states."""

import numpy as np
import pytest

from veritorque.core.document.model.reference import read_factor, write_factor
from veritorque.core.precision.inference import Inference


def precision(columns: int, *, excited: int) -> Inference:
    """Make W'W and W'V W of rows that leave some combinations of the columns at zero."""
    rng = np.random.default_rng(columns)
    rows = rng.normal(size=(200, excited)) @ rng.normal(size=(excited, columns))
    weights = rng.uniform(0.2, 5.0, 200)
    return Inference(rows.T @ rows, (rows.T * weights) @ rows, np.zeros(columns), np.ones(1))


def test_rows_turn_the_covariance_into_that_of_independent_errors():
    found = precision(6, excited=6)
    np.testing.assert_allclose(found.root @ found.covariance @ found.root.T, np.eye(6), atol=1e-9)


@pytest.mark.parametrize("excited", [1, 3, 5])
def test_rows_tell_nothing_of_what_the_motion_leaves_open(excited):
    found = precision(6, excited=excited)
    closed = np.linalg.eigh(found.information)[1][:, : 6 - excited]
    assert np.abs(found.root @ closed).max() < 1e-6 * np.abs(found.root).max()
    assert np.linalg.matrix_rank(found.root, tol=1e-6 * np.abs(found.root).max()) == excited


@pytest.mark.parametrize("excited", [2, 6])
def test_rows_come_back_from_a_document_as_they_were(excited):
    rows = precision(6, excited=excited).root
    np.testing.assert_array_equal(read_factor(write_factor(rows), 6), np.triu(rows))
    np.testing.assert_allclose(np.tril(rows, -1), 0.0, atol=1e-12 * np.abs(rows).max())
