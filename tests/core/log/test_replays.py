"""Blocks of rows that were sent again are cut out; logs that repeat themselves by nature lose none."""

import numpy as np
import pytest

from tests.core.log.test_defects import healthy, log_of
from tests.tools import shared
from veritorque.core.log.reader import log_from_arrays, read_log

WHOLE = ((0, 5000),)


@pytest.mark.parametrize("channels", ["torque", "both"])
@pytest.mark.parametrize(("rows", "before"), [(6, 6), (25, 25), (200, 700)])
def test_a_block_that_was_sent_again_in_the_place_of_others_is_cut_out(rows, before, channels):
    time, position, torque = healthy()
    for values in (torque, position) if channels == "both" else (torque,):
        values[2000 : 2000 + rows] = values[2000 - before : 2000 - before + rows]
    log = log_of(time, position, torque)
    assert log.segments == ((0, 2000), (2000 + rows, 5000))
    (found,) = [defect for defect in log.defects if defect.kind == "replayed_rows"]
    assert (found.channel, found.count, found.intervals) == (
        "torque",
        rows,
        ((time[2000], time[1999 + rows]),),
    )


@pytest.mark.parametrize("times", [1, 3])
def test_a_block_that_was_sent_again_between_others_is_cut_out_and_refuses_nothing(times):
    _, position, torque = healthy()
    order = np.r_[0:2000, np.tile(np.arange(1975, 2000), times), 2000:5000]
    stamps = np.arange(len(order)) * 0.004
    log = log_of(stamps, position[order], torque[order])
    assert log.segments == ((0, 2000), (2000 + 25 * times, len(order)))


def test_a_position_that_leaps_elsewhere_still_refuses_the_log():
    time, position, torque = healthy()
    torque[2000:2025] = torque[1975:2000]
    position[3000:, 0] += 1.0
    with pytest.raises(Exception, match="leaps"):
        log_of(time, position, torque)


@pytest.mark.parametrize("periods", [2, 5])
def test_a_log_that_is_one_period_again_and_again_loses_no_row(periods):
    time, _, torque = healthy()
    rows = np.arange(5000) % (5000 // periods)
    turn = np.sin(2.0 * np.pi * rows / (5000 // periods))[:, None] * [1.0, 0.4]
    assert log_of(time, turn, torque[rows]).segments == WHOLE


@pytest.mark.parametrize("levels", [3, 10, 100])
def test_a_coarse_torque_that_repeats_itself_by_chance_loses_no_row(levels):
    time, position, torque = healthy()
    step = np.ptp(torque, axis=0) / levels
    assert "replayed_rows" not in {
        defect.kind for defect in log_of(time, position, np.round(torque / step) * step).defects
    }


def test_efforts_that_come_back_with_the_motion_were_measured():
    time, _, torque = healthy()
    turn = np.sin(2.0 * np.pi * np.arange(5000) / 1250)[:, None] * [1.0, 0.4]
    drift = 1e-5 * np.sin(0.01 * np.arange(5000))[:, None]
    torque[3000:3012] = torque[1750:1762]
    assert log_of(time, turn + drift, torque).segments == WHOLE
    torque[3000:3012] = torque[1800:1812]
    assert log_of(time, turn + drift, torque).segments == ((0, 3000), (3012, 5000))


@pytest.mark.parametrize("decimals", [4, 6])
def test_a_measured_servo_axis_that_repeats_its_motion_loses_no_row(decimals):
    log = read_log(shared("data/emps/runs/track.parquet"))
    rows = log.source.rows(0, log.samples)
    rounded = log_from_arrays("servo", rows.time, rows.position, np.round(rows.torque, decimals))
    assert rounded.segments == log.segments
