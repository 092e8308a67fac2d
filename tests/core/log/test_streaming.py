"""Reading piece by piece must be reading, and must not need more memory for a longer log."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.log.writers import swing, write_csv, write_parquet
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays, read_log

ROWS = 75_000


@pytest.fixture(scope="module", params=[ROWS, 10_000], ids=["one_group", "eight_groups"])
def long_log(request, tmp_path_factory):
    columns = swing(seconds=300.0)
    mapping = {
        "time": {"column": "time", "unit": "ms"},
        "position": {"columns": ["q_1", "q_2", "q_3"], "unit": "deg"},
    }
    columns["time"] = columns["time"] * 1e3
    path = write_parquet(tmp_path_factory.mktemp("long") / "log.parquet", columns, request.param)
    return read_log(path, mapping=mapping), columns


def columns_of(rows):
    return np.column_stack([rows.time, rows.position, rows.torque])


@given(requests=st.lists(st.tuples(st.integers(0, ROWS), st.integers(0, 40_000)), min_size=1, max_size=8))
def test_any_rows_in_any_order_are_the_same_as_in_a_whole_reading(long_log, requests):
    log, columns = long_log
    whole = np.column_stack(list(columns.values()))
    whole[:, 0] *= 1e-3
    whole[:, 1:4] *= np.pi / 180
    for start, length in requests:
        rows = log.source.rows(start, start + length)
        np.testing.assert_array_equal(columns_of(rows), whole[start : start + length])


def test_what_is_read_can_be_changed_without_changing_the_log(long_log):
    log, _ = long_log
    first = log.source.rows(100, 200)
    before = columns_of(first)
    first.time[:] = first.position[:] = 0.0
    np.testing.assert_array_equal(columns_of(log.source.rows(100, 200)), before)


def test_forward_reading_decodes_the_file_once_even_where_requests_overlap(long_log, monkeypatch):
    log, _ = long_log
    source = log.source
    rewinds = []
    source.rows(0, 1)
    original = source._rewind
    monkeypatch.setattr(source, "_rewind", lambda start: rewinds.append(start) or original(start))
    for start in range(200, ROWS, 5000):
        source.rows(start, start + 5200)
    assert rewinds == []
    source.rows(0, 10)
    assert len(rewinds) <= 1


def test_defects_do_not_depend_on_whether_the_log_lies_on_disk_or_in_memory(tmp_path):
    columns = swing(seconds=300.0)
    columns["tau_1"][40_000] += 100.0
    columns["time"][50_000:] += 3.0
    columns["q_2"][32_760:33_500] = columns["q_2"][32_760]
    columns["q_3"][32_750:32_800] = columns["q_3"][32_750]
    on_disk = read_log(write_parquet(tmp_path / "log.parquet", columns, 7777))
    as_text = read_log(write_csv(tmp_path / "log.csv", columns))
    rows = whole_rows(on_disk)
    in_memory = log_from_arrays("log", rows.time, rows.position, rows.torque)
    assert {defect.kind for defect in on_disk.defects} == {"gap", "outliers", "standstill", "stuck_channel"}
    assert on_disk.defects == as_text.defects == in_memory.defects
    assert on_disk.segments == as_text.segments == in_memory.segments


MEASURE = """
import re, sys
from pathlib import Path
from veritorque.core.log.reader import read_log
log = read_log(Path(sys.argv[1]))
for start in range(0, log.samples, 20_000):
    log.source.rows(max(start - 100, 0), start + 20_100)
status = Path("/proc/self/status").read_text()  # getrusage would count the process this one was forked from
print(log.samples, int(re.search(r"VmHWM:\\s+(\\d+)", status)[1]) // 1024)
"""


def peak_megabytes(path):
    root = Path(__file__).parents[3]
    command = [sys.executable, "-c", MEASURE, str(path)]
    # With Arrow's own pool of memory, whatever other tests have told the environment.
    plain = {name: value for name, value in os.environ.items() if name != "ARROW_DEFAULT_MEMORY_POOL"}
    done = subprocess.run(command, cwd=root, env=plain, capture_output=True, text=True, check=True)
    return int(done.stdout.split()[1])


def test_ten_times_the_rows_in_one_row_group_need_no_more_memory(tmp_path):
    """Of 2,000,000 rows one column is 16 MB as numbers: the bound is less than that."""
    short = write_parquet(tmp_path / "short.parquet", swing(seconds=800.0), 200_000)
    long = write_parquet(tmp_path / "long.parquet", swing(seconds=8000.0), 2_000_000)
    assert peak_megabytes(long) - peak_megabytes(short) < 12
