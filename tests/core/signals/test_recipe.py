"""A recipe follows the motion, says why, and never looks at the torque."""

import numpy as np
import pytest

from tests.core.signals.motions import Multisine, jittered, log_of, turntables
from veritorque.core.errors import OptionError
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions, Recipe, choose_recipe

RATE_HZ = 500.0


def _recipe(
    options: FilterOptions | None = None, *, pace: float = 1.0, torque: np.ndarray | None = None
) -> Recipe:
    time = np.arange(30_000) / RATE_HZ
    swing = Multisine.random(np.random.default_rng(1), 3, highest_hz=1.0)
    return choose_recipe(log_of(time, swing.position(pace * time), torque), options or FilterOptions())


@pytest.mark.parametrize("pace", [0.5, 2.0, 4.0])
def test_a_motion_played_faster_gets_cut_offs_as_much_higher(pace):
    # The spectrum is read in steps of 1/8 Hz.
    slow, fast = _recipe(), _recipe(pace=pace)
    assert abs(fast.motion_band_hz - pace * slow.motion_band_hz) <= 0.13 * (1.0 + pace)
    assert fast.cutoff_hz / slow.cutoff_hz == pytest.approx(fast.motion_band_hz / slow.motion_band_hz)
    assert fast.position_cutoff_hz > 3.0 * fast.cutoff_hz


def test_the_band_holds_the_motion():
    swing = Multisine.random(np.random.default_rng(1), 3, highest_hz=1.0)
    assert 0.8 * swing.frequency_hz.max() < _recipe().motion_band_hz < swing.frequency_hz.max() + 0.5


def test_the_torque_has_no_say_in_the_recipe():
    noise = 10.0 * np.random.default_rng(2).normal(size=(30_000, 3))
    one, other = _recipe(), _recipe(torque=noise)
    assert (one.cutoff_hz, one.position_cutoff_hz, one.decimation) == (
        other.cutoff_hz,
        other.position_cutoff_hz,
        other.decimation,
    )
    assert np.array_equal(one.still_speed, other.still_speed)


def _white(position: np.ndarray, size: float) -> np.ndarray:
    return position + size * np.random.default_rng(3).normal(size=position.shape)


def _rounded(position: np.ndarray, step: float) -> np.ndarray:
    return step * np.round(position / step)


@pytest.mark.parametrize(("spoilt", "size"), [(_white, 1e-5), (_white, 5e-3), (_rounded, 1e-2)])
def test_encoder_noise_does_not_widen_the_band(spoilt, size):
    """The power of its velocity grows with the square of frequency, and is not the motion's."""
    time = np.arange(30_000) / RATE_HZ
    swing = Multisine.random(np.random.default_rng(1), 3, highest_hz=1.0)
    noisy = choose_recipe(log_of(time, spoilt(swing.position(time), size)), FilterOptions())
    assert abs(noisy.motion_band_hz - _recipe().motion_band_hz) < 0.3


@pytest.mark.parametrize("scatter", [0.0, 0.2], ids=["even stamps", "scattered stamps"])
def test_single_absurd_samples_are_not_taken_for_quick_motion(scatter):
    rng = np.random.default_rng(6)
    time = jittered(rng, 30_000, RATE_HZ, scatter)
    position = Multisine.random(np.random.default_rng(1), 3, highest_hz=1.0).position(time)
    position[rng.integers(0, len(time), 200), rng.integers(0, 3, 200)] += 0.5
    recipe = choose_recipe(log_of(time, position), FilterOptions())
    assert recipe.motion_band_hz == pytest.approx(_recipe().motion_band_hz, abs=0.13)
    # The sharper side of the claim: without the median the same samples are noise, which narrows the filter.
    without = choose_recipe(log_of(time, position), FilterOptions(median_order=1))
    assert without.cutoff_hz < recipe.cutoff_hz / 5.0


