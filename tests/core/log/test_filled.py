"""Rows that a recorder filled in along straight lines are cut out; efforts straight by nature are not."""

import numpy as np
import pytest

from tests.core.log.test_defects import healthy, log_of, only

WHOLE = ((0, 5000),)


def fill(values, begin, stop, along):
    """Put the straight line between the neighbours in the place of some rows."""
    share = ((along[begin:stop] - along[begin - 1]) / (along[stop] - along[begin - 1]))[:, None]
    values[begin:stop] = (1.0 - share) * values[begin - 1] + share * values[stop]


@pytest.mark.parametrize("by", ["rows", "stamps"])
@pytest.mark.parametrize("jitter", [0.0, 0.2])
@pytest.mark.parametrize("rows", [6, 20, 500])
def test_rows_that_were_filled_in_are_cut_out_and_no_other(rows, jitter, by):
    time, position, torque = healthy()
    time += jitter * np.random.default_rng(rows).uniform(0.0, 0.004, len(time))
    stop = 1000 + rows
    for values in (position, torque):
        fill(values, 1000, stop, time if by == "stamps" else np.arange(5000.0))
    log = log_of(time, position, torque)
    assert log.segments == ((0, 1000), (stop, 5000))
    (found,) = [defect for defect in log.defects if defect.kind == "filled_rows"]
    assert (found.channel, found.joint, found.count) == ("torque", None, rows)
    assert found.intervals == ((time[1000], time[stop]),)


def test_what_was_filled_in_is_told_from_the_torque_of_one_joint_and_however_often():
    time, position, torque = healthy()
    begins = range(300, 4800, 100)
    for begin in begins:
        fill(torque[:, 1:], begin, begin + 12, time)
    log = log_of(time, position, torque)
    (found,) = only(log, "filled_rows")
    by_chance = found.count - 12 * len(begins)
    assert by_chance in (0, 1, 2)
    assert len(log.segments) == len(begins) + 1


def test_a_file_that_rounds_its_numbers_to_single_precision_shows_it_as_well():
    time, position, torque = healthy()
    fill(torque, 1000, 1100, time)
    log = log_of(time, position, torque.astype(np.float32).astype(float))
    assert log.segments == ((0, 1000), (1100, 5000))


def test_a_line_over_no_more_than_a_gap_that_is_bridged_cuts_nothing():
    time, position, torque = healthy(rate_hz=1000.0)
    for values in (position, torque):
        fill(values, 4000, 4020, time)
    assert log_of(time, position, torque).segments == ((0, len(time)),)


@pytest.mark.parametrize("every", [2, 5, 25, 100])
def test_a_torque_that_was_sampled_more_slowly_and_interpolated_loses_no_row(every):
    time, position, torque = healthy()
    slow = np.column_stack([np.interp(time, time[::every], own[::every]) for own in torque.T])
    assert log_of(time, position, slow).segments == WHOLE


def test_a_torque_without_noise_that_a_steady_acceleration_makes_straight_loses_no_row():
    time, position, _ = healthy()
    speed = np.clip(4.0 * np.abs(np.mod(0.4 * time, 2.0) - 1.0) - 2.0, -1.0, 1.0)
    position[:, 0] = np.cumsum(speed) * 0.004
    torque = np.column_stack([2.0 * speed + np.gradient(speed, time), np.sin(1.3 * time)])
    assert log_of(time, position, torque).segments == WHOLE


@pytest.mark.parametrize("levels", [10, 100, 1000])
def test_a_coarse_torque_loses_no_row(levels):
    time, position, torque = healthy()
    step = np.ptp(torque, axis=0) / levels
    assert log_of(time, position, np.round(torque / step) * step).segments == WHOLE


def test_a_torque_that_drifts_quietly_while_its_joint_rests_loses_no_row():
    time, position, torque = healthy()
    position[2000:3000] = position[1999]
    position[3000:] += position[1999] - position[3000]
    fill(torque, 2000, 3000, time)
    assert log_of(time, position, torque).segments == WHOLE


def test_a_push_at_the_arm_loses_no_row():
    time, position, torque = healthy()
    push = np.sin(np.pi * np.clip((time - 8.0) / 0.5, 0.0, 1.0))[:, None]
    assert log_of(time, position, torque + np.ptp(torque, axis=0) * push).segments == WHOLE
