"""A model of the cost: every stage per unit of its work, beside the arithmetic's limit.

The limit of a stage is the time of its multiplications and additions at the rate of a large matrix product
in the same run. Stages that move data instead are set beside the time of a copy. docs/performance.md explains
the table.
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks.figures import Figure, processor_seconds
from benchmarks.scene import NOISE_SHARE, RATE_HZ, Scene, scene_of, smooth_motion
from tests.plant.cache import kept
from tests.plant.cases import draw_clean
from veritorque.core.diagnosis.causes.registry import CAUSES
from veritorque.core.diagnosis.dataset.dataset import build_dataset
from veritorque.core.diagnosis.search.fitter import hypothesis_fitter
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.factor import Factor
from veritorque.core.regressor.memory import LaggedProducts, TurningProducts
from veritorque.core.regressor.observe import observe
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.signals.condition import Motion, condition
from veritorque.core.signals.parallel import Tile
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.validation.holdout import HoldOut

OPTIONS = FilterOptions(median_order=1, cutoff_hz=10.0, position_cutoff_hz=50.0, order=5, decimation=10)
ROBOTS = ("yumi-left", "yumi")
SQUARE = 600
LAGS = LaggedProducts.LAGS + 1


def run(*, quick: bool) -> list[Figure]:
    """Time every stage on arms of seven and fourteen joints."""
    rate = _product_rate()
    samples = 5_000 if quick else 40_000
    figures = [Figure("large matrix product, 10^9 operations/s", f"{rate / 1e9:.0f}")]
    for name in ROBOTS[:1] if quick else ROBOTS:
        figures += _of_robot(name, samples, rate)
    return [*figures, *_of_candidates(*(("planar-2", 4.0) if quick else ("yumi-left", 30.0)))]


def _product_rate() -> float:
    """Give the operations (multiplications and additions) per second of a large matrix product."""
    square = np.random.default_rng(1).normal(size=(SQUARE, SQUARE))
    return 2.0 * SQUARE**3 / processor_seconds(lambda: square @ square)


def _of_robot(name: str, samples: int, rate: float) -> list[Figure]:
    scene = scene_of(builtin_robot(name))
    motion = _motion(scene, samples)
    tiles = list(motion.tiles())
    seen = sum(len(tile.torque) for tile in tiles)
    joints, series = len(scene.robot.joints), len(scene.plan.entries)
    widths = np.array([1 + len(columns) for columns in scene.plan.columns_of])
    head = f"{joints} joints, {series} columns"

    def per_sample(work: Callable[[], object]) -> float:
        return processor_seconds(work, repeats=3, least=0.0) / samples * 1e6

    def limit(operations: float) -> str:
        return f"limit {operations / rate * 1e6:.3f}"

    condensing = 2.0 * series * _states(tiles[0])
    squares, each = 2.0 * float(widths @ widths), 1.0 / motion.recipe.decimation
    whole = per_sample(partial(observe, scene.plan, (motion,)))
    conditioned = per_sample(lambda: list(motion.tiles()))
    regressor = per_sample(lambda: [scene.plan.series(tile.state) for tile in tiles]) * samples / seen
    filtered = per_sample(lambda: [_filtered(scene, tile) for tile in tiles]) * samples / seen
    rows = [_rows(scene, tile) for tile in tiles]
    factors = per_sample(lambda: [Factor.of(one) for tile in rows for one in tile])
    lagged = per_sample(lambda: [_lagged(one) for tile in rows for one in tile])
    share = float(np.mean([tile.turning.mean() for tile in tiles]))
    turning = per_sample(
        lambda: [
            TurningProducts.empty(one.shape[1]).extended(one, tile.turning[:, joint], 0)
            for tile, of_joints in zip(tiles, rows, strict=True)
            for joint, one in enumerate(of_joints)
        ]
    )
    least = (condensing + squares * each * (1.0 + LAGS * (1.0 + 2.0 * share))) / rate * 1e6
    return [
        Figure(f"{head}: whole observation, us/sample", f"{whole:.2f}", "<= 0.9", f"limit {least:.2f}"),
        Figure(f"{head}: whole observation over its limit", f"{whole / least:.1f}", "", ratio=True),
        Figure(f"{head}: conditioning, us/sample and joint", f"{conditioned / joints:.4f}"),
        Figure(f"{head}: regressor, us/sample and column", f"{regressor / series:.5f}"),
        Figure(
            f"{head}: regressor and parallel filter, us/sample and column",
            f"{filtered / series:.5f}",
            "",
            limit(condensing / series),
        ),
        Figure(f"{head}: triangular factors, us/sample", f"{factors:.3f}", "", limit(squares * each)),
        Figure(
            f"{head}: {LAGS} lagged products, us/sample", f"{lagged:.3f}", "", limit(LAGS * squares * each)
        ),
        Figure(
            f"{head}: products beside reversals ({100 * share:.0f} % of the rows), us/sample",
            f"{turning:.3f}",
            "",
            limit(2.0 * LAGS * squares * each * share),
        ),
    ]


def _of_candidates(robot: str, seconds: float) -> list[Figure]:
    """Time what a diagnosis does for every candidate cause at one operating point."""
    case = kept(draw_clean, 11, robot=robot, duration=seconds)
    model = standard_model(case.believed)
    dataset = build_dataset(model, (case.log,), held_out=HoldOut(0.25, 40).chosen(1), blocks=40)
    plain = hypothesis_fitter(dataset, ColumnPlan(model, base_model(model).kept), CAUSES)
    none = plain.fit(())
    there = plain.linearised_at(none)
    candidates = there.candidates
    samples = sum(len(stretch.state.position) for stretch in dataset.stretches)
    columns = processor_seconds(
        lambda: plain.linearised_at(none).columns(candidates), repeats=3, least=0.0
    ) / len(candidates)
    there.columns(candidates)
    scored = processor_seconds(lambda: there.score(none, candidates), repeats=3, least=0.0) / len(candidates)
    head = f"{len(candidates)} candidates, {len(dataset.time)} rows of {dataset.joints} joints"
    return [
        Figure(f"{head}: columns, us/candidate", f"{1e6 * columns:.0f}", "", f"{samples} samples"),
        Figure(f"{head}: score test, us/candidate", f"{1e6 * scored:.0f}"),
    ]


def _motion(scene: Scene, samples: int) -> Motion:
    time = np.arange(samples) / RATE_HZ
    state = smooth_motion(len(scene.robot.joints)).at(time)
    torque = scene.torque(state)
    torque += np.random.default_rng(1).normal(size=torque.shape) * NOISE_SHARE * torque.std(axis=0)
    return condition(log_from_arrays("cost", time, state.position, torque), scene.robot, OPTIONS)


def _states(tile: Tile) -> int:
    """Count what a block's samples are condensed to: its instants, and the states of the filter's decays."""
    return 16 + 4 * len(tile.parallel.modes.poles)


def _filtered(scene: Scene, tile: Tile) -> np.ndarray:
    return tile.filtered_in_parts(scene.plan.series)


def _rows(scene: Scene, tile: Tile) -> list[np.ndarray]:
    filtered = _filtered(scene, tile)
    torque = tile.filtered(np.ascontiguousarray(tile.torque.T))
    return [
        np.ascontiguousarray(np.vstack([filtered[own], torque[joint]]).T)
        for joint, own in enumerate(scene.plan.rows_of)
    ]


def _lagged(rows: np.ndarray) -> LaggedProducts:
    return LaggedProducts.empty(rows.shape[1]).extended(rows, 0, len(rows))
