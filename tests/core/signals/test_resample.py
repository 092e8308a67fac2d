"""Uniform stamps are left as they are, others are interpolated, and copies of a row are no measurements."""

import numpy as np
import pytest

from tests.core.signals.motions import jittered
from veritorque.core.log.model import LogRows
from veritorque.core.signals.clock import is_uniform
from veritorque.core.signals.resample import efforts_on, positions_on, uniform_positions

NO_LIMITS = np.full(1, np.inf)


def test_samples_on_a_uniform_clock_are_not_touched():
    time = 3.0 + np.arange(100) / 250.0
    position = np.column_stack([np.sin(time), np.cos(3.0 * time)])
    rows = LogRows(time, position, np.ones((100, 2)))
    assert np.array_equal(uniform_positions(rows, 250.0, 5), position)


@pytest.mark.parametrize("scatter", [0.0, 0.2, 0.4])
@pytest.mark.parametrize("missed", [0.0, 0.05], ids=["complete", "rows missing"])
def test_an_absurd_position_changes_nothing_whatever_the_stamps(scatter, missed):
    rng = np.random.default_rng(6)
    time = jittered(rng, 3000, 100.0, scatter)
    time = time[rng.random(3000) >= missed]
    clean = np.column_stack([np.sin(3.0 * time), np.cos(2.0 * time)])
    spoilt = clean.copy()
    spoilt[rng.integers(50, 2500, 20), rng.integers(0, 2, 20)] += rng.choice([-1.0, 0.3, 50.0], 20)
    before, after = (
        uniform_positions(LogRows(time, position, np.zeros_like(position)), 100.0, 5)
        for position in (clean, spoilt)
    )
    # A median stands for the replaced sample: off by no more than two steps of the fastest motion.
    assert np.max(np.abs(before - after)) < 2 * 3.0 / 100.0


def test_a_clock_is_uniform_up_to_a_thousandth_of_a_step():
    even = np.arange(1000) / 250.0
    assert is_uniform(even + np.where(np.arange(1000) == 500, 0.5e-3 / 250.0, 0.0), 250.0)
    assert not is_uniform(even + np.where(np.arange(1000) == 500, 2e-3 / 250.0, 0.0), 250.0)


def test_a_smooth_motion_is_recovered_between_jittered_stamps():
    time = jittered(np.random.default_rng(2), 500, 100.0, 0.4)
    rows = LogRows(time, np.sin(3.0 * time)[:, None], np.cos(time)[:, None])
    grid = np.arange(10, 490) / 100.0
    position, torque = positions_on(grid, rows, 5), efforts_on(grid, rows, NO_LIMITS)
    assert np.max(np.abs(position[:, 0] - np.sin(3.0 * grid))) < 1e-6
    assert np.max(np.abs(torque[:, 0] - np.cos(grid))) < 1e-4


def test_a_row_that_copies_the_row_before_is_no_measurement():
    time = jittered(np.random.default_rng(3), 500, 100.0, 0.2)
    position, torque = np.sin(3.0 * time)[:, None], np.cos(time)[:, None]
    copied = np.arange(20, 480, 9)
    position[copied], torque[copied] = position[copied - 1], torque[copied - 1]
    grid = np.arange(10, 490) / 100.0
    found = positions_on(grid, LogRows(time, position, torque), 5)
    assert np.max(np.abs(found[:, 0] - np.sin(3.0 * grid))) < 1e-5


def test_rows_that_differ_only_in_current_are_measurements():
    time = jittered(np.random.default_rng(4), 400, 100.0, 0.2)
    position = np.zeros((400, 1))
    current = np.random.default_rng(5).normal(size=(400, 1))
    grid = time[50:350]
    effort = efforts_on(grid, LogRows(time, position, current=current), NO_LIMITS)
    assert np.max(np.abs(effort - current[50:350])) < 1e-12
