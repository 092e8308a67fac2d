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
