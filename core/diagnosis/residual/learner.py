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

from ...arrays import Indices, JointSeries, Vector
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
    block = row_blocks(dataset)
    shared, own = _features(dataset, operating_point)
    found = []
    for joint in range(dataset.joints):
        if rows[joint] < PREDICTION.least_rows:
            found.append(_not_judged(joint + 1, len(dataset.time)))
            continue
        gap = _gap(noise[joint], block)
        features = shared, own[joint]
        prediction = _predict_held_out(features, residual[:, joint], mask[:, joint], block, gap)
        judged = share_on_blocks(prediction, residual[:, joint], block)
        found.append(_predictable(dataset, operating_point, joint + 1, residual[:, joint], judged))
    return tuple(found)


def _not_judged(joint: int, rows: int) -> Predictable:
    """Give the result of a joint with too few rows to tell: not a number."""
    return Predictable(joint, np.nan, (np.nan, np.nan), np.nan, (), np.full(rows, np.nan))


def _predict_held_out(
    features: Sequence["_Sorted"], target: Vector, mask: np.ndarray, block: Indices, gap: int
) -> Vector:
    """Predict every row in the mask from blocks that are neither its own nor near it."""
    from ...numerics.boosted_trees import boost, sort_into_bins

    columns = np.vstack([part.columns for part in features])
    order = np.vstack([part.order for part in features])
    quantiles = np.linspace(0.0, 100.0, PREDICTION.quantiles + 1)[1:-1] / 100.0
    sizes = PREDICTION.trees, PREDICTION.leaves, PREDICTION.leaf_rows, PREDICTION.quantiles
    bins, out = np.empty(columns.T.shape, dtype=np.uint8), np.full(len(target), np.nan)
    for fold in range(PREDICTION.folds):
        held = block % PREDICTION.folds == fold
        near = np.convolve(held, np.ones(2 * gap + 1), mode="same") > 0.5
        seen, asked = mask & ~near, mask & held
        if seen.sum() < 2 * PREDICTION.leaf_rows or not asked.any():
            continue
        sort_into_bins(columns, order, seen, quantiles, bins)
        predicted = np.empty(np.count_nonzero(asked))
        boost(bins[seen], target[seen], sizes, PREDICTION.rate, bins[asked], predicted)
        out[asked] = predicted
    return out


def _gap(noise: ARNoise, block: Indices) -> int:
    longest = PREDICTION.longest_gap * float(np.median(np.bincount(block)))
    return max(1, min(memory(noise), int(longest)))


@dataclass(frozen=True, eq=False)
class _Sorted:
    """Hold coordinates at the rows, and per coordinate the rows by ascending value."""

    columns: np.ndarray
    order: np.ndarray


def _sorted(columns: Sequence[Vector]) -> _Sorted:
    """Sort coordinates; one that is not known at every row is left out."""
    known = np.ascontiguousarray([column for column in columns if np.isfinite(column).all()])
    return _Sorted(known, np.argsort(known, axis=1))


def _features(dataset: Dataset, operating_point: Prediction) -> tuple[_Sorted, list[_Sorted]]:
    """Give the coordinates that all joints share, and those of each joint."""
    state = dataset.state
    names = ("load", "torque", "travel", "temperature")
    series = [coordinate_series(dataset, operating_point, name) for name in names]
    own = [np.sign(state.velocity), *(values for values in series if values is not None)]
    shared = [*state.position.T, *state.velocity.T, *state.acceleration.T, dataset.time]
    return _sorted(shared), [_sorted([part[:, joint] for part in own]) for joint in range(dataset.joints)]


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
