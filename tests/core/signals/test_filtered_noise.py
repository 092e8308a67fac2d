"""The noise of positions: read off beside motion, and what the real filters leave of it in accelerations."""

import numpy as np
import pytest

from tests.core.estimate.worlds import planar_robot
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.signals.condition import condition
from veritorque.core.signals.filtered_noise import acceleration_variance
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.signals.white_noise import white_noise

RATE_HZ, SECONDS = 500.0, 120.0
TIME = np.arange(int(RATE_HZ * SECONDS)) / RATE_HZ
SIZES = np.array([1e-3, 3e-3])


@pytest.mark.parametrize(
    "asked",
    [{"cutoff_hz": 20.0}, {"cutoff_hz": 60.0, "order": 3}, {"cutoff_hz": 5.0, "position_cutoff_hz": 6.0}],
)
def test_the_variance_is_that_of_noise_that_passed_the_filters(asked):
    noise = SIZES * np.random.default_rng(1).normal(size=(len(TIME), 2))
    log = log_from_arrays("noise", TIME, TIME[:, None] + noise, noise)
    motion = condition(log, planar_robot(), FilterOptions(median_order=1, **asked))
    passed = np.hstack([tile.filtered(tile.state.acceleration.T.copy()) for tile in motion.tiles()])
    np.testing.assert_allclose(acceleration_variance([motion]), np.var(passed, axis=1), rtol=0.1)


@pytest.mark.parametrize("size", [1e-6, 1e-4, 1e-2])
def test_noise_is_read_off_beside_motion_with_steps_of_its_acceleration(size):
    steps = np.repeat(np.random.default_rng(2).normal(size=len(TIME) // 250), 250)
    motion = np.sin(TIME) + np.cumsum(np.cumsum(steps)) / RATE_HZ**2
    noisy = motion + size * np.random.default_rng(3).normal(size=len(TIME))
    assert white_noise(noisy[:, None])[0] == pytest.approx(size, rel=0.05)


def test_the_noise_of_a_coarse_encoder_is_that_of_rounding():
    step = 1e-4
    rounded = step * np.round(np.sin(TIME) / step)
    assert white_noise(rounded[:, None])[0] == pytest.approx(step / np.sqrt(12.0), rel=0.1)
