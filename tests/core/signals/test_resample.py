"""Uniform stamps are left as they are, others are interpolated, and copies of a row are no measurements."""

import numpy as np

from tests.core.signals.motions import jittered
from veritorque.core.log.model import LogRows
from veritorque.core.signals.resample import is_uniform, on_grid, uniform


def test_samples_on_a_uniform_clock_are_not_touched():
    time = 3.0 + np.arange(100) / 250.0
    rows = LogRows(time, np.random.default_rng(1).normal(size=(100, 2)), np.ones((100, 2)))
    clock, position, torque = uniform(rows, 250.0)
    assert clock is time
    assert position is rows.position
    assert torque is rows.torque


def test_a_clock_is_uniform_up_to_a_thousandth_of_a_step():
    even = np.arange(1000) / 250.0
    assert is_uniform(even + np.where(np.arange(1000) == 500, 0.5e-3 / 250.0, 0.0), 250.0)
    assert not is_uniform(even + np.where(np.arange(1000) == 500, 2e-3 / 250.0, 0.0), 250.0)


def test_a_smooth_motion_is_recovered_between_jittered_stamps():
    time = jittered(np.random.default_rng(2), 500, 100.0, 0.4)
    rows = LogRows(time, np.sin(3.0 * time)[:, None], np.cos(time)[:, None])
    grid = np.arange(10, 490) / 100.0
    position, torque = on_grid(rows, np.cos(time)[:, None], grid)
    assert np.max(np.abs(position[:, 0] - np.sin(3.0 * grid))) < 1e-6
    assert np.max(np.abs(torque[:, 0] - np.cos(grid))) < 1e-4


def test_a_row_that_copies_the_row_before_is_no_measurement():
    time = jittered(np.random.default_rng(3), 500, 100.0, 0.2)
    position, torque = np.sin(3.0 * time)[:, None], np.cos(time)[:, None]
    copied = np.arange(20, 480, 9)
    position[copied], torque[copied] = position[copied - 1], torque[copied - 1]
    grid = np.arange(10, 490) / 100.0
    found, _ = on_grid(LogRows(time, position, torque), torque, grid)
    assert np.max(np.abs(found[:, 0] - np.sin(3.0 * grid))) < 1e-5


def test_rows_that_differ_only_in_current_are_measurements():
    time = jittered(np.random.default_rng(4), 400, 100.0, 0.2)
    position = np.zeros((400, 1))
    current = np.random.default_rng(5).normal(size=(400, 1))
    grid = time[50:350]
    _, effort = on_grid(LogRows(time, position, current=current), current, grid)
    assert np.max(np.abs(effort - current[50:350])) < 1e-12
