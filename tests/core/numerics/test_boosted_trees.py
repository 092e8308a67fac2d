"""Hold boosted trees to scikit-learn's arithmetic: any last bit may decide between two splits."""

import numpy as np
import pytest
from sklearn.ensemble import HistGradientBoostingRegressor

from veritorque.core.numerics.boosted_trees import TreeShape, predict_by_trees

SHAPES = (TreeShape(40, 6, 20, 0.1, 63), TreeShape(7, 2, 16, 1.0, 127), TreeShape(3, 31, 30, 0.3, 4))


def theirs(known, target, asked, shape):
    trees = HistGradientBoostingRegressor(
        max_iter=shape.trees,
        learning_rate=shape.rate,
        max_leaf_nodes=shape.leaves,
        min_samples_leaf=shape.leaf_rows,
        max_bins=shape.quantiles,
        early_stopping=False,
    )
    return trees.fit(known, target).predict(asked)


def coordinates(rows, rng):
    """Draw coordinates as motions have them: at rest for long, of few values, constant, or twice there."""
    drawn = rng.normal(size=(rows, 7))
    drawn[:, 0] = np.maximum(drawn[:, 0], 0.3)
    drawn[:, 1] = np.sign(drawn[:, 2])
    drawn[:, 3] = 1.5
    drawn[:, 4] = 2.0 * drawn[:, 5]
    return drawn


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: f"{shape.trees} trees, {shape.leaves} leaves")
@pytest.mark.parametrize("rows", [30, 39, 40, 41, 600, 1500])
def test_the_prediction_is_that_of_scikit_learn_to_the_last_bit(rows, shape):
    rng = np.random.default_rng(rows)
    known, asked = coordinates(rows, rng), coordinates(100, rng)
    target = np.sin(3.0 * known[:, 5]) * known[:, 1] + 0.3 * rng.normal(size=rows)
    assert np.array_equal(predict_by_trees(known, target, asked, shape), theirs(known, target, asked, shape))


def test_a_target_without_any_variation_is_predicted_as_it_is():
    known = coordinates(200, np.random.default_rng(1))
    assert predict_by_trees(known, np.full(200, 0.25), known, SHAPES[0]).tolist() == [0.25] * 200