def test_stamps_that_scatter_in_milliseconds_taken_for_seconds_still_give_a_recipe():
    # A window of a minute then holds fifteen rows or fourteen.
    time = jittered(np.random.default_rng(3), 4_000, 250.0, 0.3)
    position = Multisine.random(np.random.default_rng(1), 3, highest_hz=1.0).position(time)
    assert choose_recipe(log_of(1e3 * time, position), FilterOptions()).motion_band_hz < 0.125


def test_rows_that_a_recorder_copied_are_not_taken_for_jumps():
    time = np.arange(30_000) / RATE_HZ
    position = Multisine.random(np.random.default_rng(1), 3, highest_hz=1.0).position(time)
    torque = np.random.default_rng(7).normal(size=(30_000, 3))
    clean = choose_recipe(log_of(time, position.copy(), torque.copy()), FilterOptions())
    for first in range(2000, 30_000, 4000):
        position[first : first + 20] = position[first]
        torque[first : first + 20] = torque[first]
    copied = choose_recipe(log_of(time, position, torque), FilterOptions())
    assert copied.motion_band_hz == pytest.approx(clean.motion_band_hz, abs=0.13)
    # The sharper side of the claim: the same jumps do widen the band where torques show them to be measured.
    fresh = np.random.default_rng(8).normal(size=(30_000, 3))
    assert choose_recipe(log_of(time, position, fresh), FilterOptions()).motion_band_hz > 5.0


def test_a_cut_off_far_below_the_motion_is_refused_at_once():
    with pytest.raises(OptionError) as refusal:
        _recipe(FilterOptions(cutoff_hz=10.0, position_cutoff_hz=0.001))
    assert refusal.value.evidence["motion_band_hz"] == pytest.approx(_recipe().motion_band_hz)


def test_what_is_asked_for_is_what_is_done():
    recipe = _recipe(FilterOptions(3, 8.0, 33.0, 4, 7))
    assert (recipe.median_order, recipe.cutoff_hz, recipe.position_cutoff_hz) == (3, 8.0, 33.0)
    assert (recipe.order, recipe.decimation) == (4, 7)
    assert "given" in recipe.reason


def test_the_reason_names_the_motions_band():
    recipe = _recipe()
    assert f"{recipe.motion_band_hz:.3g} Hz" in recipe.reason


def test_a_log_too_slow_for_its_motion_still_gets_filters_below_half_its_rate():
    time = np.arange(600) / 20.0
    position = Multisine.random(np.random.default_rng(4), 2, highest_hz=6.0).position(time)
    recipe = choose_recipe(log_of(time, position), FilterOptions())
    assert 0.0 < recipe.cutoff_hz <= recipe.position_cutoff_hz < 10.0
    assert recipe.decimation >= 1


@pytest.mark.parametrize(
    "options", [{"cutoff_hz": 250.0}, {"position_cutoff_hz": 300.0}, {"cutoff_hz": float("nan")}]
)
def test_a_cut_off_that_does_not_fit_the_rate_is_refused_with_the_rate(options):
    with pytest.raises(OptionError) as refusal:
        _recipe(FilterOptions(**options))
    assert refusal.value.evidence["rate_hz"] == pytest.approx(RATE_HZ)


def test_a_cut_off_of_zero_is_refused_and_not_taken_for_none():
    with pytest.raises(OptionError):
        _recipe(FilterOptions(cutoff_hz=0.0))


@pytest.mark.parametrize(
    "wrong",
    [
        {"median_order": 4},
        {"median_order": 33},
        {"median_order": -1},
        {"decimation": 0},
        {"decimation": 1001},
    ],
)
def test_options_that_make_no_sense_are_refused_by_name(wrong):
    with pytest.raises(OptionError) as refusal:
        FilterOptions(**wrong)
    assert set(refusal.value.evidence) == set(wrong)


def test_a_joint_that_only_trembles_does_not_widen_the_band():
    time = np.arange(30_000) / RATE_HZ
    position = Multisine.random(np.random.default_rng(1), 3, highest_hz=1.0).position(time)
    position[:, 2] = 0.3 + 1e-5 * np.random.default_rng(5).normal(size=len(time))
    assert choose_recipe(log_of(time, position), FilterOptions()).motion_band_hz < 1.5


