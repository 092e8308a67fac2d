"""Parquet as data sets of robots come in it: lists of joints, and stamps of a date."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.core.log.writers import swing
from veritorque.core.errors import LogError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=3)
POSITION = np.column_stack([COLUMNS[f"q_{j}"] for j in (1, 2, 3)])
TORQUE = np.column_stack([COLUMNS[f"tau_{j}"] for j in (1, 2, 3)])
MAPPING = {
    "time": {"column": "timestamp", "unit": "s"},
    "profile": "lerobot",
    "position": {"unit": "rad"},
    "torque": {"unit": "N m"},
}


@pytest.mark.parametrize(
    "kind",
    [pa.list_(pa.float64()), pa.large_list(pa.float64()), pa.list_(pa.float64(), 3), pa.list_(pa.float32())],
)
def test_lists_are_split_into_columns_and_that_is_said(kind, tmp_path):
    table = pa.table(
        {
            "observation.state": pa.array(POSITION.tolist(), kind),
            "observation.effort": pa.array(TORQUE.tolist(), kind),
            "timestamp": COLUMNS["time"],
            "task": ["wave"] * len(POSITION),
        }
    )
    pq.write_table(table, tmp_path / "log.parquet", row_group_size=700)
    log = read_log(tmp_path / "log.parquet", mapping=MAPPING)
    np.testing.assert_allclose(whole_rows(log).position, POSITION, atol=1e-6)
    np.testing.assert_allclose(log.source.rows(650, 750).torque, TORQUE[650:750], atol=1e-6)
    assert [defect.kind for defect in log.defects] == ["rearranged"]


@pytest.mark.parametrize("kind", [pa.list_(pa.float32()), pa.list_(pa.float64(), 3)])
def test_rows_whose_list_is_missing_or_cut_short_are_left_out(kind, tmp_path):
    lists = POSITION.tolist()
    lists[0] = lists[777] = None
    if kind.value_type == pa.float32():
        lists[900] = lists[900][:2]
        lists[901] = []
    table = pa.table(
        {
            "observation.state": pa.array(lists, kind),
            "observation.effort": pa.array(TORQUE.tolist(), pa.list_(pa.float64())),
            "timestamp": COLUMNS["time"],
        }
    )
    pq.write_table(table, tmp_path / "log.parquet", row_group_size=700)
    log = read_log(tmp_path / "log.parquet", mapping=MAPPING)
    left_out = [row for row, values in enumerate(lists) if values is None or len(values) < 3]
    np.testing.assert_array_equal(whole_rows(log).torque, np.delete(TORQUE, left_out, axis=0))
    kinds = {defect.kind: defect.count for defect in log.defects}
    assert (kinds["bad_end"], kinds["missing_values"]) == (1, len(left_out) - 1)


def test_lists_of_unlike_length_are_refused_by_name(tmp_path):
    lists = POSITION.tolist()
    lists[777:] = [values[:2] for values in lists[777:]]
    table = pa.table(
        {"observation.state": lists, "observation.effort": TORQUE.tolist(), "timestamp": COLUMNS["time"]}
    )
    pq.write_table(table, tmp_path / "log.parquet")
    with pytest.raises(LogError, match=r"'observation\.state' differ in length"):
        read_log(tmp_path / "log.parquet", mapping=MAPPING)


@pytest.mark.parametrize("kind", [pa.timestamp("ns"), pa.timestamp("us"), pa.timestamp("ms", "UTC")])
def test_stamps_of_a_date_are_seconds(kind, tmp_path):
    counts = pa.array(
        1_709_287_200_000_000_000 + np.round(COLUMNS["time"] * 1e9).astype(np.int64), pa.int64()
    )
    stamps = counts.cast(pa.timestamp("ns", kind.tz)).cast(kind, safe=False)
    columns = {name: pa.array(values) for name, values in COLUMNS.items()} | {"time": stamps}
    pq.write_table(pa.table(columns), tmp_path / "log.parquet")
    time = whole_rows(read_log(tmp_path / "log.parquet")).time
    np.testing.assert_allclose(time - time[0], COLUMNS["time"], atol=1e-6)
