"""Hold our boosted trees to scikit-learn's on the same columns."""

import numpy as np
import pytest
from sklearn.ensemble import HistGradientBoostingRegressor

from veritorque.core.numerics.boosted_trees import boost, sort_into_bins

ROWS, TREES, LEAVES, LEAST, BINS, RATE = 900, 20, 6, 20, 63, 0.2


def columns(rng: np.random.Generator) -> np.ndarray:
    """Give columns that vary, of a few values, of ties, of one value, and one with an outlier."""
    smooth = np.cumsum(rng.normal(size=(4, ROWS)), axis=1)
    few = np.sign(smooth[0]), np.round(smooth[1]), np.ones(ROWS)
    return np.vstack([smooth, *few, np.where(np.arange(ROWS) == 7, 1e6, smooth[2])])


def predicted(values: np.ndarray, target: np.ndarray, seen: np.ndarray, trees: int = TREES) -> np.ndarray:
    """Predict the rows that are not seen by our trees."""
    bins, out = np.empty(values.T.shape, dtype=np.uint8), np.empty(np.count_nonzero(~seen))
    shares = np.linspace(0.0, 100.0, BINS + 1)[1:-1] / 100.0
    sort_into_bins(values, np.argsort(values, axis=1), seen, shares, bins)
    boost(bins[seen], target[seen], (trees, LEAVES, LEAST, BINS), RATE, bins[~seen], out)
    return out


@pytest.mark.parametrize("seed", range(4))
def test_the_trees_predict_what_those_of_scikit_learn_predict(seed):
    rng = np.random.default_rng(seed)
    values = columns(rng)
    target = values[0] * np.sign(values[1]) + 3.0 * (values[5] > 0.0) + rng.normal(size=ROWS)
    seen = rng.random(ROWS) < (0.8, 0.5, 0.1, 0.05)[seed]
    theirs = HistGradientBoostingRegressor(
        max_iter=TREES,
        learning_rate=RATE,
        max_leaf_nodes=LEAVES,
        min_samples_leaf=LEAST,
        max_bins=BINS,
        early_stopping=False,
    ).fit(values.T[seen], target[seen])
    expected = theirs.predict(values.T[~seen])
    assert np.ptp(expected) > 0.1 * np.ptp(target)
    assert predicted(values, target, seen) == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.ptp(target))


def test_a_target_that_no_column_tells_anything_of_is_predicted_by_its_mean():
    values, target = np.ones((3, ROWS)), np.arange(ROWS, dtype=float)
    seen = np.arange(ROWS) < 2 * ROWS // 3
    assert predicted(values, target, seen) == pytest.approx(np.full(ROWS // 3, target[seen].mean()))


def test_a_step_is_found_by_one_split():
    values = np.arange(ROWS, dtype=float)[None]
    target = np.where(values[0] < 300.0, -1.0, 1.0)
    seen = np.arange(ROWS) % 2 == 0
    found = predicted(values, target, seen, trees=60)
    assert np.abs(found - target[~seen])[np.abs(values[0][~seen] - 300.0) > ROWS / BINS].max() < 1e-4
