"""Hold generalised least squares on whitened rows to the same fit written with dense matrices."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csr_array

from tests.core.diagnosis.regression.gls_world import BASE, FREE, NOISE, Equations, smooth
from veritorque.core.diagnosis.regression.gls import fit, noise_absorbs_effect, refit
from veritorque.core.diagnosis.regression.rows import rows_of_joints

CLOSE = 1e-6
"""The ridge of 1e-10 of a column's own square, times the condition of the columns."""


@pytest.fixture(scope="module")
def equations() -> Equations:
    return Equations()


def dense_fit(columns: np.ndarray, torque: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, ...]:
    """Give parameters, their covariance, and the logarithm of the density up to the usual constant."""
    factor = cho_factor(covariance, lower=True)
    gram = columns.T @ cho_solve(factor, columns)
    values = np.linalg.solve(gram, columns.T @ cho_solve(factor, torque))
    left = torque - columns @ values
    log_density = -0.5 * left @ cho_solve(factor, left) - np.sum(np.log(np.diag(factor[0])))
    return values, np.linalg.solve(gram, np.eye(len(gram))), log_density


def test_a_fit_under_known_noise_is_the_generalised_least_squares_of_dense_matrices(equations):
    """Free columns are in the dense fit with parameters of their own, and not in ours at all."""
    found = fit(equations.joints, NOISE, rounds=0)
    values, covariance, log_density = dense_fit(*equations.dense())
    base = slice(0, len(BASE))
    np.testing.assert_allclose(found.values, values[base], rtol=CLOSE)
    np.testing.assert_allclose(found.covariance, covariance[base, base], rtol=CLOSE, atol=CLOSE * 1e-6)
    assert found.log_likelihood == pytest.approx(log_density, rel=1e-9)


def test_what_free_columns_can_stand_for_does_not_reach_the_parameters(equations):
    other = Equations()
    other.dataset.torque[:, 1] += other.nuisance @ np.array([1e3, -1e3, 1e3])
    moved = fit(other.again(), NOISE, rounds=0)
    np.testing.assert_allclose(moved.values, fit(equations.joints, NOISE, rounds=0).values, rtol=1e-8)


def test_what_a_model_has_at_rest_does_not_change_how_likely_it_is():
    """However large it is, and however alike the columns are that stand for friction at rest."""
    rows = Equations(free=2)
    apart = 1e-3 * rows.nuisance[:, 1]
    rows.nuisance[:, 1] = rows.nuisance[:, 0] + apart
    alike = replace(
        rows.dataset, sticking=(rows.dataset.sticking[0], csr_array(rows.nuisance), rows.dataset.sticking[2])
    )
    at_rest = 3e5 * apart[:, None] * np.random.default_rng(7).normal(size=len(BASE))
    heavy = (rows.base[0], rows.base[1] + at_rest, rows.base[2])
    plain, resting = (
        fit(rows_of_joints(alike, base, rows.mask), NOISE, rounds=0) for base in (rows.base, heavy)
    )
    assert resting.log_likelihood == pytest.approx(plain.log_likelihood, abs=1.0)


def test_a_column_of_rounding_has_no_coefficient(equations):
    """On the one joint that moves, another joint's parameter may be 1e-17 of what it is on its own."""
    rounding = {0: 1e-17 * smooth(np.random.default_rng(9), equations.count, 1)}
    found, plain = (
        fit(joints, NOISE, rounds=0) for joints in (equations.with_columns(rounding), equations.joints)
    )
    assert found.values[-1] == 0.0
    np.testing.assert_allclose(found.values[:-1], plain.values, rtol=CLOSE)


def test_a_candidate_fitted_on_top_is_the_dense_fit_with_its_column(equations):
    column = {1: smooth(np.random.default_rng(9), equations.count, 2)}
    found = fit(equations.with_columns(column), NOISE, rounds=0)
    values, covariance, _ = dense_fit(*equations.dense(column))
    np.testing.assert_allclose(found.values, values[:-FREE], rtol=CLOSE)
    np.testing.assert_allclose(found.covariance, covariance[:-FREE, :-FREE], rtol=CLOSE, atol=1e-12)


