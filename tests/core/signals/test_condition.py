"""From a log to a motion: true derivatives at the true instants, no seams, nothing that cannot be known."""

import numpy as np
import pytest

from tests.core.signals.motions import Multisine, jittered, log_of, turntables
from veritorque.core.errors import LogError
from veritorque.core.log.model import JointLog
from veritorque.core.signals import condition as conditioning
from veritorque.core.signals.condition import Motion, condition, without_standstill_mask
from veritorque.core.signals.recipe import FilterOptions

RATE_HZ = 250.0
PLAIN = FilterOptions(cutoff_hz=10.0, position_cutoff_hz=40.0, decimation=10)
SMOOTH = FilterOptions(1, 10.0, 40.0, decimation=10)
"""Without the median, which flattens the summits of a motion by up to the sagitta of its five samples."""


def _kept(motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give decimated samples, motion (position, velocity, acceleration) at them, and which are usable."""
    time, states, usable = [], [], []
    for tile in motion.tiles():
        at = tile.first + tile.parallel.decimation * np.arange(len(tile.time))
        time.append(tile.time)
        states.append(np.stack([tile.state.position, tile.state.velocity, tile.state.acceleration])[:, at])
        usable.append(tile.usable)
    return np.concatenate(time), np.concatenate(states, axis=1), np.concatenate(usable)


def _conditioned(log: JointLog, options: FilterOptions = PLAIN, **more: int) -> Motion:
    return condition(log, turntables(log.joints), options, **more)


def _swing(seconds: float = 30.0) -> tuple[np.ndarray, Multisine]:
    return np.arange(int(seconds * RATE_HZ)) / RATE_HZ, Multisine.random(np.random.default_rng(1), 2)


def test_a_polynomial_motion_keeps_its_position_velocity_and_acceleration_at_every_usable_instant():
    time = np.arange(2500) / RATE_HZ
    middle = time - 5.0
    path = np.column_stack([0.4 + 0.3 * middle + 0.2 * middle**2, 1.0 - 0.7 * middle**2])
    speed = np.column_stack([0.3 + 0.4 * middle, -1.4 * middle])
    growth = np.column_stack([np.full_like(time, 0.4), np.full_like(time, -1.4)])
    at, states, usable = _kept(_conditioned(log_of(time, path), SMOOTH))
    index = np.rint(at * RATE_HZ).astype(int)
    assert usable.mean() > 0.8
    for found, true, tolerance in zip(states, (path, speed, growth), (1e-7, 1e-6, 1e-4), strict=True):
        assert np.max(np.abs(found - true[index])[usable]) < tolerance


def test_velocity_and_acceleration_of_a_sine_miss_only_what_the_differences_promise():
    time, swing = _swing()
    at, states, usable = _kept(_conditioned(log_of(time, swing.position(time)), SMOOTH))
    pace = 2.0 * np.pi * swing.frequency_hz.max() / RATE_HZ
    for order, share in ((0, 1e-5), (1, pace**2 / 6.0 + 1e-5), (2, pace**2 / 3.0 + 2e-4)):
        true = swing.derivative(at, order)
        assert np.max(np.abs(states[order] - true)[usable]) < share * np.abs(true).max()


def test_a_shift_by_one_sample_would_be_seen():
    time, swing = _swing()
    at, states, usable = _kept(_conditioned(log_of(time, swing.position(time))))
    late = swing.derivative(at - 1.0 / RATE_HZ, 1)
    assert np.max(np.abs(states[1] - late)[usable]) > 5e-3 * np.abs(late).max()


@pytest.mark.parametrize("stamped", [False, True], ids=["even clock", "real stamps"])
@pytest.mark.parametrize("kept", [1, 7, 100])
def test_tiles_leave_no_seams(monkeypatch, kept, stamped):
    time, swing = _swing()
    if stamped:
        time = jittered(np.random.default_rng(2), len(time), RATE_HZ, 0.3)
    position = swing.position(time)
    position[2000:2400] = position[2000]
    torque = np.random.default_rng(3).normal(size=position.shape)
    for first, copies in ((1, 1), (700, 3), (1300, 15), (len(time) - 4, 4)):
        position[first : first + copies] = position[first - 1]
        torque[first : first + copies] = torque[first - 1]
    log = log_of(time, position, torque)
    whole = _filtered(_conditioned(log))
    monkeypatch.setattr(conditioning, "TILE_KEPT", kept)
    cut = _filtered(_conditioned(log))
    for one, other in zip(whole, cut, strict=True):
        assert np.max(np.abs(one.astype(float) - other)) < 1e-8 * max(1.0, np.abs(one).max())


def test_a_standstill_that_begins_just_after_a_tile_is_known_to_last(monkeypatch):
    # At 100 Hz the parallel filter sees 0.17 s ahead, less than the 0.2 s that make a standstill.
    rate_hz = 1000.0
    time = np.arange(4000) / rate_hz
    position = np.sin(2.0 * np.pi * np.minimum(time, 1.25))[:, None]
    log = log_of(time, position)
    options = FilterOptions(1, cutoff_hz=100.0, position_cutoff_hz=300.0, decimation=4)
    whole = _filtered(_conditioned(log, options))[-1]
    monkeypatch.setattr(conditioning, "TILE_KEPT", 1)
    assert np.array_equal(_filtered(_conditioned(log, options))[-1], whole)


def _filtered(motion: Motion) -> tuple[np.ndarray, ...]:
    tiles = list(motion.tiles())
    return (
        np.concatenate([tile.time for tile in tiles]),
        np.vstack([tile.filtered(np.ascontiguousarray(tile.state.acceleration.T)).T for tile in tiles]),
        np.vstack([tile.filtered(np.ascontiguousarray(tile.torque.T)).T for tile in tiles]),
        np.vstack([tile.usable for tile in tiles]),
    )


@pytest.mark.parametrize("blocks", [1, 3, 20])
def test_blocks_share_the_kept_instants_evenly_and_in_order(blocks):
    time, swing = _swing()
    motion = _conditioned(log_of(time, swing.position(time)), blocks=blocks)
    owners = np.concatenate([tile.block for tile in motion.tiles()])
    assert len(owners) == motion.kept
    assert np.array_equal(owners, np.sort(owners))
    shares = np.bincount(owners, minlength=blocks)
    assert len(shares) == blocks
    assert shares.max() - shares.min() <= 1


def test_real_stamps_are_honoured_where_a_forced_clock_bends_the_accelerations():
    rng = np.random.default_rng(4)
    swing = Multisine.random(rng, 2)
    stamps = jittered(rng, 7500, RATE_HZ, 0.4)
    position = swing.position(stamps)
    honoured = _acceleration_error(log_of(stamps, position), swing)
    forced = _acceleration_error(log_of(np.arange(7500) / RATE_HZ, position), swing)
    even = np.arange(7500) / RATE_HZ
    uniform = _acceleration_error(log_of(even, swing.position(even)), swing)
    assert honoured < uniform + 1e-3
    assert forced > 20.0 * honoured


def _acceleration_error(log: JointLog, swing: Multisine) -> float:
    at, states, usable = _kept(_conditioned(log, SMOOTH))
    true = swing.derivative(at, 2)
    return float(np.max(np.abs(states[2] - true)[usable]) / np.abs(true).max())


def test_rows_that_were_never_recorded_do_not_bend_the_motion():
    rng = np.random.default_rng(5)
    swing = Multisine.random(rng, 2)
    time = np.arange(7500) / RATE_HZ
    stamps = time[np.sort(rng.choice(7500, 5600, replace=False))]
    log = log_of(stamps, swing.position(stamps))
    assert _acceleration_error(log, swing) < 0.02
    default = condition(log, turntables(2))
    assert next(iter(default.tiles())).state.position.shape[1] == 2


@pytest.mark.parametrize("stamped", [False, True], ids=["even clock", "real stamps"])
def test_a_robot_that_stands_still_to_the_last_digit_is_not_made_to_move(stamped):
    rate_hz, samples = 100.0, 3000
    time = jittered(np.random.default_rng(6), samples, rate_hz, 0.3 * stamped)
    path = np.sin(np.minimum(time, 9.7)) + 0.2 * np.maximum(time - 20.0, 0.0)
    counted = np.round(2000.0 * path[:, None]) / 2000.0
    log = log_of(time, counted, np.sign(counted))
    at, states, usable = _kept(_conditioned(log, FilterOptions(1, 5.0, 20.0, decimation=2)))
    standing = (at > 11.0) & (at < 19.0)
    assert np.max(np.abs(states[1][standing])) < 1e-4
    assert not usable[standing].any()


def test_gaps_split_the_motion_and_nothing_is_differentiated_across_them():
    swing = Multisine.random(np.random.default_rng(7), 2)
    time = np.concatenate([np.arange(2500) / RATE_HZ, 15.0 + np.arange(2500) / RATE_HZ])
    position = swing.position(time)
    position[2500:] += 2.0
    log = log_of(time, position)
    assert log.segments == ((0, 2500), (2500, 5000))
    at, states, usable = _kept(_conditioned(log, SMOOTH))
    assert not ((at > 10.0) & (at < 15.0)).any()
    true = swing.derivative(at, 1)
    assert np.max(np.abs(states[1] - true)[usable]) < 1e-2
    assert usable[at < 10.0].mean() > 0.8
    assert usable[at >= 15.0].mean() > 0.8


def test_a_stretch_between_gaps_that_is_too_short_is_left_out():
    time = np.concatenate([np.arange(2500) / RATE_HZ, 15.0 + np.arange(100) / RATE_HZ])
    swing = Multisine.random(np.random.default_rng(8), 1)
    at, _, _ = _kept(_conditioned(log_of(time, swing.position(time))))
    assert at.max() < 10.0


@pytest.mark.parametrize(("rows", "parts", "apart_s"), [(100, 4, 15.0), (5, 200, 0.1)])
def test_a_log_without_a_stretch_that_is_long_enough_is_refused_in_words(rows, parts, apart_s):
    """Bursts of five rows are too short even to be looked at."""
    time = np.concatenate([apart_s * part + np.arange(rows) / RATE_HZ for part in range(parts)])
    swing = Multisine.random(np.random.default_rng(8), 1)
    with pytest.raises(LogError, match="no stretch of the log between its gaps is long enough"):
        _conditioned(log_of(time, swing.position(time)))


def _pausing() -> tuple[np.ndarray, np.ndarray]:
    """Let the second joint rest from 10 to 12 s, and go on from where it is."""
    time, swing = _swing()
    position = swing.position(time)
    moving = position[2500:-500, 1].copy()
    position[2500:3000, 1], position[3000:, 1] = position[2500, 1], moving
    return time, position


def test_log_ends_and_standstill_are_left_out_for_the_joint_concerned_only():
    time, position = _pausing()
    at, _, usable = _kept(_conditioned(log_of(time, position)))
    standing = (at > 10.1) & (at < 11.9)
    assert not usable[standing, 1].any()
    assert usable[standing, 0].all()
    assert not usable[[0, -1]].any()
    assert usable[(at > 1.0) & (at < 29.0), 0].mean() > 0.95


def test_standstill_counts_where_it_is_asked_for():
    time, position = _pausing()
    at, _, usable = _kept(without_standstill_mask(_conditioned(log_of(time, position))))
    assert usable[(at > 1.0) & (at < 29.0)].all()
    assert not usable[[0, -1]].any()


def test_a_single_absurd_position_does_not_reach_the_motion():
    time, swing = _swing()
    spoilt = swing.position(time)
    clean = _kept(_conditioned(log_of(time, spoilt)))[1]
    spoilt[3333, 0] += 50.0
    dirty = _kept(_conditioned(log_of(time, spoilt)))[1]
    assert np.max(np.abs(clean - dirty)[:2]) < 1e-3
    assert np.max(np.abs(clean - _kept(_conditioned(log_of(time, spoilt), SMOOTH))[1])[0]) > 0.1


@pytest.mark.parametrize("stamped", [False, True], ids=["even clock", "scattered stamps"])
def test_a_spike_of_a_torque_does_not_reach_what_is_fitted(stamped):
    time, swing = _swing()
    if stamped:
        time = jittered(np.random.default_rng(2), len(time), RATE_HZ, 0.3)
    position, torque = swing.position(time), np.cos(swing.position(time))
    clean = _filtered(_conditioned(log_of(time, position, torque)))[0]
    spoilt = torque.copy()
    spoilt[[1000, 3333], [0, 1]] += [1e6, -3.0]
    assert np.max(np.abs(clean - _filtered(_conditioned(log_of(time, position, spoilt)))[0])) < 1e-3


def test_a_log_of_another_robot_is_refused():
    time, swing = _swing(4.0)
    with pytest.raises(LogError) as refusal:
        condition(log_of(time, swing.position(time)), turntables(3))
    assert refusal.value.evidence["log_joints"] == 2
    assert refusal.value.evidence["robot_joints"] == 3


def test_a_joint_that_its_drive_holds_while_others_move_counts_as_standing():
    time, swing = _swing()
    position = swing.position(time)
    position[:, 1] = 0.4 + 1e-5 * np.round(np.random.default_rng(3).normal(size=len(time)))
    _, _, usable = _kept(_conditioned(log_of(time, position)))
    assert usable[:, 0].mean() > 0.9
    assert usable[:, 1].mean() < 0.05


def test_a_joint_whose_torque_was_not_measured_has_no_equations():
    time, swing = _swing()
    position = swing.position(time)
    torque = np.cos(position)
    torque[:, 1] = 0.0
    _, _, usable = _kept(_conditioned(log_of(time, position, torque)))
    assert usable[:, 0].mean() > 0.9
    assert not usable[:, 1].any()


def test_rows_that_a_recorder_copied_while_the_robot_moved_on_bend_nothing():
    time, swing = _swing()
    position, torque = swing.position(time), np.cos(swing.position(time))
    clean = _kept(_conditioned(log_of(time, position, torque), SMOOTH))
    position[3000:3100], torque[3000:3100] = position[2999], torque[2999]
    cut = _kept(_conditioned(log_of(time, position, torque), SMOOTH))
    assert cut[2].mean() > 0.9
    near = np.abs(cut[0][:, None] - clean[0]).min(axis=1) < 1e-9
    there = np.searchsorted(clean[0], cut[0][near] - 1e-9)
    good = cut[2][near] & clean[2][there]
    assert good.sum() > 0.4 * good.size
    np.testing.assert_allclose(cut[1][:, near][:, good], clean[1][:, there][:, good], atol=1e-2)


def test_what_was_missed_for_longer_than_a_gap_that_is_bridged_is_not_used():
    time, swing = _swing()
    position, torque = swing.position(time), np.cos(swing.position(time))
    clean = _kept(_conditioned(log_of(time, position, torque), SMOOTH))
    usable = {}
    for missed in (2, 18):
        copied, held = position.copy(), torque.copy()
        copied[3001 : 3001 + missed], held[3001 : 3001 + missed] = copied[3000], held[3000]
        there = _kept(_conditioned(log_of(time, copied, held), SMOOTH))
        usable[missed] = there[2]
        good = there[2] & clean[2]
        assert good.mean() > 0.9
        np.testing.assert_allclose(there[1][:, good], clean[1][:, good], atol=2e-3)
    lost = clean[0][np.any(clean[2] & ~usable[18], axis=1)]
    assert np.array_equal(usable[2], clean[2])
    assert lost.min() < time[3001] < time[3019] < lost.max()


def test_samples_that_only_repeat_the_one_before_do_not_bend_an_even_log():
    time, swing = _swing()
    position, torque = swing.position(time), np.cos(swing.position(time))
    held = np.random.default_rng(8).random(len(time)) < 0.05
    held[0] = False
    latest = np.maximum.accumulate(np.where(held, 0, np.arange(len(time))))
    clean = _kept(_conditioned(log_of(time, position, torque), SMOOTH))
    mended = _kept(_conditioned(log_of(time, position[latest], torque[latest]), SMOOTH))
    good = clean[2] & mended[2]
    assert good.mean() > 0.9
    worst = np.abs(mended[1] - clean[1])[:, good].max(axis=1)
    size = np.abs(clean[1])[:, good].max(axis=1)
    assert np.all(worst[:2] < 1e-3 * size[:2])
    assert worst[2] < 1e-2 * size[2]
