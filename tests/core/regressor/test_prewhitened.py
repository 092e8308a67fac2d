"""Laws of prewhitened rows: errors are white from the first row of a run on, and equations stay true."""

import numpy as np
from scipy.signal import lfilter

from veritorque.core.regressor.prewhitened import predictors, prewhitened

COEFFICIENTS = np.array([1.6, -0.8])
DRAWS, ROWS = 4000, 60
ONE_BLOCK = np.zeros(ROWS, dtype=int)
ALL = np.ones(ROWS, dtype=bool)


def drawn() -> np.ndarray:
    """Draw errors of a stationary autoregression, a column each."""
    noise = np.random.default_rng(1).normal(size=(300 + ROWS, DRAWS))
    return lfilter([1.0], np.append(1.0, -COEFFICIENTS), noise, axis=0)[300:]


def autocovariance(order: int) -> np.ndarray:
    response = lfilter([1.0], np.append(1.0, -COEFFICIENTS), np.eye(1, 2000)[0])
    return np.array([response[: len(response) - lag] @ response[lag:] for lag in range(order + 1)])


def test_predictors_are_those_of_the_autoregression_from_its_order_on():
    weights = predictors(autocovariance(5))
    for known in range(2, 6):
        own = weights[known] / weights[known, 0]
        np.testing.assert_allclose(own[1:3], -COEFFICIENTS, rtol=1e-5)
        np.testing.assert_allclose(own[3:], 0.0, atol=1e-5)


def test_errors_come_out_white_and_of_their_own_size_from_the_first_row_of_every_run_on():
    known = ALL.copy()
    known[[20, 21, 40]] = False
    block = np.where(np.arange(ROWS) < 30, 0, 1)
    errors = drawn()
    white = prewhitened(errors, known, block, predictors(autocovariance(4)))
    assert not white[~known].any()
    np.testing.assert_allclose(np.var(white[known], axis=1), autocovariance(0)[0], rtol=0.1)
    runs = [slice(0, 20), slice(22, 30), slice(30, 40), slice(41, 60)]
    for run in runs:
        together = np.corrcoef(white[run])
        assert np.abs(together - np.eye(len(together))).max() < 0.08


def test_rows_of_another_block_have_no_part_in_a_row():
    rows = np.random.default_rng(2).normal(size=(ROWS, 3))
    block = np.where(np.arange(ROWS) < 30, 0, 1)
    changed = rows.copy()
    changed[:30] *= 5.0
    one, other = (prewhitened(part, ALL, block, predictors(autocovariance(4))) for part in (rows, changed))
    np.testing.assert_array_equal(one[30:], other[30:])


def test_true_equations_stay_true():
    rng = np.random.default_rng(3)
    columns, parameters = rng.normal(size=(ROWS, 4)), rng.normal(size=4)
    rows = np.column_stack([columns, columns @ parameters])
    found = prewhitened(rows, rng.random(ROWS) < 0.8, ONE_BLOCK, predictors(autocovariance(6)))
    np.testing.assert_allclose(found[:, -1], found[:, :-1] @ parameters, atol=1e-12)


def test_errors_that_are_smooth_have_predictors_too():
    smooth = 1.0 - 1e-12 * np.arange(13) ** 2
    assert np.isfinite(predictors(smooth)).all()
