"""Hold the gain on held-out rows to what it promises: above zero for a real effect, around it by chance."""

import numpy as np
import pytest

from tests.core.diagnosis.processes import SLOW, drawn
from tests.core.diagnosis.regression.gls_world import smooth
from veritorque.core.diagnosis.checks.gain import gain

ROWS, HELD_OUT = 4000, 1000


def measured(seed: int, size: float):
    """Fit one column to the first rows of joint 1, which holds `size` of it, and judge it on the rest."""
    rng = np.random.default_rng(seed)
    column = smooth(rng, ROWS, 1)[:, 0]
    before = drawn(SLOW, rng, ROWS, 2)
    before[:, 0] += size * column
    seen, block = np.arange(ROWS) < ROWS - HELD_OUT, np.arange(ROWS) // 500
    value = (column[seen] @ before[seen, 0]) / (column[seen] @ column[seen])
    after = before.copy()
    after[:, 0] -= value * column
    mask = np.repeat(~seen[:, None], 2, axis=1)
    return gain(before, after, mask, block, (0,))


def test_a_column_that_explains_nothing_gains_nothing_that_is_certain():
    found = [measured(seed, 0.0) for seed in range(40)]
    # An interval of 95 % lies above zero by chance once in forty.
    assert sum(one.interval_95[0] > 0.0 for one in found) <= 4
    assert all(one.interval_95[0] <= one.total_percent <= one.interval_95[1] for one in found)


def test_a_real_effect_gains_on_held_out_rows():
    for seed in range(10):
        found = measured(seed, 2.0)
        assert found.interval_95[0] > 0.0
        assert found.improvement_percent[0] == pytest.approx(found.total_percent)
        assert found.improvement_percent[1] == 0.0


def test_only_marked_rows_count():
    before = np.ones((400, 1))
    after = np.concatenate([np.full((200, 1), 10.0), np.full((200, 1), 0.5)])
    mask = np.arange(400)[:, None] >= 200
    found = gain(before, after, mask, np.zeros(400, dtype=int), (0,))
    assert (found.before[0], found.after[0], found.total_percent) == (1.0, 0.5, 50.0)
    assert found.interval_95 == (50.0, 50.0)


def test_too_few_rows_to_judge_give_no_gain():
    ones = np.ones((400, 1))
    mask = np.arange(400)[:, None] < 60
    assert gain(ones, ones, mask, np.zeros(400, dtype=int), (0,)) is None


def test_the_same_rows_give_the_same_interval():
    assert measured(1, 0.5).interval_95 == measured(1, 0.5).interval_95
