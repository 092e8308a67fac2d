"""Hold the excitation scores to the cases that can be checked in the head."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.validation.excitation import excitation


@given(seed=st.integers(0, 1000), columns=st.integers(2, 9))
def test_an_own_share_lies_between_none_and_all_and_does_not_depend_on_units(seed, columns):
    rng = np.random.default_rng(seed)
    triangle = np.triu(rng.normal(size=(columns, columns)))
    units = np.exp(rng.uniform(-8.0, 8.0, columns))
    one, other = excitation(triangle), excitation(triangle * units)
    assert np.all((one.own_share >= 0.0) & (one.own_share <= 1.0 + 1e-12))
    np.testing.assert_allclose(one.own_share, other.own_share, atol=1e-6)


def test_orthogonal_columns_are_known_by_themselves_alone():
    found = excitation(np.diag([1.0, 20.0, 300.0]))
    np.testing.assert_allclose(found.own_share, 1.0)
    assert found.condition_number == pytest.approx(300.0)
    assert found.condition_number_scaled == pytest.approx(1.0)


def test_collinear_columns_have_nothing_of_their_own():
    found = excitation(np.array([[1.0, 2.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
    np.testing.assert_allclose(found.own_share, [0.0, 0.0, 1.0], atol=1e-11)  # rounding's floor
    assert found.condition_number == np.inf


def test_two_columns_at_sixty_degrees_keep_the_sine():
    found = excitation(np.array([[1.0, 0.5], [0.0, np.sqrt(0.75)]]))
    np.testing.assert_allclose(found.own_share, np.sqrt(0.75))


def test_a_column_that_nothing_excites_has_no_share_and_the_condition_is_infinite():
    found = excitation(np.diag([1.0, 0.0]))
    assert found.own_share.tolist() == [1.0, 0.0]
    assert found.condition_number == found.condition_number_scaled == np.inf
