"""A gain in simulated motion comes with an interval that whole blocks of time decide."""

import numpy as np
import pytest

from veritorque.core.extension.gain import motion_intervals
from veritorque.core.simulation.multistep import Comparison, MultiStep

HORIZONS = (0.05, 0.2)


def strayed(scale, blocks=10, windows=20, seed=0, shared=0.0):
    """Errors (rad) of two joints; `shared` is the share of an error that all windows of a block have."""
    rng = np.random.default_rng(seed)
    alike = np.repeat(rng.normal(size=(blocks, 1, 1, 2)), windows, axis=1)
    own = rng.normal(size=(blocks, windows, len(HORIZONS), 2))
    errors = (shared * alike + (1.0 - shared) * own).reshape(-1, len(HORIZONS), 2) * np.asarray(scale)
    keys = tuple((0, block) for block in range(blocks) for _ in range(windows))
    nothing = np.zeros_like(errors)
    return MultiStep(HORIZONS, keys, np.zeros(len(keys)), errors, nothing, nothing)


def test_an_error_that_is_halved_everywhere_is_halved_for_sure():
    found = motion_intervals(Comparison(strayed([1.0, 2.0]), strayed([0.5, 1.0])))
    np.testing.assert_allclose(found, 50.0)


def test_the_interval_holds_the_gain_it_belongs_to():
    comparison = Comparison(strayed([1.0, 1.0], seed=1), strayed([0.7, 1.0], seed=2))
    low, high = motion_intervals(comparison).T
    gain = comparison.total_gain_percent
    assert (low < gain).all()
    assert (gain < high).all()
    assert low[0] > 0.0  # three tenths less
    assert low[1] < 0.0 < high[1]  # nothing gained


def test_windows_that_share_their_error_within_a_block_make_the_interval_wider():
    alone, together = (
        motion_intervals(
            Comparison(strayed([1.0, 1.0], seed=3, shared=shared), strayed([0.8, 0.8], seed=4, shared=shared))
        )
        for shared in (0.0, 0.9)
    )
    assert (np.ptp(together, axis=1) > 1.5 * np.ptp(alone, axis=1)).all()


def test_three_blocks_are_too_few_to_say():
    assert motion_intervals(Comparison(strayed([1.0, 1.0], blocks=3), strayed([0.5, 0.5], blocks=3))) is None


def test_a_joint_without_error_gained_nothing():
    found = motion_intervals(Comparison(strayed([0.0, 1.0]), strayed([0.0, 0.5])))
    assert found[0] == pytest.approx([0.0, 0.0])
