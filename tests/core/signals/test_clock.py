"""Positions tell whether samples were taken at their stamps; stamps that came late bend nothing."""

import numpy as np
import pytest

from tests.core.signals.motions import Multisine, jittered, log_of, turntables
from veritorque.core.signals.clock import is_even
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions

RATE_HZ = 250.0
EVEN = np.arange(5000) / RATE_HZ
SWING = Multisine.random(np.random.default_rng(1), 2, highest_hz=1.0)
NOISE = 2e-6 * np.random.default_rng(4).normal(size=(5000, 2))


@pytest.mark.parametrize("scatter", [0.01, 0.1, 0.4])
@pytest.mark.parametrize("seed", range(3))
def test_positions_tell_whether_samples_were_taken_at_their_stamps(scatter, seed):
    stamps = jittered(np.random.default_rng(seed), 5000, RATE_HZ, scatter)
    assert is_even(stamps, SWING.position(EVEN) + NOISE, RATE_HZ)
    assert not is_even(stamps, SWING.position(stamps) + NOISE, RATE_HZ)


def test_where_positions_tell_nothing_the_stamps_stand():
    stamps = jittered(np.random.default_rng(2), 5000, RATE_HZ, 0.02)
    assert not is_even(stamps, SWING.position(0.01 * EVEN) + 100.0 * NOISE, RATE_HZ)


@pytest.mark.parametrize("lost", [1, 3])
@pytest.mark.parametrize("scatter", [0.02, 0.3])
def test_rows_that_were_never_recorded_leave_no_even_clock(lost, scatter):
    kept = np.r_[0:2000, 2000 + lost : 5000]
    stamps = jittered(np.random.default_rng(2), 5000, RATE_HZ, scatter)[kept]
    assert not is_even(stamps, SWING.position(EVEN[kept]) + NOISE[kept], RATE_HZ)


def test_a_stamp_that_came_late_bends_no_acceleration():
    late = EVEN + 1e-3 * np.random.default_rng(5).random(5000)
    on_time, bent = (
        np.vstack(
            [
                tile.state.acceleration
                for tile in condition(
                    log_of(stamps, SWING.position(EVEN)), turntables(2), FilterOptions(cutoff_hz=10.0)
                ).tiles()
            ]
        )
        for stamps in (EVEN, late)
    )
    assert np.max(np.abs(on_time - bent)) < 1e-3 * np.max(np.abs(on_time))
