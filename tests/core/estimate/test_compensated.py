"""Laws of compensated least squares: wls where nothing errs, no bias where columns do, and a refusal."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.sticking_arm import QUIET, scene
from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import ExcitationError
from veritorque.core.estimate.compensation import Compensated
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.estimate.methods.wls import joint_equations
from veritorque.core.estimate.problem import ObservedProblem, Problem
from veritorque.core.estimate.system import joint_noise, stacked, weighted
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.precision.bootstrap import bootstrap
from veritorque.core.precision.inference import infer
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.factor import Factor
from veritorque.core.regressor.memory import LaggedProducts
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.study import IdentifyRequest, identify_in_full

TRUE = np.array([3.0, -2.0, 0.5])
ALL = (np.arange(3),)
ROWS = 2000
ONE = np.ones(1)


def observed(scale: float) -> ObservedProblem:
    """Observe a swing of which every torque is scaled."""
    model = standard_model(planar_robot())
    state = swing(2)
    rng = np.random.default_rng(3)
    noise = rng.normal(size=state.position.shape) * [0.3, 0.03]
    rows = whole_rows(log_of(model, true_parameters(model), state, noise))
    position = rows.position + 1e-4 * rng.normal(size=rows.position.shape)
    log = log_from_arrays("swing", rows.time, position, scale * rows.torque)
    motion = condition(log, model.robot, FilterOptions(cutoff_hz=20.0))
    problem = Problem(base_model(model), (motion,), frozenset({(0, 3), (0, 11)}))
    return ObservedProblem(problem, problem.observed())


@pytest.fixture(scope="module")
def data() -> ObservedProblem:
    return observed(1.0)


def test_without_noise_of_positions_it_is_weighted_least_squares_on_the_same_rows(data):
    motion = data.problem.motions[0]
    clean = replace(motion, recipe=replace(motion.recipe, position_noise=np.zeros(2)))
    own = replace(data, problem=replace(data.problem, motions=(clean,)))
    step = ESTIMATORS["tls"].equations(None, own)
    least = joint_equations(replace(own, weights=step.data.reversal_weights)).system
    np.testing.assert_allclose(step.system.solved(), least.solved(), rtol=1e-9)
    np.testing.assert_allclose(step.system.noise, least.noise, rtol=1e-9)
    np.testing.assert_allclose(
        step.system.cost(TRUE[0] * least.solved()), least.cost(TRUE[0] * least.solved())
    )


def test_without_noise_of_positions_the_joint_rows_of_an_instant_are_not_combined(data):
    motion = data.problem.motions[0]
    clean = replace(motion, recipe=replace(motion.recipe, position_noise=np.zeros(2)))
    own = replace(data, problem=replace(data.problem, motions=(clean,)))
    least, likely = (ESTIMATORS[name].equations(None, own).system.solved() for name in ("tls", "ml"))
    np.testing.assert_allclose(likely, least, rtol=1e-9)


def test_rows_beside_reversals_are_left_out_unless_most_rows_are_such(data):
    swapped = tuple(
        replace(block, moving=block.turning, turning=block.moving) for block in data.observation.blocks
    )
    mostly = replace(data, observation=replace(data.observation, blocks=swapped))
    np.testing.assert_array_equal(data.compensated().reversal_weights, 0.0)
    assert mostly.compensated().reversal_weights[0] == 1.0


def rows(seed: int, error: float) -> np.ndarray:
    """Draw rows [w y] whose columns err."""
    rng = np.random.default_rng(seed)
    motion = rng.normal(size=(ROWS, 3)) @ np.array([[1.0, 0.3, 0.0], [0.0, 1.0, -0.4], [0.0, 0.0, 1.0]])
    columns = motion + error * rng.normal(size=motion.shape)
    return np.column_stack([columns, motion @ TRUE + 0.5 * rng.normal(size=ROWS)])


def system(values: np.ndarray, error: float):
    noisy = Compensated(ROWS * error**2 * np.eye(3)[None])
    factors = (Factor.of(values),)
    return stacked(factors, ALL, 3, joint_noise(factors, ALL, TRUE), noisy)


def test_it_has_no_bias_where_least_squares_has_one():
    found = np.array([system(rows(seed, 0.4), 0.4).solved() for seed in range(40)])
    least = np.array([weighted((Factor.of(rows(seed, 0.4)),), ALL, 3).solved() for seed in range(40)])
    assert np.all(np.abs(found.mean(axis=0) - TRUE) < 4.0 * found.std(axis=0) / np.sqrt(len(found)))
    assert np.all(np.abs(least.mean(axis=0) - TRUE)[:2] > 0.1)


def test_deviations_are_those_of_repeated_draws():
    listed = [rows(100 + seed, 0.2) for seed in range(200)]
    found = [system(values, 0.2).solved() for values in listed]
    memory = (LaggedProducts.empty(4).extended(listed[0], 0, ROWS),)
    claimed = infer(system(listed[0], 0.2), memory, ALL, found[0]).standard_deviation
    np.testing.assert_allclose(claimed, np.std(found, axis=0), rtol=0.25)


def test_a_draw_of_every_block_once_is_the_fit_itself():
    values = rows(1, 0.3)
    own = system(values, 0.3)
    blocks = tuple((Factor.of(part),) for part in np.array_split(values, 5))
    drawn = bootstrap(own, blocks, ALL, lambda one: one.solved(), np.arange(5)[None])
    np.testing.assert_allclose(drawn[0], own.solved(), rtol=1e-9)


def test_order_of_joints_and_of_parameters_does_not_matter():
    parts = [rows(seed, 0.3) for seed in (1, 2)]
    products = ROWS * 0.09 * np.stack([np.eye(3), np.eye(3)])
    noise, turned = np.array([0.5, 2.0]), np.array([2, 0, 1])
    first = stacked(tuple(map(Factor.of, parts)), 2 * ALL, 3, noise, Compensated(products))
    swapped = tuple(Factor.of(part[:, [*turned, 3]]) for part in parts[::-1])
    second = stacked(swapped, 2 * ALL, 3, noise[::-1], Compensated(products))
    np.testing.assert_allclose(second.solved(), first.solved()[turned], rtol=1e-9)


def test_noise_that_exceeds_excitation_is_refused_and_not_clipped():
    with pytest.raises(ExcitationError, match="noise exceeds excitation"):
        system(rows(1, 0.2), 1.2)


@pytest.mark.parametrize("name", ["tls", "ml"])
def test_torque_in_another_unit_scales_the_parameters(name, data):
    own, scaled = (ESTIMATORS[name].equations(None, one).system for one in (data, observed(7.0)))
    np.testing.assert_allclose(scaled.solved(), 7.0 * own.solved(), rtol=1e-7)
    np.testing.assert_allclose(scaled.noise, 7.0 * own.noise, rtol=1e-7)


def test_it_removes_most_of_the_bias_of_a_wide_band_and_does_no_harm_in_a_quiet_one():
    own = scene("planar-2")
    wide = {"filter": {"cutoff_hz": 40.0}}
    for noise, options, share in ((1e-2, wide, 0.3), (1e-3, {}, 1.1)):
        log = own.log(noise, QUIET, 0)
        least, found = (own.error(own.estimated(log, name, options)) for name in ("sdp", "tls"))
        assert found < share * least


def test_joint_rows_of_an_instant_weighted_together_predict_better_where_joints_are_coupled():
    own = scene("ur10e")
    errors = {
        name: [own.error(own.estimated(own.log(1e-2, QUIET, seed), name, {})) for seed in range(4)]
        for name in ("tls", "ml")
    }
    assert np.mean(errors["ml"]) < 0.85 * np.mean(errors["tls"])


def test_positions_that_are_noise_are_refused_with_what_would_do():
    own = scene("planar-2")
    asked = {"estimator": "tls", "filter": {"cutoff_hz": 150.0}}
    with pytest.raises(ExcitationError, match="noise exceeds excitation") as refused:
        identify_in_full(IdentifyRequest(own.world.arm.robot, (own.log(0.3, QUIET, 0),), asked))
    assert "cutoff_hz" in refused.value.remedy
