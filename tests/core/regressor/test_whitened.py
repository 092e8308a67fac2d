"""Laws of combined rows: errors of unit covariance at every instant, and the expected products of noise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.column_noise import acceleration_columns
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.rows import equations
from veritorque.core.regressor.whitened import WhitenedRows
from veritorque.core.signals.condition import condition
from veritorque.core.signals.parallel import Tile
from veritorque.core.signals.recipe import FilterOptions

TORQUE, ACCELERATION, RESIDUAL = np.array([0.3, 0.05]), np.array([0.5, 0.8]), np.array([2.0, 0.4])
DRAWS = 400


@pytest.fixture(scope="module")
def world() -> tuple[WhitenedRows, Tile]:
    model = standard_model(planar_robot())
    base, state = base_model(model), swing(2)
    log = log_of(model, true_parameters(model), state, np.zeros_like(state.position))
    motion = condition(log, model.robot, FilterOptions(cutoff_hz=10.0))
    tile = next(iter(motion.tiles()))
    tile = replace(tile, usable=tile.usable & ~tile.turning)
    base_parameters = base.base_of(true_parameters(model))
    drops = np.ones(2, dtype=bool)
    return WhitenedRows(
        ColumnPlan(model, base.kept), base_parameters, TORQUE, ACCELERATION, RESIDUAL, drops
    ), tile


def drawn(plan: WhitenedRows, tile: Tile, seed: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Draw the errors of a tile's rows: those of the columns, and of the torques that they predict."""
    rng, count = np.random.default_rng(seed), len(tile.time)
    at = tile.first + tile.parallel.decimation * np.arange(count)
    columns = acceleration_columns(plan.plan, tile.state.position[at])
    noise = ACCELERATION[:, None] * rng.normal(size=(2, count))
    series = np.einsum("ket,kt->et", columns, noise)
    own = plan.plan
    return [
        (
            np.column_stack(
                [series[rows].T, series[rows].T @ plan.base[place] + TORQUE[joint] * rng.normal(size=count)]
            ),
            tile.usable[:, joint],
        )
        for joint, (rows, place) in enumerate(zip(own.rows_of, own.columns_of, strict=True))
    ]


def test_errors_of_combined_rows_have_the_residuals_size_and_do_not_resemble_each_other(world):
    plan, tile = world
    both = tile.usable.all(axis=1)
    total = np.zeros((2, 2))
    for seed in range(DRAWS):
        errors = np.column_stack([rows[:, -1] for rows, _ in plan.combined(tile, drawn(plan, tile, seed))])
        total += errors[both].T @ errors[both]
    covariance = total / (DRAWS * both.sum()) / np.outer(RESIDUAL, RESIDUAL)
    np.testing.assert_allclose(covariance, np.eye(2), atol=0.03)


def test_the_expected_products_are_those_of_drawn_noise(world):
    plan, tile = world
    wanted = np.arange(len(tile.time)) % 3 > 0
    total = np.zeros((2, len(plan.base), len(plan.base)))
    for seed in range(DRAWS):
        for joint, (rows, _) in enumerate(plan.combined(tile, drawn(plan, tile, seed))):
            total[joint] += rows[wanted, :-1].T @ rows[wanted, :-1] / DRAWS
    expected = plan.noise_products(tile, wanted)
    scale = np.sqrt(np.einsum("jaa->ja", expected).max(axis=0) + 1e-12)
    apart = (total - expected) / np.outer(scale, scale)
    assert np.abs(apart).max() < 0.05


def test_joints_that_are_not_known_at_an_instant_have_no_part_in_it(world):
    plan, tile = world
    usable = tile.usable.copy()
    usable[:, 0] = False
    alone = replace(tile, usable=usable)
    (_, known), (rows, _) = plan.combined(alone, equations(plan.plan, alone))
    assert not known.any()
    own = plan.plan
    absent = np.setdiff1d(np.arange(len(plan.base)), own.columns_of[1])
    np.testing.assert_array_equal(rows[:, absent], 0.0)


def test_noise_of_torques_alone_leaves_every_row_as_it_is(world):
    plan, tile = world
    quiet = replace(plan, torque=RESIDUAL, acceleration=np.zeros(2))
    own = plan.plan
    pairs = zip(quiet.combined(tile, equations(own, tile)), equations(own, tile), strict=True)
    for joint, ((found, known), (rows, _)) in enumerate(pairs):
        np.testing.assert_allclose(found[known][:, [*own.columns_of[joint], -1]], rows[known], rtol=1e-12)
