"""Short events are found where they are and nowhere else, under any correlated noise."""

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

from tests.core.diagnosis.processes import (
    SLOW,
    WAVY,
    WHITE,
    autocovariance,
    dense_covariance,
    drawn,
    exact_noise,
)
from tests.core.diagnosis.scenes import SHOVE, eventful_scene
from veritorque.core.diagnosis.causes.shared.events import find_events
from veritorque.core.diagnosis.regression.ar_noise import run_indices
from veritorque.core.diagnosis.regression.innovation_covariance import (
    fitted_rows,
    inverse_covariances,
    torque_residual,
)
from veritorque.core.dynamics.terms.external_contact import half_sine

TIME = np.arange(0.0, 30.0, 0.02)
PLACE = np.arange(len(TIME))
PUSHES = (((4.0, 4.6), (12.0, 0.0)), ((20.0, 21.0), (-9.0, 15.0)))
"""Spans, s, and their peaks over the noise's deviation: large enough for their ends to be well known."""


def found_in(weights, left):
    """Find events on two joints under noise of the same kind, each of which has its own column."""
    columns = np.tile(np.eye(2), (len(TIME), 1, 1))
    white = exact_noise(weights).whitening(PLACE)
    return sorted(find_events(TIME, columns, left, [csr_array(white.T @ white)] * 2, most=5))


@pytest.mark.parametrize("weights", [WHITE, SLOW, WAVY])
def test_events_are_found_where_they_are_and_nothing_else_is(weights):
    left = drawn(weights, np.random.default_rng(0), len(TIME), 2)
    assert found_in(weights, left) == []
    for span, push in PUSHES:
        left += np.sqrt(autocovariance(weights, 1)) * half_sine(TIME, span)[:, None] * np.array(push)
    np.testing.assert_allclose(found_in(weights, left), [span for span, _ in PUSHES], atol=0.1)


@pytest.mark.parametrize("weights", [WHITE, SLOW, WAVY])
def test_a_span_reaches_as_far_as_its_noise_allows(weights):
    """The square that it explains under the noise's dense covariance decides, and nothing else."""
    span = (4.0, 4.6)
    shape = half_sine(TIME, span)[100:400]
    square = shape @ np.linalg.solve(dense_covariance(weights, PLACE[100:400]), shape)
    for worth, expected in ((26.0, 0), (36.0, 1)):
        left = np.zeros((len(TIME), 2))
        left[:, 0] = np.sqrt(worth / square) * half_sine(TIME, span)
        assert len(found_in(weights, left)) == expected


def test_of_spans_with_the_same_score_rounding_does_not_choose():
    """Where a single row has weight, every span with it explains all of it."""
    columns, seen = np.tile(np.eye(2), (len(TIME), 1, 1)), np.zeros(len(TIME))
    seen[600] = 1.0
    rng, left = np.random.default_rng(1), np.zeros((len(TIME), 2))
    found = set()
    for _ in range(20):
        left[600] = (10.0, -3.0) * (1.0 + 1e-14 * rng.normal(size=2))
        found.add(tuple(find_events(TIME, columns, left, [diags_array(seen).tocsr()] * 2, most=1)))
    assert len(found) == 1


def test_noise_that_is_large_for_a_while_by_itself_is_hardly_ever_an_event():
    """The false alarm probability is one in a thousand logs; shifting and stretching may find a few times
    that."""
    rng = np.random.default_rng(0)
    found = [found_in((0.98,), drawn((0.98,), rng, len(TIME), 2)) for _ in range(60)]
    assert sum(map(bool, found)) <= 3


def test_slow_noise_is_not_taken_for_fast_noise_because_some_of_it_is_small():
    dataset, mask = eventful_scene().dataset, fitted_rows(eventful_scene().dataset)
    left = drawn((0.98,), np.random.default_rng(1), len(dataset.time), dataset.joints)
    for joint, found in enumerate(inverse_covariances(dataset, left, mask)):
        rows = np.flatnonzero(mask[:, joint])
        white = exact_noise((0.98,)).whitening(run_indices(dataset.follows(rows)))
        for span in ((1.0, 4.0), (5.0, 8.0)):
            shape = half_sine(dataset.time, span)
            exact = float(np.sum((white @ shape[rows]) ** 2))
            assert 0.4 * exact < shape @ found @ shape < 2.5 * exact


def test_a_channel_that_is_dead_leaves_finite_weights():
    dataset, mask = eventful_scene().dataset, fitted_rows(eventful_scene().dataset)
    left = np.random.default_rng(2).normal(size=dataset.torque.shape)
    left[:, 1] = 0.0
    assert all(np.isfinite(one.data).all() for one in inverse_covariances(dataset, left, mask))


def test_the_noise_of_a_residual_does_not_contain_a_single_event():
    dataset, operating_point = eventful_scene().dataset, eventful_scene().operating_point
    left, mask = torque_residual(dataset, operating_point), fitted_rows(dataset)
    found = inverse_covariances(dataset, left, mask)
    pushed = (dataset.time > SHOVE[0]) & (dataset.time < SHOVE[1])
    calm = left - np.where(pushed[:, None], left, 0.0)
    for joint, (one, other) in enumerate(zip(found, inverse_covariances(dataset, calm, mask), strict=True)):
        assert not one[~mask[:, joint]].count_nonzero()
        ratio = one.diagonal()[mask[:, joint]] / other.diagonal()[mask[:, joint]]
        assert np.all((ratio > 0.5) & (ratio < 2.0))
