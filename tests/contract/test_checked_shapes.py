"""Shapes are checked in the first calls of a function in every test, and in those of every case of a law."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jaxtyping import Float, TypeCheckError

from tests.shapes import CALLS, first_calls
from veritorque.core.robot.inertia import mass_properties, pseudo_inertia

BODY = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0])


@pytest.mark.parametrize("function", [mass_properties, pseudo_inertia])
def test_a_wrong_shape_is_refused_in_the_first_calls_of_every_test(function):
    for _ in range(2 * CALLS):
        function(BODY)
    for one in (mass_properties, pseudo_inertia):
        if one is not function:
            with pytest.raises(TypeCheckError):
                one(BODY[:9])


@settings(max_examples=2 * CALLS)
@given(st.integers(1, 9))
def test_a_wrong_shape_is_refused_in_every_case_of_a_law(size):
    with pytest.raises(TypeCheckError):
        mass_properties(BODY[:size])


@first_calls
def square(row: Float[np.ndarray, "n"], excess: int = 0) -> Float[np.ndarray, "n n"]:
    return np.zeros((len(row) + excess, len(row)))


def test_a_result_whose_size_is_not_that_of_the_arguments_is_refused():
    assert square(np.ones(3)).shape == (3, 3)
    with pytest.raises(TypeCheckError, match="return value"):
        square(np.ones(3), 1)


def test_it_is_said_which_argument_was_refused():
    with pytest.raises(TypeCheckError, match="parameter 'row'"):
        square(np.ones((3, 3)))


def test_a_function_inside_another_is_checked_in_its_first_calls_however_often_it_is_defined():
    def defined():
        @first_calls
        def inner(row: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n n"]:
            return np.zeros((len(row), len(row) + 1))

        return inner

    for _ in range(CALLS):
        with pytest.raises(TypeCheckError):
            defined()(np.ones(3))
    assert defined()(np.ones(3)).shape == (3, 4)
