"""Hold the block bootstrap: the same seed draws the same, and its spread is the noise's."""

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import SolverError
from veritorque.core.estimate.system import weighted
from veritorque.core.numerics.block_bootstrap import block_draws
from veritorque.core.precision.bootstrap import bootstrap
from veritorque.core.precision.inference import infer
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.observe import Observation, observe
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions


@pytest.fixture(scope="module")
def seen() -> Observation:
    model = standard_model(planar_robot())
    state = swing(2, seconds=40.0)
    noise = 0.3 * np.random.default_rng(2).normal(size=state.position.shape)
    log = log_of(model, true_parameters(model), state, noise)
    motion = condition(log, model.robot, FilterOptions(cutoff_hz=10.0))
    return observe(ColumnPlan(model, base_model(model).kept), (motion,))


def _draw(seen: Observation, seed: int, solve=lambda system: system.solved(), draws: int = 200) -> np.ndarray:
    system = weighted(seen.joint_factors(), seen.columns_of, len(seen.plan.columns))
    blocks = tuple(block.factors for block in seen.blocks)
    drawn = block_draws(len(blocks), draws, seed)
    return bootstrap(system, blocks, seen.columns_of, solve, drawn)


def test_the_same_seed_draws_the_same_and_another_seed_does_not(seen):
    assert np.array_equal(_draw(seen, 5, draws=10), _draw(seen, 5, draws=10))
    assert not np.array_equal(_draw(seen, 5, draws=10), _draw(seen, 6, draws=10))


def test_the_spread_of_the_draws_is_that_of_the_covariance(seen):
    system = weighted(seen.joint_factors(), seen.columns_of, len(seen.plan.columns))
    reported = infer(system, seen.memory, seen.columns_of, system.solved()).standard_deviation
    ratio = _draw(seen, 0).std(axis=0) / reported
    # Twenty blocks tell a deviation to about a sixth, and the mean over parameters to about a twentieth.
    assert 0.7 <= np.mean(ratio) <= 1.3


def test_draws_that_have_no_accurate_optimum_are_left_out(seen):
    calls = iter(range(100))

    def solve(system):
        if next(calls) % 2:
            raise SolverError("no optimum")
        return system.solved()

    assert _draw(seen, 0, solve, draws=10).shape == (5, 13)


def test_no_draws_give_no_rows(seen):
    assert _draw(seen, 0, draws=0).shape == (0, 13)
