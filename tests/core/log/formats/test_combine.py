"""Lists that were saved as text become columns, and stamps in two columns one clock."""

import numpy as np
import pytest

from tests.core.log.writers import swing, write_csv
from veritorque.core.errors import LogError
from veritorque.core.log.check import check_log
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)


def text_of(form, rows=None):
    lines = ["timestamp,observation.state,observation.effort"]
    for row in range(len(COLUMNS["time"])):
        pairs = [
            form.format(*(f"{COLUMNS[f'{name}_{j}'][row]:.9f}" for j in (1, 2))) for name in ("q", "tau")
        ]
        lines.append(f'{COLUMNS["time"][row]:.6f},"{pairs[0]}","{pairs[1]}"')
    return "\n".join(lines if rows is None else rows(lines))


@pytest.mark.parametrize("form", ["[{}, {}]", "[{} {}]", "({}; {})", " [ {},  {} ] "])
def test_lists_saved_as_text_are_split_and_the_mapping_that_is_suggested_reads_them(form, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(text_of(form))
    log = read_log(path, mapping=check_log(path).suggestion)
    np.testing.assert_allclose(whole_rows(log).position[:, 1], COLUMNS["q_2"], atol=1e-8)
    assert "split into columns" in log.defects[0].statement


def test_lists_as_text_of_unlike_length_are_refused(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(text_of("[{}, {}]", lambda lines: [*lines[:50], *['3.0,"[1.0]","[1.0, 2.0]"'] * 900]))
    with pytest.raises(LogError, match="differ in length"):
        read_log(path)


@pytest.mark.parametrize(
    "names", [("sec", "nanosec"), ("header.stamp.sec", "header.stamp.nanosec"), ("secs", "nsecs")]
)
def test_seconds_and_nanoseconds_in_two_columns_are_one_clock(names, tmp_path):
    nanoseconds = 1_709_287_200_250_000_000 + np.round(COLUMNS["time"] * 1e9).astype(np.int64)
    table = {names[0]: nanoseconds // 10**9, names[1]: nanoseconds % 10**9}
    table |= {name: values for name, values in COLUMNS.items() if name != "time"}
    path = write_csv(tmp_path / "log.csv", table)
    suggested = check_log(path).suggestion
    assert suggested["time"] == {"column": "stamp_s", "unit": "s"}
    time = whole_rows(read_log(path, mapping=suggested)).time
    np.testing.assert_allclose(time - time[0], COLUMNS["time"], atol=1e-9)
