"""Laws of instrumental variables: what least squares is where nothing errs, and unbiased where columns do."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import kstest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.estimate.problem import ObservedProblem, Problem
from veritorque.core.estimate.system import INSTRUMENTAL, stacked, weighted
from veritorque.core.numerics.block_bootstrap import block_draws
from veritorque.core.precision.bootstrap import bootstrap
from veritorque.core.precision.endogeneity import endogeneity
from veritorque.core.precision.inference import infer
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.factor import INSTRUMENT, REGRESSOR, TARGET, Factor
from veritorque.core.regressor.memory import LaggedProducts
from veritorque.core.regressor.observe import observe
from veritorque.core.regressor.rows import InstrumentedRows
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions

TRUE = np.array([3.0, -2.0, 0.5])
GROUPS = ((INSTRUMENT, 3), (REGRESSOR, 3), (TARGET, 1))
ALL = (np.arange(3),)


@pytest.fixture(scope="module")
def plain() -> ObservedProblem:
    model = standard_model(planar_robot())
    state = swing(2)
    noise = np.random.default_rng(3).normal(size=state.position.shape) * [0.3, 0.03]
    motion = condition(
        log_of(model, true_parameters(model), state, noise), model.robot, FilterOptions(cutoff_hz=10.0)
    )
    problem = Problem(base_model(model), (motion,), frozenset({(0, 3), (0, 11)}))
    return ObservedProblem(problem, problem.observed())


def test_columns_that_are_their_own_instruments_give_least_squares_and_its_deviations(plain):
    problem = plain.problem
    rows = InstrumentedRows(problem.plan, problem.motions)
    beside = observe(problem.plan, problem.motions, held_out=problem.held_out, rows=rows)
    own = replace(plain, observation=beside, criterion=INSTRUMENTAL)
    systems = [weighted(data.factors, data.columns_of, data.size, data.criterion) for data in (plain, own)]
    least, instrumental = (system.solved() for system in systems)
    np.testing.assert_allclose(instrumental, least, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(systems[1].noise, systems[0].noise, rtol=1e-9)
    np.testing.assert_allclose(systems[1].cost(instrumental), systems[0].cost(least), rtol=1e-9)
    deviations = [
        infer(system, data.memory, data.columns_of, least).standard_deviation
        for system, data in zip(systems, (plain, own), strict=True)
    ]
    np.testing.assert_allclose(deviations[1], deviations[0], rtol=1e-6)
    draws = block_draws(len(plain.fitted), 3, 0)
    drawn = [
        bootstrap(system, data.block_factors, data.columns_of, lambda one: one.solved(), draws)
        for system, data in zip(systems, (plain, own), strict=True)
    ]
    np.testing.assert_allclose(drawn[1], drawn[0], rtol=1e-5, atol=1e-6)


def rows(rng: np.random.Generator, error: float) -> np.ndarray:
    """Draw rows [z w y] of which the columns err, and the instruments by errors of their own."""
    motion = rng.normal(size=(2000, 3)) @ np.array([[1.0, 0.3, 0.0], [0.0, 1.0, -0.4], [0.0, 0.0, 1.0]])
    columns = motion + error * rng.normal(size=motion.shape)
    instruments = motion + 0.2 * rng.normal(size=motion.shape)
    return np.column_stack([instruments, columns, motion @ TRUE + 0.5 * rng.normal(size=2000)])


def condensed(values: np.ndarray) -> tuple[tuple[Factor, ...], tuple[LaggedProducts, ...]]:
    """Give the factor and the lagged products of the rows of one joint."""
    memory = LaggedProducts.empty(7, 3).extended(values, 0, len(values))
    return (Factor.of(values, GROUPS),), (memory,)


def solved(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give the instrumental and the least-squares estimate."""
    found = weighted((Factor.of(values, GROUPS),), ALL, 3, INSTRUMENTAL)
    return found.solved(), weighted((Factor.of(values[:, 3:]),), ALL, 3).solved()


def test_instruments_with_errors_of_their_own_remove_the_bias_of_columns_that_err():
    draws = [solved(rows(np.random.default_rng(seed), 0.4)) for seed in range(40)]
    found, least = (np.array([draw[number] for draw in draws]) for number in (0, 1))
    standard_error = found.std(axis=0) / np.sqrt(len(draws))
    assert np.all(np.abs(found.mean(axis=0) - TRUE) < 4.0 * standard_error)
    assert np.all(np.abs(least.mean(axis=0) - TRUE)[:2] > 0.1)


def test_deviations_are_those_of_repeated_draws():
    listed = [rows(np.random.default_rng(100 + seed), 0.2) for seed in range(200)]
    factors, memory = condensed(listed[0])
    found = [solved(values)[0] for values in listed]
    claimed = infer(weighted(factors, ALL, 3, INSTRUMENTAL), memory, ALL, found[0]).standard_deviation
    np.testing.assert_allclose(claimed, np.std(found, axis=0), rtol=0.2)


def p_value(seed: int, error: float) -> float:
    """Test whether least squares is biased."""
    factors, memory = condensed(rows(np.random.default_rng(seed), error))
    return endogeneity(weighted(factors, ALL, 3, INSTRUMENTAL), factors, memory, ALL).p_value


def test_the_chance_that_columns_do_not_err_is_uniform_where_they_do_not_and_none_where_they_do():
    assert kstest([p_value(seed, 0.0) for seed in range(200)], "uniform").pvalue > 0.01
    assert max(p_value(seed, 0.3) for seed in range(20)) < 1e-3


def test_factors_of_three_groups_merge_in_any_order():
    values = rows(np.random.default_rng(5), 0.3)
    parts = [Factor.of(part, GROUPS) for part in np.array_split(values, 5)]
    noise = np.ones(1)
    first, second = (
        stacked((one.merged(*others),), ALL, 3, noise, INSTRUMENTAL) for one, *others in (parts, parts[::-1])
    )
    np.testing.assert_allclose(first.solved(), second.solved(), rtol=1e-10)
    np.testing.assert_allclose(first.rest, second.rest, rtol=1e-10)


def test_a_column_that_nothing_excites_makes_no_instrument_weak():
    values = rows(np.random.default_rng(6), 0.0)
    values[:, [2, 5]] = 0.0
    factors, memory = condensed(values)
    told = endogeneity(weighted(factors, ALL, 3, INSTRUMENTAL), factors, memory, ALL)
    assert told.weakest > 0.9
    values[:, 1] = np.random.default_rng(7).normal(size=len(values))
    factors, memory = condensed(values)
    told = endogeneity(weighted(factors, ALL, 3, INSTRUMENTAL), factors, memory, ALL)
    assert told.weakest < 0.1
