"""Rows at either end that no motion leads to are found, listed and left out, whatever they hold."""

import warnings

import numpy as np
import pytest

from tests.core.log.writers import swing
from veritorque.core.log.model import LogRows, whole_rows
from veritorque.core.log.pieces.ends import is_mostly_held
from veritorque.core.log.reader import log_from_arrays


def healthy(seconds=20.0, rate_hz=250.0, joints=2, seed=0):
    columns = swing(seconds, rate_hz, joints, seed)
    return columns["time"], *(
        1.0 * np.column_stack([columns[f"{prefix}_{j + 1}"] for j in range(joints)])
        for prefix in ("q", "tau")
    )


def zeros(time, position, torque, rows):
    position[:rows] = torque[:rows] = 0.0
    position[rows:] += 0.4


def stale(time, position, torque, rows):
    position[:rows] = position[rows] + 0.02
    torque[:rows] = torque[rows]


def clock_of_zero(time, position, torque, rows):
    time += 1.7e9
    time[:rows] = 0.0


def not_a_number(time, position, torque, rows):
    torque[:rows] = np.nan


def idle_torque(time, position, torque, rows):
    torque += 30.0
    torque[:rows] = 0.0


def from_behind(spoil):
    def spoil_tail(time, position, torque, rows):
        spoil(-time[::-1], position[::-1], torque[::-1], rows)

    return spoil_tail


def stopped_clock(time, position, torque, rows):
    time += 1.7e9
    time[-rows:] = 0.0


KINDS = {
    "zeros": zeros, "stale": stale, "clock of zero": clock_of_zero, "not a number": not_a_number,
    "idle torque": idle_torque, "zeros behind": from_behind(zeros), "stale behind": from_behind(stale),
    "not a number behind": from_behind(not_a_number), "stopped clock": stopped_clock,
}  # fmt: skip  # a table


@pytest.mark.parametrize("rows", [1, 2, 19, 700, 6000])
@pytest.mark.parametrize("kind", KINDS)
def test_bad_rows_at_an_end_are_left_out_and_nothing_else_is(kind, rows):
    time, position, torque = healthy(seconds=20.0 if rows < 1000 else 80.0)
    KINDS[kind](time, position, torque, rows)
    log = log_from_arrays("spoilt", time, position, torque)
    (defect,) = [defect for defect in log.defects if defect.kind == "bad_end"]
    assert defect.count == rows
    assert log.samples == len(time) - rows
    good = slice(None, -rows) if "behind" in kind or kind == "stopped clock" else slice(rows, None)
    np.testing.assert_array_equal(whole_rows(log).position, position[good])
    assert log.duration == pytest.approx((len(time) - rows - 1) / 250.0)
    assert {defect.kind for defect in log.defects} == {"bad_end"}


def test_both_ends_are_judged_by_themselves():
    time, position, torque = healthy()
    zeros(time, position, torque, 3)
    position[-2:] = torque[-2:] = 0.0
    log = log_from_arrays("spoilt", time, position, torque)
    (defect,) = log.defects
    assert (defect.count, log.samples) == (5, len(time) - 5)
    assert defect.intervals == (
        (0.0, pytest.approx(time[2])),
        (pytest.approx(time[-2]), pytest.approx(time[-1])),
    )


@pytest.mark.parametrize("rate_hz", [30.0, 100.0, 1000.0])
@pytest.mark.parametrize("step", [0.0, 1e-5, 2e-3])
def test_a_log_that_starts_at_rest_and_moves_off_keeps_all_its_rows(rate_hz, step):
    """Trapezoids of velocity from a standstill, without noise or on an encoder's grid, are motions."""
    time = np.arange(int(20.0 * rate_hz)) / rate_hz
    speed = np.clip(np.minimum(time - 1.0, 19.0 - time), 0.0, 0.5)[:, None] * np.cos(0.7 * time[:, None])
    position = 0.3 + np.cumsum(speed, axis=0) / rate_hz
    torque = 9.0 * np.cos(position) + 0.5 * np.sign(speed)
    seen = np.round(position / step) * step if step else position
    log = log_from_arrays("from rest", time, seen, torque)
    assert not [defect for defect in log.defects if defect.kind == "bad_end"]
    assert log.samples == len(time)


@pytest.mark.parametrize("rate_hz", [50.0, 100.0])
def test_an_axis_that_hardly_ever_accelerates_keeps_the_rows_at_which_it_stood(rate_hz):
    """At constant speed all but a hundredth of the rows have no second difference at all."""
    time = np.arange(int(40.0 * rate_hz)) / rate_hz
    speed = np.clip(np.minimum(time - 10.0, 35.001 - time) / 0.15, 0.0, 0.6)
    position = (np.cumsum(speed) / rate_hz)[:, None]
    torque = 3.0 * np.sign(speed)[:, None] + 9.0 * np.cos(position)
    log = log_from_arrays("constant speed", time, position, torque)
    assert not [defect for defect in log.defects if defect.kind == "bad_end"]


@pytest.mark.parametrize("rows", [2, 19, 700, 6000])
@pytest.mark.parametrize("behind", [False, True])
def test_copies_of_the_row_that_the_motion_goes_on_from_are_a_bad_end(rows, behind):
    time, position, torque = healthy(seconds=20.0 if rows < 1000 else 80.0)
    held = slice(-rows, None) if behind else slice(None, rows)
    kept = -rows - 1 if behind else rows
    position[held], torque[held] = position[kept], torque[kept]
    log = log_from_arrays("held", time, position, torque)
    (defect,) = log.defects
    assert (defect.kind, defect.count, log.samples) == ("bad_end", rows, len(time) - rows)


def test_an_idle_current_beside_torque_does_not_lengthen_what_is_judged():
    """The end of a log is read further while it is held, the whole file if need be: by what is used alone."""
    time, position, torque = healthy()
    idle = LogRows(time, position, torque, current=np.zeros_like(torque))
    assert not is_mostly_held(idle)
    assert is_mostly_held(LogRows(time, position, current=np.zeros_like(torque)))


def test_a_spike_near_an_end_is_a_spike_and_no_bad_end():
    time, position, torque = healthy()
    position[4, 1] += 0.5
    log = log_from_arrays("spike", time, position, torque)
    assert {defect.kind for defect in log.defects} == {"outliers"}


def test_a_row_number_in_a_refusal_counts_the_rows_that_were_left_out():
    time, position, torque = healthy()
    zeros(time, position, torque, 3)
    torque[500, 0] = np.nan
    time[1001] = time[1000]
    with pytest.raises(Exception, match="stamps occur twice") as caught:
        log_from_arrays("spoilt", time, position, torque)
    assert caught.value.evidence["first_row"] == 1002


@pytest.mark.parametrize("value", [1e308, -1e308, np.inf, np.nan])
@pytest.mark.parametrize("channel", ["position", "torque"])
def test_values_beyond_any_size_in_the_middle_are_left_out_and_nothing_overflows(value, channel):
    time, position, torque = healthy()
    {"position": position, "torque": torque}[channel][[900, 2500], [0, 1]] = value, -value
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        log = log_from_arrays("spoilt", time, position, torque)
    defect, jitter = log.defects
    assert (defect.kind, defect.channel, defect.count, jitter.kind) == (
        "missing_values",
        channel,
        2,
        "jitter",
    )
    assert log.samples == len(time) - 2
