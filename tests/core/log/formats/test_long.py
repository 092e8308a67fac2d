"""A long table, a row per joint and instant, becomes columns; what cannot become them is refused."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.core.log.writers import swing
from veritorque.core.errors import LogError
from veritorque.core.log.check import check_log
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)
NAMES = {"joint": ("shoulder", "elbow"), "axis": (1, 2), "Motor_ID": (11, 12), "name": ("b", "a")}


def long_rows(key, header):
    rows = [
        f"{time:.6f},{name},{COLUMNS[f'q_{joint}'][row]:.12f},{COLUMNS[f'tau_{joint}'][row]:.12f}"
        for row, time in enumerate(COLUMNS["time"])
        for joint, name in enumerate(NAMES[key], 1)
    ]
    return "\n".join([header.replace("KEY", key), *rows])


@pytest.mark.parametrize("key", NAMES)
@pytest.mark.parametrize("header", ["time,KEY,position,torque", "t,KEY,pos,effort"])
def test_a_row_per_joint_becomes_columns_and_a_mapping_is_suggested_that_reads_them(key, header, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(long_rows(key, header))
    suggested = check_log(path).suggestion
    log = read_log(path, mapping=suggested)
    np.testing.assert_allclose(whole_rows(log).position[:, 1], COLUMNS["q_2"], atol=1e-9)
    np.testing.assert_allclose(whole_rows(log).torque[:, 0], COLUMNS["tau_1"], atol=1e-9)
    (defect,) = log.defects
    assert (defect.kind, key in defect.statement) == ("rearranged", True)


def test_a_row_per_signal_becomes_the_columns_that_it_names(tmp_path):
    names = list(COLUMNS)[1:]
    rows = len(COLUMNS["time"])
    table = pa.table(
        {
            "time": np.repeat(COLUMNS["time"], len(names)),
            "signal": names * rows,
            "value": np.column_stack([COLUMNS[name] for name in names]).ravel(),
        }
    )
    pq.write_table(table, tmp_path / "log.parquet")
    log = read_log(tmp_path / "log.parquet")
    np.testing.assert_array_equal(whole_rows(log).torque[:, 1], COLUMNS["tau_2"])


def test_rows_of_a_joint_that_are_missing_are_missing_values(tmp_path):
    path = tmp_path / "log.csv"
    rows = long_rows("joint", "time,KEY,position,torque").split("\n")
    path.write_text("\n".join(row for number, row in enumerate(rows) if number not in (778, 2001)))
    log = read_log(path, mapping=check_log(path).suggestion)
    kept = np.delete(np.arange(len(COLUMNS["time"])), [388, 1000])
    np.testing.assert_allclose(whole_rows(log).time, COLUMNS["time"][kept], atol=1e-9)
    np.testing.assert_allclose(whole_rows(log).position[:, 1], COLUMNS["q_2"][kept], atol=1e-9)
    assert [(defect.kind, defect.count) for defect in log.defects][1] == ("missing_values", 2)


def sometimes(number):
    return number % 2 and number % 10 > 5


def always(number):
    return number % 2


@pytest.mark.parametrize("late", [sometimes, always])
def test_joints_sampled_at_instants_of_their_own_are_refused(tmp_path, late):
    path = tmp_path / "log.csv"
    header, *rows = long_rows("joint", "time,KEY,position,torque").split("\n")
    own = [
        f"{float(time) + 0.001 * late(number):.6f},{rest}"
        for number, (time, _, rest) in enumerate(row.partition(",") for row in rows)
    ]
    path.write_text("\n".join([header, *own]))
    with pytest.raises(LogError, match="different stamps") as refusal:
        read_log(path)
    assert refusal.value.evidence["rows"] == {"shoulder": 3000, "elbow": 3000}


@pytest.mark.parametrize("often", [2, 40])
def test_a_column_called_id_does_not_make_a_table_long(tmp_path, often):
    path = tmp_path / "log.csv"
    header = ",".join([*COLUMNS, "id"])
    rows = [
        ",".join(f"{value:.9f}" for value in row) + f",{number % often == 0:d}"
        for number, row in enumerate(zip(*COLUMNS.values(), strict=True))
    ]
    path.write_text("\n".join([header, *rows]))
    assert read_log(path).ignored_columns == ("id",)


def test_a_counter_that_starts_again_does_not_make_a_table_long(tmp_path):
    """Joints that are asked in turn have an id that starts again, too, but each its own values."""
    path = tmp_path / "log.csv"
    rows = zip(COLUMNS["time"], COLUMNS["q_1"], COLUMNS["tau_1"], strict=True)
    lines = [f"{time:.6f},{number % 16},{q:.9f},{tau:.9f}" for number, (time, q, tau) in enumerate(rows)]
    path.write_text("\n".join(["time,id,q,tau", *lines]))
    log = read_log(path)
    assert (log.joints, log.samples) == (1, len(COLUMNS["time"]))


@pytest.mark.parametrize("key", ["joint", "Axis", "signal"])
def test_all_rows_of_a_joint_before_those_of_the_next_become_columns_too(tmp_path, key):
    columns = swing(joints=3)
    path = tmp_path / "log.csv"
    with path.open("w") as stream:
        stream.write(f"timestamp,{key},position,effort\n")
        for joint in (1, 2, 3):
            own = zip(columns["time"], columns[f"q_{joint}"], columns[f"tau_{joint}"], strict=True)
            stream.writelines(f"{t:.9f},joint_{joint},{q:.9f},{tau:.9f}\n" for t, q, tau in own)
    with pytest.raises(LogError) as refusal:
        read_log(path)
    mapping = refusal.value.evidence["suggested_mappings"][0]
    rows = whole_rows(read_log(path, mapping=mapping))
    np.testing.assert_allclose(rows.time, columns["time"], atol=1e-9)
    np.testing.assert_allclose(rows.position[:, 2], columns["q_3"], atol=1e-9)
    np.testing.assert_allclose(rows.torque[:, 1], columns["tau_2"], atol=1e-9)


def test_two_runs_of_the_same_instants_are_no_two_joints(tmp_path):
    columns = swing(joints=1)
    path = tmp_path / "log.csv"
    with path.open("w") as stream:
        stream.write("time,id,q_1,tau_1\n")
        for run in (1, 2):
            own = zip(columns["time"], columns["q_1"], columns["tau_1"], strict=True)
            stream.writelines(f"{t:.9f},{run},{q:.9f},{tau:.9f}\n" for t, q, tau in own)
    log = read_log(path)
    assert log.joints == 1
    assert [defect.kind for defect in log.defects][:1] == ["time_restarts"]
