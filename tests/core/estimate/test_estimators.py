"""Laws of every estimator in the registry: a new one is held to them by being listed."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.estimate.methods.method import Estimator, FitData
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.estimate.problem import ObservedProblem, Problem
from veritorque.core.log.channels import CHANNELS
from veritorque.core.reduction.base import base_model
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions


@pytest.fixture(scope="module")
def data() -> ObservedProblem:
    model = standard_model(planar_robot())
    state = swing(2)
    noise = np.random.default_rng(3).normal(size=state.position.shape) * [0.3, 0.03]
    log = log_of(model, true_parameters(model), state, noise)
    motion = condition(log, model.robot, FilterOptions(cutoff_hz=10.0))
    problem = Problem(base_model(model), (motion,), frozenset({(0, 3), (0, 11)}))
    return ObservedProblem(problem, problem.observed())


@pytest.mark.parametrize("name", ESTIMATORS)
def test_an_estimator_is_called_what_it_is_listed_as_and_needs_known_channels(name):
    estimator = ESTIMATORS[name]
    assert isinstance(estimator, Estimator)
    assert estimator.name == name
    assert set(estimator.needs) <= set(CHANNELS)


@pytest.mark.parametrize("name", ESTIMATORS)
def test_the_equations_are_of_the_fitted_rows_over_all_base_parameters_and_near_the_truth(name, data):
    step = ESTIMATORS[name].equations(None, data)
    assert isinstance(step.data, FitData)
    assert step.system.triangle.shape == (data.size, data.size)
    assert step.system.rows == sum(factor.rows for factor in data.factors)
    base, model = data.problem.base, data.problem.base.model
    found, truth = step.system.solved(), base.base_of(true_parameters(model))
    missed = step.system.triangle @ (found - truth)
    assert np.linalg.norm(missed) < 0.05 * np.linalg.norm(step.system.target)


@pytest.mark.parametrize("name", [name for name, one in ESTIMATORS.items() if not one.row_weights])
def test_an_estimator_that_takes_no_row_weights_does_not_change_with_them(name, data):
    plain, robust = (ESTIMATORS[name].equations(None, one) for one in (data, replace(data, robust=True)))
    np.testing.assert_array_equal(plain.system.triangle, robust.system.triangle)


def test_ordinary_least_squares_takes_all_joints_alike(data):
    np.testing.assert_array_equal(ESTIMATORS["ols"].equations(None, data).system.noise, 1.0)


def test_the_programme_solves_the_equations_of_weighted_least_squares(data):
    feasible, plain = (ESTIMATORS[name].equations(None, data).system for name in ("sdp", "wls"))
    np.testing.assert_array_equal(feasible.triangle, plain.triangle)
    np.testing.assert_array_equal(feasible.target, plain.target)
