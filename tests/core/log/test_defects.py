"""Every defect is planted in a healthy log and must be found where it is; the healthy log itself has none."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.log.writers import swing
from veritorque.core.log.defects.runs import Runs
from veritorque.core.log.defects.saturation import Beside
from veritorque.core.log.defects.spikes import median_of_five
from veritorque.core.log.defects.stretch import STRETCH_ROWS
from veritorque.core.log.reader import log_from_arrays

FEWER = settings(max_examples=40)
"""Each looks for defects in a log of thousands of rows."""


@cache
def made(seconds, rate_hz, joints, seed):
    columns = swing(seconds, rate_hz, joints, seed)

    def gather(prefix):
        return np.column_stack([columns[f"{prefix}_{j + 1}"] for j in range(joints)])

    return columns["time"], gather("q"), gather("tau")


def healthy(seconds=20.0, rate_hz=250.0, joints=2, seed=0):
    """Give time, position and torque, to be spoilt."""
    return tuple(series.copy() for series in made(seconds, rate_hz, joints, seed))


def log_of(time, position, torque):
    return log_from_arrays("planted", time, position, torque)


def only(log, kind):
    """Give the defects of the kind, and demand that there is no other kind."""
    assert {defect.kind for defect in log.defects} == {kind}
    return log.defects


@FEWER
@given(seed=st.integers(0, 10_000), rate_hz=st.sampled_from([100.0, 250.0, 1000.0]), joints=st.integers(1, 7))
def test_a_healthy_log_has_no_defect_whatever_its_noise(seed, rate_hz, joints):
    assert log_of(*healthy(12.0, rate_hz, joints, seed)).defects == ()


@FEWER
@given(row=st.integers(200, 4800), missing=st.floats(0.03, 2.0))
def test_missing_samples_are_a_gap_that_splits_the_log(row, missing):
    time, position, torque = healthy()
    time[row:] += missing
    log = log_of(time, position, torque)
    (gap,) = only(log, "gap")
    assert log.segments == ((0, row), (row, 5000))
    assert gap.count == 1
    assert gap.intervals == ((pytest.approx(time[row - 1]), pytest.approx(time[row])),)


@FEWER
@given(row=st.integers(200, 4800), missing=st.floats(0.010, 0.020))
def test_a_few_missing_milliseconds_are_said_and_bridged(row, missing):
    time, position, torque = healthy()
    time[row:] += missing
    log = log_of(time, position, torque)
    (gap,) = only(log, "gap")
    assert log.segments == ((0, 5000),)
    assert "bridged" in gap.statement


def test_jitter_is_stated_with_its_size_and_without_alarm():
    time, position, torque = healthy()
    random = np.random.default_rng(3)
    shaken = time + 0.0004 * random.standard_normal(len(time)).clip(-3, 3)
    (jitter,) = only(log_of(shaken, position, torque), "jitter")
    steps = np.diff(shaken)
    assert f"{1e3 * steps.std():.3g} ms (standard deviation)" in jitter.statement
    assert jitter.statement.endswith("unless the positions show that the samples were taken evenly.")
    assert jitter.count == pytest.approx(np.sum(abs(steps - 0.004) > 0.0004), rel=0.05)


@FEWER
@given(seed=st.integers(0, 1000), share=st.floats(0.01, 0.2))
def test_repeated_rows_are_counted_exactly(seed, share):
    time, position, torque = healthy()
    copies = np.flatnonzero(np.random.default_rng(seed).random(len(time)) < share)
    copies = copies[copies > 0]
    for row in copies:
        position[row], torque[row] = position[row - 1], torque[row - 1]
    (found,) = [d for d in log_of(time, position, torque).defects if d.kind == "repeated_rows"]
    assert found.count == len(copies)
    assert found.joint is None


@pytest.mark.parametrize("start", [300, STRETCH_ROWS - 40, STRETCH_ROWS - 5, STRETCH_ROWS + 1])
def test_a_log_is_cut_where_its_recorder_stood_still_and_the_robot_did_not(start):
    time, position, torque = healthy(160.0)
    stop = start + 60
    position[start:stop], torque[start:stop] = position[start - 1], torque[start - 1]
    log = log_of(time, position, torque)
    assert log.segments == ((0, start), (stop, len(time)))
    (found,) = [one for one in log.defects if one.kind == "repeated_rows"]
    assert found.statement.endswith("In 1 run of them the robot moved on: the log is cut there.")


def test_a_robot_that_stands_still_cuts_nothing():
    time, position, torque = healthy()
    half = len(time) // 2
    position, torque = (
        np.concatenate([one[:half], np.repeat(one[half - 1 : half], 100, axis=0), one[half:-100]])
        for one in (position, torque)
    )
    assert log_of(time, position, torque).segments == ((0, len(time)),)


@pytest.mark.parametrize("channel", ["position", "torque"])
@pytest.mark.parametrize("start", [300, STRETCH_ROWS - 40, STRETCH_ROWS - 5, STRETCH_ROWS + 1])
def test_a_log_is_cut_where_one_channel_hangs_while_its_joint_moves(start, channel):
    time, position, torque = healthy(160.0)
    stop = start + 60
    values = {"position": position, "torque": torque}[channel]
    values[start:stop, 1] = values[start - 1, 1]
    log = log_of(time, position, torque)
    assert log.segments == ((0, start), (stop, len(time)))
    (found,) = only(log, "stuck_channel")
    assert (found.channel, found.joint, found.count) == (channel, 2, 60)
    assert found.intervals == ((time[start - 1], time[stop - 1]),)
    assert "1 run of 60 rows in all while the joint moves on" in found.statement


def test_a_position_that_hangs_from_a_reversal_on_is_told_by_its_leap():
    """It hardly moved before, as a joint that rests; but none gets so far in one sample."""
    time, position, torque = healthy()
    start = 1000 + int(np.argmax(position[1000:2000, 1]))
    stop = start + 60
    position[start:stop, 1] = position[start - 1, 1]
    assert abs(position[start - 1, 1] - position[start - 2, 1]) < 0.1 * np.abs(np.diff(position[:, 1])).mean()
    log = log_of(time, position, torque)
    assert log.segments == ((0, start), (stop, len(time)))
    assert only(log, "stuck_channel")[0].joint == 2


def test_channels_that_hang_at_the_same_time_cut_the_log_once():
    time, position, torque = healthy()
    torque[1000:1050] = torque[999]
    torque[1030:1080, 1] = torque[1029, 1]
    log = log_of(time, position, torque)
    assert log.segments == ((0, 1000), (1080, len(time)))
    assert {(one.joint, one.count) for one in only(log, "stuck_channel")} == {(1, 50), (2, 80)}


def test_a_torque_that_hangs_for_good_ends_the_log_there():
    time, position, torque = healthy()
    torque[4000:, 0] = torque[3999, 0]
    assert log_of(time, position, torque).segments == ((0, 4000),)


def test_a_joint_that_rests_and_a_torque_that_is_coarse_or_clipped_are_not_stuck():
    time, position, torque = healthy()
    position[1000:1100, 0] = position[999, 0]
    position[1100:, 0] += position[999, 0] - position[1100, 0]
    torque[1000:1100, 0] = torque[999, 0]
    assert log_of(time, position, torque).segments == ((0, len(time)),)
    time, position, torque = healthy()
    torque[:, 0] = np.round(torque[:, 0] / np.ptp(torque[:, 0]))
    torque[:, 1] = np.minimum(torque[:, 1], 0.8 * torque[:, 1].max())
    assert log_of(time, position, torque).segments == ((0, len(time)),)


def test_a_coarse_torque_that_hangs_for_long_is_stuck():
    """It keeps many values for some samples, and this one again and again; none for nearly as long."""
    time, position, torque = healthy()
    step = np.ptp(torque[:, 1]) / 40.0
    torque += 0.5 * step * np.random.default_rng(5).standard_normal(torque.shape)
    torque = step * np.round(torque / step)
    assert log_of(time, position, torque).segments == ((0, len(time)),)
    torque[1000:1080, 1] = torque[999, 1]
    (found,) = (one for one in log_of(time, position, torque).defects if one.kind == "stuck_channel")
    assert (found.joint, found.channel, found.count) == (2, "torque", 80)


def test_a_coarse_torque_that_drops_to_a_value_of_its_own_is_stuck_once():
    """Its run is unusual by its value and by its length, and is one run, from its first row on."""
    time, position, torque = healthy()
    step = np.ptp(torque[:, 1]) / 40.0
    torque += 0.5 * step * np.random.default_rng(5).standard_normal(torque.shape)
    torque = step * np.round(torque / step)
    begin = 800 + int(np.argmax(np.abs(torque[800:1400, 1])))
    torque[begin : begin + 300, 1] = 0.3 * step
    (found,) = (one for one in log_of(time, position, torque).defects if one.kind == "stuck_channel")
    assert (found.joint, found.count) == (2, 300)


@pytest.mark.parametrize("gap", [0.0, 5.0], ids=["joined", "paused"])
def test_a_parked_joint_that_is_elsewhere_in_the_next_run_was_not_stuck(gap):
    time, position, torque = healthy()
    position[:, 1] = np.where(time < 10.0, 0.3, -0.5 + 0.1 * np.sin(time - 10.0))
    time[2500:] += gap
    kept = log_of(time, position, torque).segments
    assert kept == (((0, 2500), (2500, 5000)) if gap else ((0, 5000),))


def test_one_absurd_position_of_a_parked_joint_cuts_nothing():
    time, position, torque = healthy()
    position[1000:1200, 1] = position[999, 1]
    position[1200:, 1] += position[999, 1] - position[1200, 1]
    position[1100, 1] += 0.05
    assert log_of(time, position, torque).segments == ((0, len(time)),)


@pytest.mark.parametrize(
    "made",
    [
        lambda torque: np.where(np.abs(torque) < 1.0, 0.0, torque),
        lambda torque: np.clip(torque, -7.0, 7.0) + (np.arange(len(torque)) == 3000)[:, None],
        lambda torque: np.where(
            np.arange(len(torque))[:, None] < 3500, torque, np.repeat(torque[::25], 25, 0)
        ),
        lambda torque: np.where(np.arange(len(torque))[:, None] < 2500, np.clip(torque, -5.0, 5.0), torque),
    ],
    ids=["deadband", "clipped, with a spike", "held from then on", "clipped at first"],
)
def test_what_a_torque_channel_does_again_and_again_is_no_fault(made):
    time, position, torque = healthy()
    assert log_of(time, position, made(torque)).segments == ((0, len(time)),)


def test_a_motor_that_is_off_while_encoders_flicker_is_not_stuck():
    time, position, torque = healthy()
    position[2000:4000] = position[1999]
    position[4000:] += position[1999] - position[4000]
    position += 1e-5 * np.random.default_rng(1).standard_normal(position.shape)
    torque[2000:4000] = 0.0
    assert log_of(time, position, torque).segments == ((0, len(time)),)


@pytest.mark.parametrize("channel", ["position", "torque"])
def test_a_channel_that_drops_to_nothing_is_left_out_from_its_first_row_on(channel):
    time, position, torque = healthy()
    torque += 100.0
    position += 1.0
    {"position": position, "torque": torque}[channel][1000:1200, 1] = 0.0
    assert log_of(time, position, torque).segments == ((0, 1000), (1200, len(time)))


def test_torque_without_noise_that_a_steady_motion_keeps_the_same_is_not_stuck():
    time, position, torque = healthy()
    phase = 1.3 * time
    position[:, 0], torque[:, 0] = np.sin(phase), np.clip(np.sin(phase), -0.8, 0.8) + (np.sin(phase) > 0.99)
    assert not [one for one in log_of(time, position, torque).defects if one.kind == "stuck_channel"]


@FEWER
@given(row=st.integers(2, 4997), joint=st.integers(0, 1), sign=st.sampled_from([-1.0, 1.0]))
def test_a_torque_spike_is_found_at_its_sample(row, joint, sign):
    time, position, torque = healthy()
    torque[row, joint] += sign * 8.0
    (spike,) = only(log_of(time, position, torque), "outliers")
    assert (spike.channel, spike.joint, spike.count) == ("torque", joint + 1, 1)
    assert spike.intervals == ((time[row], time[row]),)


@FEWER
@given(row=st.integers(2, 4997), joint=st.integers(0, 1))
def test_a_position_spike_is_found_at_its_sample(row, joint):
    time, position, torque = healthy()
    position[row, joint] += 0.2
    (spike,) = only(log_of(time, position, torque), "outliers")
    assert (spike.channel, spike.joint, spike.intervals) == ("position", joint + 1, ((time[row], time[row]),))


def test_a_position_that_no_joint_ever_reached_is_no_reason_to_doubt_its_unit():
    time, position, torque = healthy()
    span = np.ptp(position[:, 0])
    position[2500, 0], torque[2600, 1] = 1e3, -1e7
    by_channel = {defect.channel: defect for defect in log_of(time, position, torque).defects}
    assert {defect.kind for defect in by_channel.values()} == {"outliers"}
    assert f"it spans {span:.3g} rad otherwise" in by_channel["position"].statement


def test_a_huge_spike_hides_no_smaller_ones():
    time, position, torque = healthy()
    torque[[1000, 2000, 3000, 4000], 0] += [1e7, -1e5, 1e3, 30.0]
    (spikes,) = only(log_of(time, position, torque), "outliers")
    assert spikes.count == 4
    assert spikes.level < 30.0


def test_steps_of_torque_as_friction_makes_them_are_no_spikes():
    time, position, torque = healthy()
    torque += 5.0 * np.sign(np.gradient(position, axis=0))
    assert log_of(time, position, torque).defects == ()


@FEWER
@given(limit=st.floats(0.4, 0.9), sign=st.sampled_from([-1.0, 1.0]))
def test_a_torque_that_stops_at_a_limit_is_saturated(limit, sign):
    time, position, torque = healthy()
    level = limit * abs(torque[:, 1]).max()
    torque[:, 1] = sign * np.minimum(sign * torque[:, 1], level).clip(-level, None)
    saturated = only(log_of(time, position, torque), "saturation")
    assert {defect.joint for defect in saturated} == {2}
    assert f"exactly {sign * level:.4g} N m" in " ".join(defect.statement for defect in saturated)
    start, stop = saturated[0].intervals[0]
    held = (time >= start) & (time <= stop)
    assert np.ptp(torque[held, 1]) == 0.0


@FEWER
@given(lsb=st.floats(0.01, 0.3))
def test_the_flat_top_of_a_quantised_torque_is_no_saturation(lsb):
    time, position, _ = healthy()
    smooth = lsb * np.round(10.0 * position / lsb)
    assert not [d for d in log_of(time, position, smooth).defects if d.kind == "saturation"]


@pytest.mark.parametrize("limit", [0.5, 0.6, 0.7, 2.0])
@pytest.mark.parametrize("first", ["clipped", "rounded"])
def test_a_coarse_torque_that_stops_at_a_limit_is_saturated_though_peaks_end_below_it(limit, first):
    """A slow swell with a quick one has many peaks of all heights, each of some coarse steps."""
    rng = np.random.default_rng(12)
    time = np.arange(0.0, 40.0, 4e-3)
    position = np.column_stack([np.sin(time), np.cos(1.3 * time)])
    torque = np.column_stack([np.cos(time), 6.0 * np.sin(0.7 * time) + 4.0 * np.sin(2.9 * time)])
    torque += 0.1 * rng.normal(size=torque.shape)
    level, step = limit * torque[:, 1].max(), 0.9
    ways = [lambda own: np.clip(own, -level, level), lambda own: step * np.round(own / step)]
    for way in ways if first == "clipped" else ways[::-1]:
        torque[:, 1] = way(torque[:, 1])
    saturated = [one.joint for one in log_of(time, position, torque).defects if one.kind == "saturation"]
    assert set(saturated) == ({2} if limit < 1.0 else set())


def test_what_is_beside_a_plateau_does_not_depend_on_how_a_log_is_cut():
    rng = np.random.default_rng(5)
    values = np.minimum(np.round(np.cumsum(rng.integers(-1, 2, 3000)) / 4.0), 6.0)
    found = set()
    for size in (1, 7, 64, 3000):
        beside = Beside()
        for start in range(0, len(values), size):
            beside.feed(values[start : start + size])
        beside.close()
        found.add((beside.top, beside.rows))
    ((top, rows),) = found
    ends = np.r_[0, np.flatnonzero(np.diff(values)) + 1, len(values)]
    runs = list(zip(values[ends[:-1]], np.diff(ends), strict=True))
    assert top == values.max()
    assert rows == sum(
        sum(length for _, length in runs[max(at - 1, 0) : at + 2]) - runs[at][1]
        for at in range(1, len(runs))
        if runs[at][0] == top and runs[at][1] >= 5
    )


@FEWER
@given(lsb=st.floats(2e-3, 1e-2))
def test_a_coarse_encoder_is_stated_with_its_resolution(lsb):
    time, position, torque = healthy(rate_hz=1000.0)
    coarse = lsb * np.round(position / lsb)
    found = [d for d in log_of(time, coarse, torque).defects if d.kind == "quantisation"]
    assert [defect.joint for defect in found] == [1, 2]
    assert f"steps of {lsb:.3g} rad" in found[0].statement


def test_a_coarse_torque_is_stated_with_its_resolution():
    time, position, torque = healthy()
    (found, *_) = only(log_of(time, position, 0.5 * np.round(torque / 0.5)), "quantisation")
    assert found.channel == "torque"
    assert "steps of 0.5 N m" in found.statement


def test_a_fine_encoder_is_not_worth_a_word():
    time, position, torque = healthy()
    assert log_of(time, 1e-6 * np.round(position / 1e-6), torque).defects == ()


@FEWER
@given(start=st.integers(500, 2500), seconds=st.floats(1.0, 8.0))
def test_a_rest_of_one_joint_is_found_with_its_length(start, seconds):
    time, position, torque = healthy()
    stop = start + round(250 * seconds)
    position[start:stop, 1] = position[start, 1] + 1e-6 * np.random.default_rng(0).standard_normal(
        stop - start
    )
    position[stop:, 1] += position[stop - 1, 1] - position[stop, 1]
    (rest,) = only(log_of(time, position, torque), "standstill")
    assert rest.joint == 2
    assert rest.intervals[0][0] == pytest.approx(time[start], abs=0.2)
    assert rest.intervals[0][1] == pytest.approx(time[stop], abs=0.2)
    assert rest.count == pytest.approx(stop - start, abs=60)


@pytest.mark.parametrize("chatter", [0.0, 1e-4])
def test_a_frozen_joint_is_a_defect_that_says_what_cannot_be_identified(chatter):
    time, position, torque = healthy()
    position[:, 0] = 0.3 + chatter * (np.random.default_rng(0).random(len(time)) < 0.05)
    (rest,) = only(log_of(time, position, torque), "standstill")
    assert rest.joint == 1
    assert rest.count == len(time)
    assert "never moves: this log cannot identify" in rest.statement


def test_a_log_of_a_few_seconds_is_short():
    (short,) = only(log_of(*healthy(seconds=6.0)), "short")
    assert "5.996 s" in short.statement or "6 s" in short.statement


def test_a_motion_quicker_than_its_sampling_is_slow_rate():
    time = np.arange(600) / 20.0
    position = np.sin(2 * np.pi * np.outer(time, [0.3, 4.0]))
    (slow,) = only(log_of(time, position, 5.0 * position), "slow_rate")
    assert slow.joint == 2
    assert "rate of 20 Hz" in slow.statement


def test_positions_in_degrees_are_called_implausible_and_left_alone():
    time, position, torque = healthy()
    degrees = 170.0 / np.ptp(position) * position * 2
    log = log_of(time, degrees, torque)
    found = only(log, "implausible_unit")
    assert [defect.joint for defect in found] == [1, 2]
    assert "read as degrees it would be" in found[0].statement
    np.testing.assert_array_equal(log.source.rows(0, 5000).position, degrees)


def test_stamps_in_milliseconds_are_called_implausible():
    time, position, torque = healthy()
    found = [d for d in log_of(time * 1e3, position, torque).defects if d.kind == "implausible_unit"]
    assert [defect.channel for defect in found] == ["time"]


def test_a_joint_without_torque_is_named():
    time, position, torque = healthy()
    torque[:, 1] = 0.0
    (missing,) = only(log_of(time, position, torque), "missing_torque")
    assert missing.joint == 2


@given(st.lists(st.booleans(), min_size=1, max_size=60), st.integers(1, 4), st.integers(1, 20))
def test_runs_are_the_same_however_the_samples_are_cut_into_stretches(marks, shortest, cut):
    mask, time = np.array(marks), np.arange(float(len(marks)))
    whole, pieces = Runs(shortest), Runs(shortest)
    whole.feed(mask, time)
    whole.close()
    for start in range(0, len(mask), cut):
        pieces.feed(mask[start : start + cut], time[start : start + cut])
    pieces.close()
    assert (whole.rows, whole.seconds, whole.intervals) == (pieces.rows, pieces.seconds, pieces.intervals)
    padded = "".join("x" if mark else " " for mark in marks).split()
    assert whole.rows == sum(len(run) for run in padded if len(run) >= shortest)


@given(st.lists(st.floats(-1e6, 1e6), min_size=5, max_size=40))
def test_the_median_of_five_is_the_median_of_five(values):
    series = np.array([values])
    windows = np.lib.stride_tricks.sliding_window_view(series[0], 5)
    np.testing.assert_array_equal(median_of_five(series)[0], np.median(windows, axis=1))


@pytest.mark.parametrize("down", [0, 1])
@pytest.mark.parametrize("rate_hz", [50.0, 1000.0])
def test_a_joint_that_moves_one_way_only_is_said_with_its_way_and_what_cannot_be_known(down, rate_hz):
    time, position, torque = healthy(rate_hz=rate_hz)
    position[:, 0] = (1.0 - 2.0 * down) * (0.09 * time + 0.05 * np.sin(1.5 * time)) + 1e-5 * np.sin(
        900.0 * time
    )
    (defect,) = only(log_of(time, position, torque), "one_direction")
    assert (defect.channel, defect.joint) == ("position", 1)
    assert "FC1" in defect.statement
    assert "OFF1" in defect.statement
    ways = [float(part.split(" rad")[0]) for part in defect.statement.split(": ")[1].split(" and ")[:2]]
    assert ways[1 - down] < 0.001
    assert ways[down] == pytest.approx(np.ptp(position[:, 0]), rel=0.02)


def test_a_joint_that_returns_once_moves_both_ways():
    time, position, torque = healthy()
    position[:, 0] = np.sin(np.pi * time / time[-1])
    assert log_of(time, position, torque).defects == ()


def with_velocity(factors, clock=1.0, noise=0.0):
    time, position, torque = healthy(24.0)
    velocity = np.gradient(position, time, axis=0) * np.array(factors)
    velocity += noise * np.random.default_rng(1).standard_normal(velocity.shape)
    return log_from_arrays("planted", time * clock, position, torque, velocity=velocity)


@pytest.mark.parametrize("clock", [0.5, 2.0, 1.25])
@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_stamps_that_contradict_the_measured_velocity_are_said_with_the_factor(clock, noise):
    (defect,) = only(with_velocity([1.0, 1.0], clock, noise), "velocity_mismatch")
    assert (defect.channel, defect.joint) == ("time", None)
    assert float(defect.statement.split(" is ")[1].split(" times")[0]) == pytest.approx(clock, rel=0.02)


@pytest.mark.parametrize("factor", [-1.0, 180.0 / np.pi, 100.0])
def test_a_velocity_that_is_off_on_one_joint_is_that_joints(factor):
    (defect,) = only(with_velocity([1.0, factor]), "velocity_mismatch")
    assert (defect.channel, defect.joint) == ("velocity", 2)
    assert f"{factor:.4g} times"[:3] in defect.statement
    assert ("deg/s" in defect.statement) == (round(factor) == 57)


def test_a_velocity_that_is_another_joints_does_not_follow():
    time, position, torque = healthy()
    velocity = np.gradient(position, time, axis=0)[:, ::-1]
    found = only(log_from_arrays("planted", time, position, torque, velocity=velocity), "velocity_mismatch")
    assert [defect.joint for defect in found] == [1, 2]
    assert "does not follow" in found[0].statement


@pytest.mark.parametrize("noise", [0.0, 0.5])
@pytest.mark.parametrize("lag_s", [0.0, 0.02])
def test_a_velocity_that_is_noisy_or_late_is_no_contradiction(noise, lag_s):
    time, position, torque = healthy()
    late = np.column_stack([np.interp(time - lag_s, time, column) for column in position.T])
    velocity = np.gradient(late, time, axis=0)
    velocity += noise * np.random.default_rng(1).standard_normal(velocity.shape)
    assert log_from_arrays("late", time, position, torque, velocity=velocity).defects == ()


@pytest.mark.parametrize(("channel", "factor", "said"), [("torque", 1e3, "mN m"), ("current", 1e3, "mA")])
def test_efforts_of_a_size_that_is_unusual_are_said_with_the_size_they_would_have(channel, factor, said):
    time, position, torque = healthy()
    efforts = {"torque": None, channel: torque * factor}
    log = log_from_arrays("planted", time, position, efforts.pop("torque"), **efforts)
    found = only(log, "implausible_unit")
    assert [(defect.channel, defect.joint) for defect in found] == [(channel, 1), (channel, 2)]
    assert f"read as {said} it would be {np.abs(torque[:, 0]).max():.4g}" in found[0].statement


@pytest.mark.parametrize("channel", ["torque", "current"])
def test_efforts_in_whole_numbers_look_like_counts(channel):
    time, position, torque = healthy()
    efforts = {"torque": None, channel: np.round(torque * 37.0)}
    log = log_from_arrays("planted", time, position, efforts.pop("torque"), **efforts)
    found = [defect for defect in log.defects if defect.kind == "implausible_unit"]
    assert [defect.joint for defect in found] == [1, 2]
    assert "whole numbers" in found[0].statement


@pytest.mark.parametrize(("lag", "found"), [(0.0, True), (1e-6, False)], ids=["the same", "a lag"])
def test_positions_that_equal_their_reference_were_not_measured(lag, found):
    time = np.arange(0.0, 20.0, 4e-3)
    position = np.column_stack([np.sin(time), np.cos(1.3 * time), np.full_like(time, 0.2)])
    torque = np.column_stack([np.cos(time), np.sin(1.3 * time), np.sin(time)])
    wanted = position + lag * np.array([1.0, 0.0, 0.0])
    log = log_from_arrays("planted", time, position, torque, position_ref=wanted)
    kinds = [defect.kind for defect in log.defects]
    assert ("position_is_reference" in kinds) is found
    assert "position_is_reference" not in [
        defect.kind for defect in log_from_arrays("a", time, position, torque).defects
    ]


@pytest.mark.parametrize(("apart", "found"), [(0.0, True), (1e-6, False)], ids=["the same", "another"])
def test_two_joints_do_not_share_their_positions(apart, found):
    time = np.arange(0.0, 20.0, 4e-3)
    first = np.sin(time)
    position = np.column_stack([first, np.cos(1.3 * time), first + apart * np.cos(time), np.zeros_like(time)])
    torque = np.column_stack([np.cos((1.0 + 0.1 * joint) * time) for joint in range(4)])
    shared = [
        one
        for one in log_from_arrays("planted", time, position, torque).defects
        if one.kind == "shared_position"
    ]
    assert [one.joint for one in shared] == ([3] if found else [])


@pytest.mark.parametrize(
    ("change", "found"),
    [(np.abs, [2]), (lambda own: -np.abs(own), [2]), (np.asarray, []), (lambda own: own + 3.5, [])],
    ids=["magnitude", "negative magnitude", "signed", "signed, of one sign"],
)
def test_a_torque_without_a_sign_is_a_magnitude(change, found):
    time = np.arange(0.0, 20.0, 4e-3)
    position = np.column_stack([np.sin(time), np.cos(1.3 * time)])
    torque = np.column_stack([np.cos(time), 2.0 * np.sin(1.3 * time) + np.sin(3.1 * time)])
    torque += 0.01 * np.random.default_rng(8).normal(size=torque.shape)
    torque[:, 1] = change(torque[:, 1])
    defects = log_from_arrays("planted", time, position, torque).defects
    assert [one.joint for one in defects if one.kind == "unsigned_torque"] == found


@pytest.mark.parametrize(
    ("change", "found"),
    [
        (lambda own, speed: np.abs(own) * np.sign(speed), [2]),
        (lambda own, speed: own, []),
        (lambda own, speed: own + 4.0 * np.sign(speed), []),
        (lambda own, speed: speed, []),
    ],
    ids=["magnitude along the speed", "signed", "much friction", "the speed"],
)
def test_a_magnitude_that_was_given_the_sign_of_the_speed_is_one(change, found):
    time = np.arange(0.0, 20.0, 4e-3)
    position = np.column_stack([np.sin(time), np.cos(1.3 * time)])
    speed = -np.sin(1.3 * time)
    torque = np.column_stack([np.cos(time), np.sin(2.9 * time + 0.4) + 2.0 * np.sin(3.1 * time)])
    torque += 0.01 * np.random.default_rng(8).normal(size=torque.shape)
    torque[:, 1] = change(torque[:, 1], speed)
    defects = log_from_arrays("planted", time, position, torque).defects
    assert [one.joint for one in defects if one.kind == "unsigned_torque"] == found


@pytest.mark.parametrize(
    ("change", "found"),
    [
        (lambda own, speed: own, []),
        (lambda own, speed: np.abs(own + 4.0), [3]),
        (lambda own, speed: np.abs(own + 4.0) * np.sign(speed), [3]),
        (lambda own, speed: -np.abs(own + 4.0) * np.sign(speed), [3]),
        (lambda own, speed: np.full_like(own, 2.0), []),
    ],
    ids=["both signs", "one sign", "that of the speed", "the other", "none measured"],
)
@pytest.mark.parametrize("magnitude", [True, False], ids=["beside a magnitude", "beside none"])
def test_beside_a_magnitude_the_sign_of_other_torques_is_to_be_shown(change, found, magnitude):
    time = np.arange(0.0, 20.0, 4e-3)
    position = np.column_stack([np.sin(time), np.cos(1.3 * time), np.sin(1.7 * time)])
    torque = np.column_stack([np.cos(time) + np.sin(2.3 * time), np.sin(2.9 * time), np.sin(2.1 * time)])
    torque[:, 2] = change(torque[:, 2], np.cos(1.7 * time))
    torque[:, 1] = np.abs(torque[:, 1]) if magnitude else torque[:, 1]
    defects = log_from_arrays("planted", time, position, torque).defects
    assert [one.joint for one in defects if one.kind == "unsigned_torque"] == [2] * magnitude
    assert [one.joint for one in defects if one.kind == "unknown_sign"] == found * magnitude


def test_a_torque_that_is_held_for_half_a_log_is_stuck_though_its_recorder_repeats_rows():
    """One recorder in four drops every sixth packet and repeats the last value."""
    rng = np.random.default_rng(4)
    time = np.arange(0.0, 20.0, 1e-3)
    position = np.column_stack([np.sin(time), np.cos(1.3 * time)])
    torque = np.column_stack([np.cos(time), np.sin(1.3 * time)]) + 0.01 * rng.normal(size=(len(time), 2))
    kept = np.maximum.accumulate(np.where(rng.random(len(time)) < 1.0 / 6.0, 0, np.arange(len(time))))
    torque = torque[kept]
    torque[len(time) // 2 :, 1] = torque[len(time) // 2, 1]
    [found] = [
        one for one in log_from_arrays("held", time, position, torque).defects if one.kind == "stuck_channel"
    ]
    assert (found.channel, found.joint) == ("torque", 2)
    assert found.count > 0.45 * len(time)
