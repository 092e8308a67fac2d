"""The streamed equations against the matrix that pinocchio and scipy write out in full.

Both see the same samples: blocks at the log's ends are left out, because there scipy continues a series in
another way than we do. Tolerance 1e-8 relative: each chain rounds to 1e-13, times a condition number of 1e4.
"""

import numpy as np
import pytest

from tests.core.regressor.studies import (
    CUTOFF_HZ,
    DECIMATION,
    ORDER,
    POSITION_CUTOFF_HZ,
    RATE_HZ,
    observation_by_scipy,
    recorded,
)
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.memory import LaggedProducts
from veritorque.core.regressor.observe import Observation, observe, torque_scales
from veritorque.core.regressor.residuals import residuals
from veritorque.core.regressor.rows import equations
from veritorque.core.signals import condition as conditioning
from veritorque.core.signals.condition import Motion, condition
from veritorque.core.signals.parallel import Tile
from veritorque.core.signals.recipe import FilterOptions

BLOCKS = 12
INSIDE = range(2, 10)
OPTIONS = FilterOptions(5, CUTOFF_HZ, POSITION_CUTOFF_HZ, ORDER, DECIMATION)


@pytest.fixture(scope="module")
def study():
    return recorded()


@pytest.fixture(scope="module")
def plan(study) -> ColumnPlan:
    base = base_model(standard_model(study.robot))
    return ColumnPlan(base.model, base.kept)


@pytest.fixture(scope="module")
def motion(study) -> Motion:
    return condition(study.log, study.robot, OPTIONS, blocks=BLOCKS)


@pytest.fixture(scope="module")
def observation(plan, motion) -> Observation:
    return observe(plan, (motion,))


@pytest.fixture(scope="module")
def by_scipy(study, plan) -> tuple[np.ndarray, np.ndarray]:
    """Give W (decimated samples, joints, columns of the plan) and Y (decimated samples, joints)."""
    columns, torque = observation_by_scipy(study)
    names = [plan.model.parameters[column].name for column in plan.columns]
    return np.stack([columns[name] for name in names], axis=-1), torque