def slow_bus(rates_hz, gap_s, seed=0):
    """Log a swing over a serial bus: stretches of two seconds at rates of their own, with gaps between."""
    rng = np.random.default_rng(seed)
    steps = []
    for rate in rates_hz:
        steps += [*(rng.uniform(0.8, 1.2, int(2.0 * rate)) / rate), gap_s]
    time = np.cumsum([0.0, *steps[:-1]])
    position = 0.5 * np.sin(2 * np.pi * 0.25 * time) + 0.3 * np.sin(2 * np.pi * 0.6 * time)
    return log_of(time, position[:, None])


@pytest.mark.parametrize("rates_hz", [[32.0, 22.0] * 8, [25.0, 40.0, 28.0] * 6, [250.0, 140.0] * 5])
@pytest.mark.parametrize("gap_s", [0.12, 0.5])
def test_a_filter_can_be_built_in_every_stretch_however_their_rates_differ(rates_hz, gap_s):
    motion = condition(slow_bus(rates_hz, gap_s), turntables(1))
    slowest = min(segment.rate_hz for segment in motion.segments)
    assert motion.recipe.position_cutoff_hz < 0.5 * slowest
    assert sum(len(tile.time) for tile in motion.tiles()) > 0


def test_a_stretch_at_a_fraction_of_the_rate_does_not_narrow_the_band_of_the_others():
    motion = condition(slow_bus([250.0, 250.0, 12.0, 250.0], 0.5), turntables(1))
    assert [round(segment.rate_hz, -1) for segment in motion.segments] == [250.0, 250.0, 250.0]


@pytest.mark.parametrize(("gap_s", "segments"), [(0.12, 1), (0.5, 8)])
def test_a_gap_of_a_few_steps_of_a_slow_bus_is_bridged_where_the_motion_is_slower_still(gap_s, segments):
    assert len(slow_bus([30.0] * 8, gap_s).segments) == segments


def _turn_and_slide(slide_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Turn by some rad/s beside a slide of the given stroke (m), both with their encoder's noise."""
    time = np.arange(6000) / RATE_HZ
    position = Multisine.random(np.random.default_rng(5), 2, highest_hz=1.0).position(time)
    noise = np.random.default_rng(6).normal(size=position.shape) * (1e-6, 1e-7)
    return time, position * (3.0, slide_m) + noise


SLIDES = np.array([False, True])


def test_a_slide_of_millimetres_a_second_moves_beside_a_turn_of_radians_a_second():
    time, position = _turn_and_slide(0.005)
    recipe = choose_recipe(log_of(time, position), FilterOptions(), SLIDES)
    assert recipe.rms_speed[1] < 0.01 * recipe.rms_speed[0]
    np.testing.assert_allclose(recipe.still_speed, 0.01 * recipe.rms_speed)
    # The sharper side of the claim: a second turn that is as slow is held, and trembles.
    turns = choose_recipe(log_of(time, position), FilterOptions())
    assert turns.still_speed[1] > turns.rms_speed[1]


def test_metres_written_as_millimetres_change_nothing():
    time, position = _turn_and_slide(0.005)
    metres = choose_recipe(log_of(time, position), FilterOptions(), SLIDES)
    millimetres = choose_recipe(log_of(time, position * (1.0, 1000.0)), FilterOptions(), SLIDES)
    assert millimetres.cutoff_hz == metres.cutoff_hz
    np.testing.assert_allclose(millimetres.still_speed, metres.still_speed * (1.0, 1000.0), rtol=1e-6)


def test_a_slide_that_its_drive_holds_stands_throughout_and_does_not_set_the_band():
    time, position = _turn_and_slide(0.0)
    recipe = choose_recipe(log_of(time, position), FilterOptions(), SLIDES)
    assert recipe.still_speed[1] > 5.0 * recipe.rms_speed[1] > 0.0
    turn = choose_recipe(log_of(time, position[:, :1]), FilterOptions())
    assert recipe.motion_band_hz == turn.motion_band_hz
