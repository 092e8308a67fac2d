"""Hold the share on held-out blocks to truths that are known beforehand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.diagnosis.residual.worlds import world
from veritorque.core.diagnosis.residual.blocks import row_blocks, share_on_blocks
from veritorque.core.diagnosis.thresholds.residual import PREDICTION

ROWS = 2000
BLOCK = np.arange(ROWS) // (ROWS // PREDICTION.blocks)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_the_interval_covers_the_true_share_in_nineteen_of_twenty_cases(share):
    rng = np.random.default_rng(5)
    covered = 0
    for _ in range(300):
        signal, noise = rng.normal(size=(2, ROWS))
        residual = np.sqrt(share) * signal + np.sqrt(1.0 - share) * noise
        low, high = share_on_blocks(np.sqrt(share) * signal, residual, BLOCK).interval
        covered += low <= share <= high
    # 0.95 of 300, three binomial deviations (3.8) either way
    assert 273 <= covered <= 297


def test_a_prediction_of_nothing_explains_nothing():
    rng = np.random.default_rng(6)
    found = [share_on_blocks(*rng.normal(size=(2, ROWS)), BLOCK) for _ in range(200)]
    assert max(one.share for one in found) < 0.01
    assert sum(one.interval[0] > 0.0 for one in found) <= 2


@given(scale=st.floats(1e-6, 1e6), seed=st.integers(0, 50))
def test_the_share_does_not_depend_on_the_unit(scale, seed):
    rng = np.random.default_rng(seed)
    signal, noise = rng.normal(size=(2, ROWS))
    one = share_on_blocks(signal, signal + noise, BLOCK)
    other = share_on_blocks(scale * signal, scale * (signal + noise), BLOCK)
    assert other.share == pytest.approx(one.share, rel=1e-9)
    assert other.interval == pytest.approx(one.interval, rel=1e-9)


def test_a_prediction_that_is_too_large_is_scaled_down_by_what_the_other_blocks_say():
    rng = np.random.default_rng(7)
    signal, noise = rng.normal(size=(2, ROWS))
    found = share_on_blocks(10.0 * signal, signal + noise, BLOCK)
    assert found.share == pytest.approx(0.5, abs=0.05)
    assert np.std(found.prediction) == pytest.approx(1.0, abs=0.05)


def test_rows_without_a_prediction_are_left_out_of_the_share():
    rng = np.random.default_rng(8)
    signal = rng.normal(size=ROWS)
    prediction, residual = signal.copy(), signal.copy()
    prediction[::3] = np.nan
    residual[::3] += 1e6
    found = share_on_blocks(prediction, residual, BLOCK)
    assert found.share == pytest.approx(1.0)
    np.testing.assert_array_equal(np.isnan(found.prediction), np.isnan(prediction))


def test_a_residual_of_zeros_leaves_nothing_to_predict():
    assert share_on_blocks(np.ones(ROWS), np.zeros(ROWS), BLOCK).interval == (0.0, 0.0)


def test_blocks_are_contiguous_and_nearly_equal():
    block = row_blocks(world().dataset)
    assert set(np.diff(block)) == {0, 1}
    sizes = np.bincount(block)
    assert len(sizes) == PREDICTION.blocks
    assert np.ptp(sizes) <= 1
