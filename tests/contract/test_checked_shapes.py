"""Shapes are checked in the first calls of a function in every test, and in every call of a law."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jaxtyping import TypeCheckError

from tests.shapes import CALLS
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
def test_a_wrong_shape_is_refused_in_every_call_of_a_law(size):
    with pytest.raises(TypeCheckError):
        mass_properties(BODY[:size])
