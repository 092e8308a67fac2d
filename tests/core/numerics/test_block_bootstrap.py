"""Blocks are drawn with replacement, the same for the same seed, and intervals hold 95 of 100 draws."""

import numpy as np

from veritorque.core.numerics.block_bootstrap import block_draws, interval_95, resampled_sums


def test_an_interval_holds_the_middle_ninety_five_of_a_hundred_draws():
    drawn = np.arange(1001.0)[:, None] * np.array([1.0, -2.0])
    np.testing.assert_allclose(interval_95(drawn), [[25.0, 975.0], [-1950.0, -50.0]])


def test_every_draw_has_as_many_blocks_as_there_are_and_all_blocks_take_part():
    drawn = block_draws(7, 200, seed=3)
    assert drawn.shape == (200, 7)
    assert set(drawn.ravel()) == set(range(7))


def test_the_first_draws_do_not_depend_on_how_many_follow():
    assert np.array_equal(block_draws(20, 5, seed=1), block_draws(20, 50, seed=1)[:5])


def test_a_sum_counts_a_block_as_often_as_it_was_drawn():
    squares = np.random.default_rng(0).random((9, 2))
    counts = np.array([np.bincount(drawn, minlength=9) for drawn in block_draws(9, 30, seed=4)])
    np.testing.assert_allclose(resampled_sums(squares, 30, seed=4), counts @ squares)