def test_fitting_only_the_joints_that_a_column_touches_is_fitting_all_of_them(equations):
    column = {1: smooth(np.random.default_rng(10), equations.count, 1)}
    rows = equations.with_columns(column)
    before = fit(equations.joints, NOISE, rounds=0)
    part, whole = refit(rows, before, len(BASE), frozenset({1}), rounds=0), fit(rows, NOISE, rounds=0)
    np.testing.assert_allclose(part.values, whole.values, rtol=1e-9)
    assert part.log_likelihood == pytest.approx(whole.log_likelihood, rel=1e-12)


def test_columns_that_take_the_place_of_others_are_fitted_as_if_those_had_never_been(equations):
    rng = np.random.default_rng(12)
    first, second = (equations.with_columns({1: smooth(rng, equations.count, 1)}) for _ in range(2))
    swapped = refit(second, fit(first, NOISE, rounds=0), len(BASE), rounds=0)
    plain = fit(second, NOISE, rounds=0)
    np.testing.assert_allclose(swapped.values, plain.values, rtol=1e-9)
    assert swapped.log_likelihood == pytest.approx(plain.log_likelihood, rel=1e-12)


def test_a_fit_that_begins_with_the_noise_of_another_ends_with_its_own():
    rng = np.random.default_rng(13)
    shape = smooth(rng, Equations().count, 1)
    effect = np.zeros((len(shape), 3))
    effect[:, 0] = 3.0 * shape[:, 0]
    equations = Equations(effect=effect)
    rows = equations.with_columns({0: shape})
    found, alone = refit(rows, fit(equations.joints), len(BASE)), fit(rows)
    assert found.log_likelihood == pytest.approx(alone.log_likelihood, abs=0.3)
    np.testing.assert_allclose(
        found.values, alone.values, atol=0.1 * np.sqrt(np.diag(alone.covariance)).min()
    )


@pytest.mark.parametrize("ordinary", [False, True])
def test_the_noise_that_a_fit_learns_is_the_noise_that_is_there(equations, ordinary):
    found = fit(equations.joints, ordinary=ordinary)
    for joint, noise in zip(found.joints, NOISE, strict=True):
        assert joint.noise.deviations[-1] == pytest.approx(noise.deviations[-1], rel=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_noise_beside_friction_at_rest_is_learned_as_that_noise_would_have_it(seed):
    """Taken out row by row, as if noise were white, friction leaves more than the innovations there are."""
    found = fit(Equations(seed).with_rests())
    for joint, left, noise in zip(found.joints, found.left, NOISE, strict=True):
        assert joint.noise.deviations[-1] == pytest.approx(noise.deviations[-1], rel=0.1)
        taken = joint.nuisance.count + len(BASE) / len(NOISE)
        assert left @ left == pytest.approx(len(left) - taken, rel=0.05)


@pytest.mark.parametrize("ordinary", [False, True])
def test_parameters_scatter_as_their_covariance_says(ordinary):
    scores = []
    for seed in range(40):
        equations = Equations(seed)
        found = fit(equations.joints, ordinary=ordinary)
        scores.append((found.values - BASE) / np.sqrt(np.diag(found.covariance)))
    # 160 scores of unit variance: their mean square is known to 11 %.
    assert np.mean(np.square(scores)) == pytest.approx(1.0, abs=0.34)


def test_a_fit_of_what_is_there_leaves_the_noise_no_more_than_an_ordinary_one(equations):
    assert not noise_absorbs_effect(equations.joints, fit(equations.joints))


@pytest.mark.parametrize("ordinary", [False, True])
def test_the_noise_is_learned_anew_where_a_column_takes_an_effect_away(ordinary):
    """An autoregression that was learned with the effect in it takes the effect for noise."""
    rng = np.random.default_rng(11)
    shape = smooth(rng, Equations().count, 1)
    effect = np.zeros((len(shape), 3))
    effect[:, 0] = 3.0 * shape[:, 0]
    equations = Equations(effect=effect)
    before = fit(equations.joints, ordinary=ordinary)
    after = refit(equations.with_columns({0: shape}), before, len(BASE), frozenset({0}))
    assert before.joints[0].noise.deviations[-1] > 1.2
    assert after.joints[0].noise.deviations[-1] == pytest.approx(1.0, abs=0.1)
    assert after.values[-1] == pytest.approx(3.0, abs=0.3)
