"""Hold the noise floor to the noise that was put in, with and without a motion that repeats."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.residual.worlds import RATE_HZ, drawn, on_joint, world
from tests.core.estimate.worlds import planar_robot
from veritorque.core.diagnosis.dataset.dataset import Dataset, build_dataset
from veritorque.core.diagnosis.residual.floor import noise_floor
from veritorque.core.diagnosis.residual.period import repeats, shift_rows
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.reader import log_from_arrays

MODEL = standard_model(planar_robot())
TIME = np.arange(int(24.0 * RATE_HZ)) / RATE_HZ


def _look(noise: np.ndarray, *, period: float | None) -> Dataset:
    """Swing two joints, periodically or not, with a torque that is friction and noise."""
    pace = 2.0 * np.pi * np.array([[1.0, 2.0, 5.0], [2.0, 3.0, 4.0]]) / (period or 7.0)
    if period is None:
        pace = pace * np.array([[1.0, np.sqrt(2.0), np.sqrt(1.7)], [np.sqrt(3.0), 1.1, np.sqrt(0.5)]])
    position = np.sin(TIME[:, None, None] * pace + np.array([0.0, 1.0, 2.0])).sum(axis=2)
    velocity = (pace * np.cos(TIME[:, None, None] * pace + np.array([0.0, 1.0, 2.0]))).sum(axis=2)
    torque = 3.0 * position + np.sign(velocity) + noise
    return build_dataset(
        MODEL, (log_from_arrays("swing", TIME, position, torque),), held_out=frozenset(), blocks=20
    )


def _in_band(dataset: Dataset, noise: np.ndarray) -> np.ndarray:
    segment = dataset.motions[0].segments[0]
    rows = segment.parallel.apply(np.ascontiguousarray(noise.T), 0, segment.kept).T
    return np.sqrt(np.mean(rows**2, axis=0))


@pytest.mark.parametrize("period", [6.0, 7.3456])
def test_the_period_of_a_motion_is_found_between_the_rows(period):
    dataset = _look(np.zeros((len(TIME), 2)), period=period)
    assert repeats(dataset).period == pytest.approx(period, rel=1e-5)


def test_a_motion_that_never_repeats_has_no_period():
    assert repeats(_look(np.zeros((len(TIME), 2)), period=None)) is None


def test_the_shipped_log_repeats_after_its_base_period():
    assert repeats(world().dataset).period == pytest.approx(12.0, abs=1e-6)


@pytest.mark.parametrize("kind", ["white", "ar_0.8", "hum"])
def test_repeats_give_the_noise_of_any_colour_though_the_torque_holds_all_of_the_motion(kind):
    noise = drawn(kind, np.random.default_rng(1), len(TIME), 2)
    dataset = _look(noise, period=6.0)
    found = noise_floor(dataset, dataset.torque)
    assert found.source == ("repeats", "repeats")
    # about 1,000 rows of 2 to 10 rows' memory: one deviation is 3 to 7 %
    np.testing.assert_allclose(found.rms, _in_band(dataset, noise), rtol=0.2)


def test_without_repeats_the_high_band_gives_the_floor_of_white_noise_whatever_the_motion():
    noise = 0.3 * drawn("white", np.random.default_rng(2), len(TIME), 2)
    dataset = _look(noise, period=None)
    found = noise_floor(dataset, dataset.torque)
    assert found.source == ("high_band", "high_band")
    np.testing.assert_allclose(found.rms, _in_band(dataset, noise), rtol=0.1)
    np.testing.assert_allclose(found.tilt, 1.0, rtol=0.2)


def test_hum_is_a_line_that_does_not_lift_the_high_band():
    rng = np.random.default_rng(3)
    quiet = drawn("white", rng, len(TIME), 2)
    humming = quiet + np.sqrt(2.0) * np.sin(2.0 * np.pi * 50.0 * TIME)[:, None]
    floors = [
        noise_floor(dataset, dataset.torque).rms
        for dataset in (_look(one, period=None) for one in (quiet, humming))
    ]
    np.testing.assert_allclose(floors[1], floors[0], rtol=0.1)


def test_the_tilt_warns_where_noise_grows_towards_low_frequencies():
    noise = drawn("ar_0.98", np.random.default_rng(4), len(TIME), 2)
    dataset = _look(noise, period=None)
    found = noise_floor(dataset, dataset.torque)
    assert (found.tilt > 1.5).all()
    assert (found.rms < _in_band(dataset, noise)).all()


def test_what_a_model_gets_wrong_in_every_repeat_is_not_noise():
    here = world()
    noise = here.noise("white", seed=51)
    wrong = on_joint(here, 2, np.cos(9.0 * here.dataset.state.position[:, 1]))
    quiet, lifted = (noise_floor(here.dataset, one) for one in (noise, noise + 5.0 * wrong))
    assert set(quiet.source + lifted.source) == {"repeats"}
    np.testing.assert_allclose(lifted.rms, quiet.rms, rtol=0.02)


def test_where_no_way_is_open_the_floor_is_unknown():
    noise = drawn("white", np.random.default_rng(5), len(TIME), 2)
    dataset = _look(noise, period=None)
    motion = dataset.motions[0]
    wide = replace(motion, recipe=replace(motion.recipe, cutoff_hz=90.0))
    found = noise_floor(replace(dataset, motions=(wide,)), dataset.torque)
    assert found.source == ("none", "none")
    assert np.isnan(found.rms).all()


@pytest.mark.parametrize("shift", [3.0, 7.25, 12.5, 40.9])
def test_a_series_between_its_rows_is_that_of_its_spectrum(shift):
    rows = np.arange(400.0)
    series = np.column_stack([np.sin(0.3 * rows), np.cos(2.0 * rows)])
    later = shift_rows(series, shift)
    exact = np.column_stack([np.sin(0.3 * (rows + shift)), np.cos(2.0 * (rows + shift))])[: len(later)]
    # 2 rad per row is two thirds of the Nyquist frequency, where the parallel filter ends.
    np.testing.assert_allclose(later[30:], exact[30:], atol=2e-3)
