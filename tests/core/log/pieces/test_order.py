"""A clock that starts anew gives runs, rows out of order are sorted, and lost order is refused."""

import numpy as np
import pytest

from tests.core.log.pieces.test_ends import healthy
from tests.core.log.writers import swing, write_csv, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays, read_log


def kinds(log):
    return {defect.kind for defect in log.defects}


@pytest.mark.parametrize("write", [write_csv, write_parquet])
@pytest.mark.parametrize("runs", [2, 3])
def test_a_clock_that_starts_anew_gives_runs_that_follow_each_other(write, runs, tmp_path):
    columns = swing(seconds=12.0)
    rows = len(columns["time"]) // runs
    columns["time"] = np.tile(columns["time"][:rows], runs)
    suffix = "csv" if write is write_csv else "parquet"
    log = read_log(write(tmp_path / f"log.{suffix}", columns))
    assert kinds(log) == {"time_restarts", "gap"}
    assert log.segments == tuple((run * rows, (run + 1) * rows) for run in range(runs))
    read = whole_rows(log)
    assert np.all(np.diff(read.time) > 0.0)
    np.testing.assert_array_equal(read.position[:, 0], columns["q_1"])


def test_the_same_motion_twice_is_two_runs_although_sorting_would_look_smooth():
    time, position, torque = healthy()
    log = log_from_arrays("twice", np.tile(time, 2), np.tile(position, (2, 1)), np.tile(torque, (2, 1)))
    assert "time_restarts" in kinds(log)
    np.testing.assert_array_equal(whole_rows(log).position, np.tile(position, (2, 1)))


def test_every_run_has_its_own_bad_ends():
    time, position, torque = healthy()
    position += 1.0
    position[0] = torque[0] = 0.0
    log = log_from_arrays("twice", np.tile(time, 2), np.tile(position, (2, 1)), np.tile(torque, (2, 1)))
    (defect,) = [defect for defect in log.defects if defect.kind == "bad_end"]
    assert defect.count == 2
    assert log.segments == ((0, len(time) - 1), (len(time) - 1, 2 * len(time) - 2))


def test_runs_too_short_to_be_differentiated_are_left_out_and_counted():
    time, position, torque = healthy()
    clock = np.concatenate([time[:1500], time[:30], time[: len(time) - 1530]])
    log = log_from_arrays("three", clock, position, torque)
    (defect,) = [defect for defect in log.defects if defect.kind == "time_restarts"]
    assert "3 runs" in defect.statement
    assert "1 of them" in defect.statement
    assert log.samples == len(time) - 30


@pytest.mark.parametrize("write", [write_csv, write_parquet])
def test_shuffled_rows_with_their_stamps_are_put_in_order(write, tmp_path):
    columns = swing(seconds=12.0)
    order = np.random.default_rng(5).permutation(len(columns["time"]))
    suffix = "csv" if write is write_csv else "parquet"
    log = read_log(
        write(tmp_path / f"log.{suffix}", {name: values[order] for name, values in columns.items()})
    )
    assert kinds(log) == {"shuffled_rows"}
    np.testing.assert_array_equal(whole_rows(log).position[:, 1], columns["q_2"])


def test_rows_that_overtook_each_other_on_a_network_are_put_in_order():
    time, position, torque = healthy()
    order = np.arange(len(time))
    order[[100, 101, 900, 903]] = order[[101, 100, 903, 900]]
    log = log_from_arrays("overtaken", time[order], position[order], torque[order])
    (defect,) = log.defects
    assert defect.kind == "shuffled_rows"
    np.testing.assert_array_equal(whole_rows(log).torque, torque)


@pytest.mark.parametrize("joints", [1, 3])
def test_rows_shuffled_under_stamps_that_stayed_are_refused_with_numbers(joints):
    time, position, torque = healthy(joints=joints)
    order = np.random.default_rng(2).permutation(len(time))
    with pytest.raises(LogError, match="do not continue each other") as refusal:
        log_from_arrays("lost", time, position[order], torque[order])
    assert refusal.value.evidence["steps_over_variance"] == pytest.approx([2.0] * joints, abs=0.1)
    assert "sort" not in refusal.value.remedy


@pytest.mark.parametrize("stamp", [0.5, -3.0, 1e6, 15.0])
@pytest.mark.parametrize("rows", [1, 2])
def test_a_row_whose_stamp_is_broken_is_left_out_and_not_moved_to_where_it_does_not_belong(stamp, rows):
    time, position, torque = healthy()
    time[2500 : 2500 + rows] = stamp + 1e-4 * np.arange(rows)
    log = log_from_arrays("broken", time, position, torque)
    (defect,) = [defect for defect in log.defects if defect.kind not in ("gap", "jitter")]
    assert (defect.kind, defect.count) == ("broken_stamps", rows)
    np.testing.assert_array_equal(
        whole_rows(log).position, np.delete(position, range(2500, 2500 + rows), axis=0)
    )
