"""The band that noise of positions leaves: its floor, how it moves, and where there is no bound."""

import json

import numpy as np
import pytest
from scipy import signal

from tests.core.signals.motions import Multisine, log_of
from tests.measured import measured_log
from tests.tools import shared
from veritorque.core.robot.description import robot_from_description
from veritorque.core.signals.noise_band import noise_cutoff, noise_floor
from veritorque.core.signals.recipe import PARALLEL_OVER_MOTION, FilterOptions, choose_recipe
from veritorque.core.study import IdentifyRequest, identify_in_full

RATE_HZ = 250.0
TIME = np.arange(15_000) / RATE_HZ
MOVING = np.array([True])


def _wandering(highest_hz: float = 1.0) -> np.ndarray:
    """Give a motion of many sines, whose acceleration its position does not tell."""
    rng = np.random.default_rng(4)
    parts = (Multisine.random(rng, 1, highest_hz=highest_hz).position(TIME) for _ in range(12))
    return np.sum(list(parts), axis=0) / 4.0


def _noise(size: float) -> np.ndarray:
    return size * np.random.default_rng(5).normal(size=(len(TIME), 1))


@pytest.mark.parametrize("size", [1e-5, 1e-3])
def test_the_floor_is_the_density_of_the_noise_beside_a_motion_a_hundred_thousand_times_its_size(size):
    floor = noise_floor(_wandering() + _noise(size), RATE_HZ, 1.0)
    assert floor[0] == pytest.approx(2.0 * size**2 / RATE_HZ, rel=0.4)


def test_steps_of_acceleration_as_of_a_joint_that_sticks_are_not_taken_for_noise():
    rng = np.random.default_rng(6)
    steps = np.repeat(rng.normal(size=len(TIME) // 50), 50) * 0.3
    kinks = np.cumsum(np.cumsum(steps - steps.mean()) / RATE_HZ) / RATE_HZ
    smooth = signal.sosfiltfilt(signal.butter(2, 0.2, "high", fs=RATE_HZ, output="sos"), kinks)
    floor = noise_floor(_wandering() + smooth[:, None] + _noise(1e-6), RATE_HZ, 1.0)
    assert floor[0] < 1e4 * 2.0 * 1e-6**2 / RATE_HZ
    assert noise_cutoff([_wandering() + smooth[:, None]], RATE_HZ, 1.0, MOVING) > 10.0


def test_a_hundred_times_the_noise_lowers_the_band_by_the_fifth_root_of_its_square():
    quiet, loud = (noise_cutoff([_wandering() + _noise(size)], RATE_HZ, 1.0, MOVING) for size in (1e-5, 1e-3))
    assert quiet / loud == pytest.approx(100.0**0.4, rel=0.1)


def test_a_motion_of_one_sine_tells_its_acceleration_and_has_no_bound():
    sine = np.sin(2.0 * np.pi * TIME)[:, None]
    assert noise_cutoff([sine + _noise(1e-5)], RATE_HZ, 1.0, MOVING) == np.inf


@pytest.mark.parametrize(("size", "bounded"), [(1e-6, False), (3e-2, True)])
def test_the_recipe_is_narrow_and_says_why_only_where_positions_are_noisy(size, bounded):
    position = _wandering() + _noise(size)
    recipe = choose_recipe(log_of(TIME, position), FilterOptions())
    assert (recipe.cutoff_hz < 0.9 * PARALLEL_OVER_MOTION * recipe.motion_band_hz) == bounded
    assert ("noise of positions" in recipe.reason) == bounded


@pytest.mark.parametrize(("seconds", "pause"), [(20, 0.0), (24, 0.0), (24, 300.0)])
def test_however_noisy_positions_are_a_hundred_samples_are_kept_where_the_motion_has_them(seconds, pause):
    """Also where the recorder paused before the last four seconds."""
    rows = int(seconds * RATE_HZ)
    time, position = TIME[:rows] + pause * (TIME[:rows] > 20.0), (_wandering(0.5) + _noise(0.01))[:rows]
    recipe = choose_recipe(log_of(time, position), FilterOptions())
    assert 100 <= rows / recipe.decimation < 110
    assert "keeps 100 samples" in recipe.reason
    assert recipe.cutoff_hz < PARALLEL_OVER_MOTION * recipe.motion_band_hz


@pytest.mark.parametrize(("held_out", "most"), [(4, 17.0), (1, 30.0)])
def test_a_measured_pendulum_with_noisy_positions_is_explained_on_motion_it_has_not_seen(held_out, most):
    described = json.loads(shared("data/double_pendulum/robot.json").read_text())
    numbers = [run for run in (1, 2, 3, 4) if run != held_out] + [held_out]
    logs = tuple(measured_log("double_pendulum", f"sys_id_{run}") for run in numbers)
    options = {"bootstrap": {"draws": 0}, "validation": {"logs": [4]}}
    found = identify_in_full(IdentifyRequest(robot_from_description(described), logs, options))
    assert found.validation_total_percent < most


def test_the_noisiest_of_several_joints_decides_and_one_that_stands_does_not():
    position = np.hstack([_wandering(1.0) + _noise(1e-5), _wandering(0.8) + _noise(1e-3)])
    both = noise_cutoff([position], RATE_HZ, 1.0, np.array([True, True]))
    first = noise_cutoff([position], RATE_HZ, 1.0, np.array([True, False]))
    assert first > 3.0 * both
