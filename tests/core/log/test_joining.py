"""Files of one run are joined on one clock; files that do not belong together are refused."""

import numpy as np
import pytest

from tests.core.log.writers import swing, write_csv, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.check import check_log
from veritorque.core.log.joining import join_logs
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)
TIME = COLUMNS["time"]


def part(*names, rows=slice(None), **others):
    return {"time": TIME[rows], **{name: COLUMNS[name][rows] for name in names}, **others}


def test_positions_in_one_file_and_torques_in_another_are_one_log(tmp_path):
    positions = write_csv(tmp_path / "positions.csv", part("q_1", "q_2"))
    torques = write_parquet(tmp_path / "torques.parquet", part("tau_1", "tau_2"))
    assert "logs join" in check_log(positions).refusal.remedy
    joined = join_logs([positions, torques])
    joined.save(tmp_path / "run.parquet")
    rows = whole_rows(read_log(tmp_path / "run.parquet"))
    np.testing.assert_array_equal(rows.position[:, 1], COLUMNS["q_2"])
    np.testing.assert_array_equal(rows.torque[:, 0], COLUMNS["tau_1"])
    assert joined.notes == ()


def test_a_file_per_joint_gives_columns_that_carry_its_name_and_a_mapping_that_reads_them(tmp_path):
    paths = [
        write_csv(
            tmp_path / f"joint{j}.csv",
            {"time": TIME, "position": COLUMNS[f"q_{j}"], "torque": COLUMNS[f"tau_{j}"]},
        )
        for j in (1, 2)
    ]
    joined = join_logs(paths)
    joined.save(tmp_path / "run.parquet")
    assert "joint2_torque" in joined.columns
    suggested = check_log(tmp_path / "run.parquet").suggestion
    rows = whole_rows(read_log(tmp_path / "run.parquet", mapping=suggested))
    np.testing.assert_array_equal(rows.position, np.column_stack([COLUMNS["q_1"], COLUMNS["q_2"]]))


@pytest.mark.parametrize("order", [1, -1])
def test_files_on_other_stamps_are_brought_to_those_of_the_positions(order, tmp_path):
    at = TIME[:-1] + 0.0015
    torque = np.interp(at, TIME, COLUMNS["tau_1"])
    first = write_csv(tmp_path / "a.csv", part("q_1", rows=slice(100, None)))
    other = write_csv(tmp_path / "b.csv", {"stamp_ms": 1e3 * at, "tau_1": torque})
    joined = join_logs([first, other][::order])
    clock = joined.columns["time"]
    np.testing.assert_array_equal(clock, TIME[100:-1])
    np.testing.assert_allclose(joined.columns["tau_1"], np.interp(clock, at, torque), atol=1e-9)
    assert len(joined.notes) == 2


def test_positions_on_other_stamps_keep_their_curvature(tmp_path):
    clock, other = np.arange(0.0, 5.0, 0.01), np.arange(0.004, 5.0, 0.013)
    first = write_csv(tmp_path / "joint1.csv", {"time": clock, "position": np.sin(3.0 * clock)})
    second = write_csv(tmp_path / "joint2.csv", {"time": other, "position": np.sin(3.0 * other)})
    joined = join_logs([first, second])
    expected = np.sin(3.0 * joined.columns["time"])
    assert np.abs(joined.columns["joint2_position"] - expected).max() < 1e-7  # straight lines are off by 2e-4


@pytest.mark.parametrize("fault", ["another hour", "no clock", "a clock that starts anew"])
def test_files_that_do_not_belong_together_are_refused(fault, tmp_path):
    other = part("tau_1")
    if fault == "another hour":
        other["time"] = TIME + 3600.0
    elif fault == "no clock":
        del other["time"]
    else:
        other["time"] = TIME % 5.0
    paths = [write_csv(tmp_path / "a.csv", part("q_1")), write_csv(tmp_path / "b.csv", other)]
    with pytest.raises(LogError):
        join_logs(paths)


def test_channels_of_one_file_at_instants_of_their_own_are_brought_to_the_positions(tmp_path):
    at = TIME[::5] + 0.0015
    time = np.sort(np.concatenate([TIME, at]))
    sparse = {"time": time}
    for name, own in (("q_1", TIME), ("q_2", TIME), ("tau_1", at), ("tau_2", at)):
        sparse[name] = np.full(len(time), np.nan)
        sparse[name][np.searchsorted(time, own)] = np.interp(own, TIME, COLUMNS[name])
    path = write_csv(tmp_path / "plot.csv", sparse)
    with pytest.raises(LogError, match="lack a value") as refusal:
        read_log(path)
    assert "veritorque logs join THIS -o run.parquet" in refusal.value.remedy
    joined = join_logs([path])
    joined.save(tmp_path / "run.parquet")
    rows = whole_rows(read_log(tmp_path / "run.parquet"))
    inside = slice(np.searchsorted(TIME, at[0]), np.searchsorted(TIME, at[-1], side="right"))
    np.testing.assert_allclose(rows.position[:, 1], COLUMNS["q_2"][inside], atol=1e-9)
    expected = np.interp(TIME[inside], at, np.interp(at, TIME, COLUMNS["tau_1"]))
    np.testing.assert_allclose(rows.torque[:, 0], expected, atol=1e-9)
    assert joined.notes[0] == "tau_1 and 1 more: interpolated at the stamps of q_1 and 1 more"


def test_a_few_missing_values_are_not_filled_in(tmp_path):
    torque = COLUMNS["tau_1"].copy()
    torque[300:310] = np.nan
    path = write_csv(tmp_path / "run.csv", part("q_1", tau_1=torque))
    np.testing.assert_array_equal(join_logs([path]).columns["tau_1"], torque)
