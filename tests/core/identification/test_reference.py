"""Hold the prior to what it stands for: further rows, and bodies that are nearly right."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.diagnosis.regression.gls_world import BASE, NOISE, Equations, smooth
from tests.core.diagnosis.scenes import bodies_of_skew_arm, skew_arm
from veritorque.core.diagnosis.regression.gls import fit, refit
from veritorque.core.diagnosis.regression.score_test import score
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import RobotError
from veritorque.core.estimate.gaussian_prior import GaussianPrior
from veritorque.core.estimate.system import System
from veritorque.core.identification.reference import (
    PRIOR_DEVIATION,
    reference_from_prior,
    with_least_deviation,
)
from veritorque.core.reduction.base import base_model
from veritorque.core.robot.inertia import pseudo_inertia

EXACT = GaussianPrior(1e6 * np.eye(len(BASE)), 1e6 * BASE)


@pytest.fixture(scope="module")
def equations() -> Equations:
    return Equations()


@pytest.fixture(scope="module")
def base():
    return base_model(standard_model(replace(skew_arm(), prior=bodies_of_skew_arm())))


def test_a_prior_counts_like_rows_of_a_log_of_its_own(equations):
    rng = np.random.default_rng(3)
    rows, target = 10.0 * rng.normal(size=(3, len(BASE))), 10.0 * rng.normal(size=3)
    plain = fit(equations.joints, NOISE, rounds=0)
    found = fit(equations.joints, NOISE, rounds=0, prior=GaussianPrior(rows, target))
    gram, right = rows.T @ rows, rows.T @ target
    for one in plain.joints:
        gram[np.ix_(one.acting, one.acting)] += one.gram
        right[one.acting] += one.columns.T @ one.torque
    np.testing.assert_allclose(found.values, np.linalg.solve(gram, right), rtol=1e-6)
    missed = sum(float(np.sum(one.left(found.values) ** 2)) for one in plain.joints)
    missed += float(np.sum((target - rows @ found.values) ** 2))
    logs = sum(one.log_deviations for one in plain.joints)
    assert found.log_likelihood == pytest.approx(-0.5 * missed - logs, rel=1e-12)


def test_a_prior_without_deviation_is_what_is_fitted(equations):
    found = fit(equations.joints, prior=EXACT)
    np.testing.assert_allclose(found.values, BASE, rtol=1e-4)


def test_a_prior_stays_when_columns_join(equations):
    column = {1: smooth(np.random.default_rng(10), equations.count, 1)}
    before = fit(equations.joints, NOISE, rounds=0, prior=EXACT)
    rows = equations.with_columns(column)
    found = refit(rows, before, len(BASE), rounds=0)
    whole = fit(rows, NOISE, rounds=0, prior=EXACT)
    np.testing.assert_allclose(found.values, whole.values, rtol=1e-9)


def test_a_column_that_the_model_has_already_is_determined_only_where_its_coefficient_has_a_prior(equations):
    known = [{joint: one[:, :1] for joint, one in enumerate(equations.base)}]
    free, pinned = (fit(equations.joints, NOISE, rounds=0, prior=one) for one in (None, EXACT))
    assert score(free, equations.joints, known)[0].clear_share < 1e-6
    assert score(pinned, equations.joints, known)[0].clear_share > 0.9


@given(st.floats(1e-4, 1.0), st.floats(1e-4, 1.0), st.floats(0.1, 100.0))
def test_doubt_adds_to_the_variance(known, share, value):
    rows = with_least_deviation(np.array([[1.0 / known]]), np.array([value]), share)
    assert 1.0 / rows[0, 0] == pytest.approx(np.hypot(known, share * value), rel=1e-9)


def test_doubt_leaves_open_what_was_open():
    rows = with_least_deviation(np.array([[2.0, 0.0]]), np.array([1.0, 5.0]))
    assert rows[0, 1] == 0.0


def test_a_description_tells_nothing_of_friction_and_rotors(base):
    reference = reference_from_prior(base)
    names = dict(zip(base.names, range(len(base.names)), strict=True))
    open_ones = {f"{symbol}{joint}" for symbol in ("FV", "FC", "OFF") for joint in (1, 2, 3)}
    assert open_ones <= set(reference.left_open)
    for name in open_ones:
        assert np.abs(reference.rows[:, names[name]]).max() < 1e-9


def test_bodies_have_a_prior_deviation_of_a_share_of_their_own_size(base):
    """Draw pseudo-inertias whose entries are off by the stated share; their distance has unit variance."""
    rng, reference = np.random.default_rng(1), reference_from_prior(base)
    bodies = bodies_of_skew_arm()
    squares = []
    for _ in range(400):
        standard = reference.standard.copy()
        for link, body in enumerate(bodies):
            root = np.sqrt(np.diag(pseudo_inertia(body)))
            off = rng.normal(size=(4, 4)) * PRIOR_DEVIATION * np.outer(root, root)
            standard[10 * link : 10 * link + 10] += _ten(np.triu(off) + np.triu(off, 1).T)
        squares.append(reference.prior.departure(base.base_of(standard)))
    assert np.mean(squares) == pytest.approx(len(reference.rows), rel=0.1)


def _ten(matrix: np.ndarray) -> np.ndarray:
    second = matrix[:3, :3]
    inertia = np.trace(second) * np.eye(3) - second
    return np.array([*inertia[0], *inertia[1, 1:], inertia[2, 2], *matrix[:3, 3], matrix[3, 3]])


def test_what_a_reference_leaves_open_is_filled_in_from_the_log_and_nothing_else_moves(base):
    reference = reference_from_prior(base)
    size = len(base.names)
    log = System(np.eye(size), reference.values + 1.0, 0.0, 10 * size, np.ones(3))
    filled = reference.completed(log)
    np.testing.assert_allclose(reference.rows @ filled, reference.rows @ reference.values, rtol=1e-9)
    for name in ("FV1", "FC2", "OFF3"):
        row = base.names.index(name)
        assert filled[row] == pytest.approx(reference.values[row] + 1.0)


def test_a_description_without_bodies_is_no_reference():
    with pytest.raises(RobotError, match="no prior"):
        reference_from_prior(base_model(standard_model(skew_arm())))
