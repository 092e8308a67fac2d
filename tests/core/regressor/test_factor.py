"""Factors are a monoid, and hold all that least squares can know. Tolerance: QR rounds to 1e-15."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.regressor.factor import Factor

COLUMNS = 5


def _gram(factor: Factor) -> np.ndarray:
    return factor.triangle.T @ factor.triangle


def _same(one: Factor, other: Factor) -> bool:
    size = max(1.0, float(np.abs(_gram(one)).max()))
    return one.rows == other.rows and bool(np.max(np.abs(_gram(one) - _gram(other))) < 1e-12 * size)


@st.composite
def _rows(draw):
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    rows = rng.normal(size=(draw(st.integers(0, 12)), COLUMNS)) * 10.0 ** rng.integers(-3, 4, COLUMNS)
    if draw(st.booleans()):
        rows[:, 2] = rows[:, 0]
    return rows


@given(_rows(), _rows(), _rows())
def test_merging_is_associative_and_commutative(a, b, c):
    first, second, third = (Factor.of(rows) for rows in (a, b, c))
    assert _same(first.merged(second).merged(third), first.merged(second.merged(third)))
    assert _same(first.merged(second), second.merged(first))


@given(_rows())
def test_no_rows_change_nothing(rows):
    factor, nothing = Factor.of(rows), Factor.empty(COLUMNS)
    assert _same(factor.merged(nothing), factor)
    assert _same(nothing.merged(factor), factor)
    assert _same(factor.extended(rows[:0]), factor)


@given(_rows(), _rows())
def test_extending_is_merging_and_both_are_the_factor_of_all_rows(a, b):
    whole = Factor.of(np.vstack([a, b]))
    assert _same(Factor.of(a).extended(b), whole)
    assert _same(Factor.of(a).merged(Factor.of(b)), whole)


@given(_rows(), _rows())
def test_a_factor_keeps_no_more_rows_than_columns_and_all_residuals(a, b):
    rows = np.vstack([a, b])
    factor = Factor.of(a).merged(Factor.of(b))
    assert len(factor.triangle) <= COLUMNS
    parameters = np.linspace(-1.0, 2.0, COLUMNS - 1)
    rest = rows[:, -1] - rows[:, :-1] @ parameters
    size = max(1.0, float((rows**2).sum()))
    assert abs(factor.residual_square(parameters) - rest @ rest) < 1e-12 * size
    assert abs(factor.torque_square - rows[:, -1] @ rows[:, -1]) < 1e-12 * size


@given(_rows(), st.floats(0.1, 10.0))
def test_weighting_all_rows_weights_the_factor(rows, weight):
    assert _same(Factor.of(rows).scaled(weight), Factor.of(rows * weight))


GROUPS = (("instrument", 2), ("regressor", 2), ("target", 1))


@given(_rows(), _rows())
def test_a_further_group_of_columns_merges_alike_and_changes_no_residual(a, b):
    rows = np.vstack([a, b])
    factor = Factor.of(a, GROUPS).merged(Factor.of(b, GROUPS))
    assert _same(factor, Factor.of(rows, GROUPS))
    size = max(1.0, float(np.abs(_gram(factor)).max()))
    instruments, regressor = (factor.columns(name) for name in ("instrument", "regressor"))
    assert np.abs(instruments.T @ regressor - rows[:, :2].T @ rows[:, 2:4]).max() < 1e-12 * size
    parameters = np.array([0.5, -2.0])
    plain = Factor.of(rows[:, 2:]).residual_square(parameters)
    assert abs(factor.residual_square(parameters) - plain) < 1e-11 * size


@given(_rows())
def test_the_groups_of_kept_columns_are_as_wide_as_what_is_kept_of_them(rows):
    kept = Factor.of(rows, GROUPS).over(np.array([0, 2, 3, 4]))
    assert kept.groups == (("instrument", 1), ("regressor", 2), ("target", 1))
    parameters = np.array([0.5, -2.0])
    whole = Factor.of(rows, GROUPS).residual_square(parameters)
    assert abs(kept.residual_square(parameters) - whole) < 1e-11 * max(1.0, float((rows**2).sum()))


def test_rows_are_not_kept_by_reference():
    rows = np.ones((2, COLUMNS))
    factor = Factor.of(rows)
    rows[:] = 7.0
    assert factor.torque_square == 2.0
