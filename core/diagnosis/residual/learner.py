"""Predict a residual by a generic learner: which share is predictable, and where it is large.

Boosted trees contain no physics and no list of causes. What they predict of a joint's residual on held-out
blocks is structure. An extension of the model gains little from what they cannot predict. A gap as long as
the noise is correlated separates fitted from held-out rows; otherwise noise would count as structure.
Strongly coloured noise hides part of the structure, so the share is then too small.
Sources: Friedman, Ann. Stat. 29(5), 2001; Roberts et al., Ecography 40(8), 2017 (blocked cross-validation).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Indices, JointSeries, Matrix, Vector
from ...dynamics.prediction import Prediction
from ..dataset.dataset import Dataset
from ..regression.ar_noise import ARNoise
from ..thresholds.residual import PREDICTION
from .blocks import Share, row_blocks, share_on_blocks
from .coordinates import coordinate, coordinate_series
from .memory import memory

_PLACES = 10
_WHERE = ("velocity", "position", "load", "time")


@dataclass(frozen=True)
class Place:
    """Hold where the predictable part is large: RMS in N m (N) within a range of one coordinate of the joint.

    `rms` is that of the prediction in the range; ranges hold a tenth of the rows each, and this is the one
    with the largest.
    """

    coordinate: str
    unit: str
    low: float
    high: float
    rms: float


@dataclass(frozen=True, eq=False)
class Predictable:
    """Hold what a generic learner could predict of one joint's residual on held-out blocks."""

    joint: int
    """Counted from 1."""
    share: float
    interval: tuple[float, float]
    """Share of the residual's mean square, with its 95 % interval; at least 0. Something is predictable where
    the interval's lower end is above 0. NaN where the joint moves too little to judge."""
    rms: float
    """RMS of the residual that was judged, N m or N."""
    places: tuple[Place, ...]
    """Where the predictable part is largest, the largest first; empty where nothing is predictable."""
    prediction: Vector
    """The prediction at the data set's rows, N m or N; NaN where a row was left out."""


def predictable_share(
    dataset: Dataset, residual: JointSeries, operating_point: Prediction, noise: Sequence[ARNoise]
) -> tuple[Predictable, ...]:
    """Learn every joint's residual from the motion of all joints, and evaluate it on held-out blocks.

    Parameters
    ----------
    residual
        Measured minus predicted torque at the data set's rows, N m or N.
    noise
        Noise model per joint; its correlation length is the gap between fitted and held-out rows.
    """
    # Next to reversals the sign of a measured velocity is not friction's direction, which leaves structure.
    mask = dataset.clear
    rows = mask.sum(axis=0)
    block, shared = row_blocks(dataset), _shared_features(dataset)
    found = []
    for joint in range(dataset.joints):
        if rows[joint] < PREDICTION.least_rows:
            found.append(_not_judged(joint + 1, len(dataset.time)))
            continue
        features = np.column_stack([shared, _joint_features(dataset, operating_point, joint)])
        gap = _gap(noise[joint], block)
        prediction = _predict_held_out(features, residual[:, joint], mask[:, joint], block, gap)
        judged = share_on_blocks(prediction, residual[:, joint], block)
        found.append(_predictable(dataset, operating_point, joint + 1, residual[:, joint], judged))
    return tuple(found)


def _not_judged(joint: int, rows: int) -> Predictable:
    """Give the result of a joint with too few rows to tell: not a number."""
    return Predictable(joint, np.nan, (np.nan, np.nan), np.nan, (), np.full(rows, np.nan))


def _predict_held_out(features: Matrix, target: Vector, mask: np.ndarray, block: Indices, gap: int) -> Vector:
    """Predict every row in the mask from blocks that are neither its own nor near it."""
    from sklearn.ensemble import HistGradientBoostingRegressor
    from threadpoolctl import threadpool_limits

    out = np.full(len(target), np.nan)
    with threadpool_limits(limits=1):
        for fold in range(PREDICTION.folds):
            held = block % PREDICTION.folds == fold
            near = np.convolve(held, np.ones(2 * gap + 1), mode="same") > 0.5
            seen, asked = mask & ~near, mask & held
            if seen.sum() < 2 * PREDICTION.leaf_rows or not asked.any():
                continue
            trees = HistGradientBoostingRegressor(
                max_iter=PREDICTION.trees,
                learning_rate=PREDICTION.rate,
                max_leaf_nodes=PREDICTION.leaves,
                min_samples_leaf=PREDICTION.leaf_rows,
                max_bins=PREDICTION.quantiles,
                early_stopping=False,
                random_state=0,
            )
            out[asked] = trees.fit(features[seen], target[seen]).predict(features[asked])
    return out


def _gap(noise: ARNoise, block: Indices) -> int:
    longest = PREDICTION.longest_gap * float(np.median(np.bincount(block)))
    return max(1, min(memory(noise), int(longest)))


def _shared_features(dataset: Dataset) -> Matrix:
    state = dataset.state
    return np.column_stack([state.position, state.velocity, state.acceleration, dataset.time])


def _joint_features(dataset: Dataset, operating_point: Prediction, joint: int) -> Matrix:
    names = ("load", "torque", "travel", "temperature")
    series = [coordinate_series(dataset, operating_point, name) for name in names]
    direction = np.sign(dataset.state.velocity[:, joint])
    return np.column_stack([direction, *(values[:, joint] for values in series if values is not None)])


def _predictable(
    dataset: Dataset, operating_point: Prediction, joint: int, residual: Vector, judged: Share
) -> Predictable:
    rows = np.flatnonzero(np.isfinite(judged.prediction))
    places = []
    if judged.interval[0] > 0.0:
        for name in _WHERE:
            along = coordinate(dataset, operating_point, name, joint)
            if along is not None:
                places.append(_place(name, along.unit, along.values[rows], judged.prediction[rows]))
    return Predictable(
        joint=joint,
        share=judged.share,
        interval=judged.interval,
        rms=float(np.sqrt(np.mean(residual[rows] ** 2))) if len(rows) else 0.0,
        places=tuple(sorted(places, key=lambda place: -place.rms)),
        prediction=judged.prediction,
    )


def _place(name: str, unit: str, values: Vector, prediction: Vector) -> Place:
    parts = np.array_split(np.argsort(values, kind="stable"), _PLACES)
    rms = [float(np.sqrt(np.mean(prediction[part] ** 2))) for part in parts]
    best = int(np.argmax(rms))
    low, high = float(values[parts[best]].min()), float(values[parts[best]].max())
    return Place(name, unit, low, high, rms[best])
