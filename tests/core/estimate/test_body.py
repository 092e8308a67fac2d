"""Hold the nearest body to bodies that are known, and to parameters that no body has."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tools import random_bodies
from veritorque.core.estimate.body import nearest_body
from veritorque.core.robot.inertia import from_mass_properties, pseudo_inertia

NOISE = 1e-3


@given(st.integers(0, 10**6))
def test_a_body_is_its_own_nearest_one(seed):
    body = random_bodies(np.random.default_rng(seed), 1)[0]
    found, distance = nearest_body(body, NOISE**2 * np.eye(10))
    np.testing.assert_allclose(found, body, atol=1e-6)
    assert distance < 1e-4


def test_what_was_taken_away_is_minus_a_body():
    body = random_bodies(np.random.default_rng(1), 1)[0]
    assert nearest_body(-body, NOISE**2 * np.eye(10), removed=True)[1] < 1e-4
    assert nearest_body(-body, NOISE**2 * np.eye(10))[1] > 1e3


def test_the_nearest_body_exists_and_is_no_further_than_the_one_that_noise_moved():
    rng = np.random.default_rng(2)
    body = from_mass_properties(0.1, np.array([0.05, 0.0, 0.1]), 1e-5 * np.eye(3))
    moved = 0.01 * rng.normal(size=10)
    found, distance = nearest_body(body + moved, 1e-4 * np.eye(10))
    assert np.linalg.eigvalsh(pseudo_inertia(found))[0] > -1e-6
    assert distance <= np.sum((moved / 0.01) ** 2) + 1e-3


def test_distance_is_told_in_the_deviations_that_are_known():
    """Two bars on a plane of no thickness would have to weigh nothing: inertia about x is too small by 1."""
    body = from_mass_properties(1.0, np.zeros(3), np.diag([1.0, 1.0, 2.0]))
    body[5] += 0.5
    near, far = (nearest_body(body, deviation**2 * np.eye(10))[1] for deviation in (1.0, 0.1))
    assert far == pytest.approx(100.0 * near, rel=1e-3)
    assert near > 0.01


def test_what_nothing_is_known_of_does_not_stand_against_a_body():
    body = from_mass_properties(1.0, np.zeros(3), np.diag([1.0, 1.0, 2.0]))
    body[5] += 5.0
    covariance = 1e-6 * np.eye(10)
    covariance[5, 5] = 0.0
    assert nearest_body(body, covariance)[1] < 1.0