def _inside(motion: Motion) -> np.ndarray:
    """Give the places of the decimated samples in the inner blocks."""
    borders = [motion.kept * number // BLOCKS for number in (INSIDE[0], INSIDE[-1] + 1)]
    return np.arange(*borders)


def _least_squares(observation: Observation, chosen: tuple[int, ...]) -> np.ndarray:
    rows = []
    for factor, columns in zip(observation.joint_factors(chosen), observation.columns_of, strict=True):
        wide = np.zeros((len(factor.triangle), len(observation.plan.columns) + 1))
        wide[:, [*columns, -1]] = factor.triangle
        rows.append(wide)
    stacked = np.vstack(rows)
    return np.linalg.lstsq(stacked[:, :-1], stacked[:, -1], rcond=None)[0]


def test_parameters_equal_those_of_pinocchio_scipy_and_lstsq(observation, motion, by_scipy):
    W, Y = (part[_inside(motion)] for part in by_scipy)
    expected = np.linalg.lstsq(W.reshape(-1, W.shape[-1]), Y.ravel(), rcond=None)[0]
    found = _least_squares(observation, tuple(INSIDE))
    assert np.max(np.abs(found - expected) / np.abs(expected)) < 1e-8


def test_a_filter_of_another_cut_off_would_be_seen(study, plan, motion, by_scipy):
    W, Y = (part[_inside(motion)] for part in by_scipy)
    expected = np.linalg.lstsq(W.reshape(-1, W.shape[-1]), Y.ravel(), rcond=None)[0]
    lower = FilterOptions(5, 0.99 * CUTOFF_HZ, POSITION_CUTOFF_HZ, ORDER, DECIMATION)
    other = observe(plan, (condition(study.log, study.robot, lower, blocks=BLOCKS),))
    assert np.max(np.abs(_least_squares(other, tuple(INSIDE)) - expected) / np.abs(expected)) > 1e-5


def test_every_equation_is_the_one_that_scipy_writes(plan, motion, by_scipy):
    W, Y = by_scipy
    inside = _inside(motion)
    rows = [
        np.vstack(parts)
        for parts in zip(
            *([pair[0] for pair in equations(plan, tile)] for tile in motion.tiles()), strict=True
        )
    ]
    for joint, columns in enumerate(plan.columns_of):
        expected = np.column_stack([W[inside, joint][:, columns], Y[inside, joint]])
        scale = np.abs(expected).max(axis=0)
        scale = np.maximum(scale, 1e-6 * scale.max())  # some columns are nothing but rounding on this arm
        assert np.max(np.abs(rows[joint][inside] - expected) / scale) < 1e-9
        assert not np.delete(W[inside, joint], columns, axis=1).any()


def test_the_fit_finds_the_parameters_that_made_the_torque(observation, study):
    base = base_model(standard_model(study.robot))
    values = {"IA": 0.3, "FV": 0.5, "FC": 0.4, "OFF": 0.1}
    standard = np.array(
        [
            values[one.symbol] if one.symbol in values else study.bodies.ravel()[place]
            for place, one in enumerate(base.model.parameters)
        ]
    )
    found, true = _least_squares(observation, tuple(range(BLOCKS))), base.base_of(standard)
    assert np.linalg.norm(found - true) < 0.03 * np.linalg.norm(true)


def test_blocks_hold_all_usable_rows_of_their_stretch(observation, motion, plan):
    assert [block.number for block in observation.blocks] == list(range(BLOCKS))
    used = np.zeros((BLOCKS, 7), dtype=int)
    for tile in motion.tiles():
        np.add.at(used, tile.block, tile.usable)
    assert [[factor.rows for factor in block.factors] for block in observation.blocks] == used.tolist()
    assert observation.kept == motion.kept
    ends = [block.end for block in observation.blocks]
    assert all(end < block.start for end, block in zip(ends, observation.blocks[1:], strict=False))


def test_residuals_recomputed_add_up_to_what_the_factors_hold(observation, motion, plan):
    parameters = _least_squares(observation, tuple(range(BLOCKS)))
    squares, torques = np.zeros(7), np.zeros(7)
    for tile in residuals(plan, motion, parameters):
        squares += (tile.residual**2 * tile.usable).sum(axis=0)
        torques += (tile.torque**2 * tile.usable).sum(axis=0)
    factors = observation.joint_factors()
    held = [
        one.residual_square(parameters[columns])
        for one, columns in zip(factors, plan.columns_of, strict=True)
    ]
    assert np.allclose(held, squares, rtol=1e-9)
    rms = np.sqrt(torques / [one.rows for one in factors])
    assert np.allclose(torque_scales(observation), rms, rtol=1e-12)


def test_the_residual_is_measured_minus_predicted(motion, plan):
    tile = next(residuals(plan, motion, np.zeros(len(plan.columns))))
    assert np.array_equal(tile.residual, tile.torque)


@pytest.mark.parametrize("kept", [5])
def test_how_a_motion_is_cut_into_tiles_changes_no_statistic(monkeypatch, observation, plan, motion, kept):
    monkeypatch.setattr(conditioning, "TILE_KEPT", kept)
    cut = observe(plan, (motion,))
    _same_statistic(cut, observation)


@pytest.mark.parametrize("blocks", [1, 150])
def test_how_a_log_is_cut_into_blocks_changes_no_sum(observation, plan, study, blocks):
    cut = observe(plan, (condition(study.log, study.robot, OPTIONS, blocks=blocks),))
    assert len(cut.blocks) == blocks
    _same_statistic(cut, observation)


def _same_statistic(one: Observation, other: Observation) -> None:
    for mine, yours in zip(one.joint_factors(), other.joint_factors(), strict=True):
        gram = yours.triangle.T @ yours.triangle
        assert mine.rows == yours.rows
        assert np.allclose(mine.triangle.T @ mine.triangle, gram, rtol=0.0, atol=1e-9 * np.abs(gram).max())
    for mine, yours in zip(one.memory, other.memory, strict=True):
        assert mine.rows == yours.rows
        scale = np.abs(yours.products).max()
        assert np.allclose(mine.products, yours.products, rtol=0.0, atol=1e-9 * scale)


def test_memory_is_that_of_the_rows_one_after_another(observation, plan, motion):
    for joint in (0, 6):
        rows = np.vstack([_marked(plan, tile)[joint] for tile in motion.tiles()])
        direct = LaggedProducts.empty(rows.shape[1]).extended(rows, 0, 0)
        assert np.allclose(observation.memory[joint].products, direct.products, rtol=1e-9, atol=1e-6)


def _marked(plan: ColumnPlan, tile: Tile) -> list[np.ndarray]:
    return [rows * usable[:, None] for rows, usable in equations(plan, tile)]


def test_memory_reaches_neither_across_a_gap_nor_into_held_out_blocks(study, plan):
    rows = whole_rows(study.log)
    half = len(rows.time) // 2
    shifted = np.concatenate([rows.time[:half], rows.time[half:] + 5.0])
    parts = [slice(0, half), slice(half, None)]
    together = _memory(log_from_arrays("gap", shifted, rows.position, rows.torque), plan)
    apart = [
        _memory(log_from_arrays("part", rows.time[part], rows.position[part], rows.torque[part]), plan)
        for part in parts
    ]
    for whole, first, second in zip(together, *apart, strict=True):
        expected = first.products + second.products
        assert np.max(np.abs(whole.products - expected)) < 1e-9 * np.abs(expected).max()


def _memory(log: JointLog, plan: ColumnPlan) -> tuple[LaggedProducts, ...]:
    motion = condition(log, plan.model.robot, OPTIONS, blocks=1)
    return observe(plan, (motion,)).memory


def test_held_out_blocks_are_condensed_but_leave_no_memory(observation, plan, motion):
    hidden = frozenset((0, number) for number in range(6, BLOCKS))
    partly = observe(plan, (motion,), held_out=hidden)
    for one, other in zip(partly.blocks, observation.blocks, strict=True):
        assert [factor.rows for factor in one.factors] == [factor.rows for factor in other.factors]
    rows = sum(block.factors[0].rows for block in observation.blocks[:6])
    assert partly.memory[0].rows == rows


def test_two_logs_are_the_sum_of_both(observation, plan, motion):
    both = observe(plan, (motion, motion))
    assert [block.log for block in both.blocks] == [0] * BLOCKS + [1] * BLOCKS
    for one, twice in zip(observation.joint_factors(), both.joint_factors(), strict=True):
        assert twice.rows == 2 * one.rows
        assert np.isclose(twice.torque_square, 2.0 * one.torque_square, rtol=1e-12)


def test_weights_of_one_change_nothing_and_weights_of_zero_remove_rows(observation, plan, motion):
    _same_statistic(
        observe(plan, (motion,), weigh=lambda pairs: [np.ones(len(one)) for one, _ in pairs]), observation
    )
    nothing = observe(plan, (motion,), weigh=lambda pairs: [np.zeros(len(one)) for one, _ in pairs])
    assert all(factor.torque_square == 0.0 for factor in nothing.joint_factors())


def test_progress_rises_to_one(plan, motion):
    seen: list[float] = []
    observe(plan, (motion,), progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_the_sampled_positions_lie_on_the_motion(observation, study):
    low, high = study.position.min(axis=0), study.position.max(axis=0)
    assert len(observation.positions) > 50
    assert np.all(observation.positions > low - 1e-3)
    assert np.all(observation.positions < high + 1e-3)
    assert np.all(np.ptp(observation.positions, axis=0) > 0.8 * (high - low))
    assert study.log.rate_hz == pytest.approx(RATE_HZ)
