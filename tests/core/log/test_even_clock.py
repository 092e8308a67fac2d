"""Stamps that were rounded until rows share them are those of the even clock that they lie beside."""

import numpy as np
import pytest

from tests.core.log.writers import swing, write_csv, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log


def rounded(decimals: int, way=np.round, rate_hz: float = 250.0) -> dict[str, np.ndarray]:
    columns = swing(seconds=12.0, rate_hz=rate_hz)
    scale = 10.0**decimals
    return columns | {"time": way((5.0 + columns["time"]) * scale) / scale}


@pytest.mark.parametrize("way", [np.round, np.floor, np.ceil])
@pytest.mark.parametrize(("decimals", "rate_hz"), [(1, 250.0), (2, 250.0), (2, 241.7), (3, 2000.0)])
def test_rows_that_share_rounded_stamps_are_put_on_the_even_clock(way, decimals, rate_hz, tmp_path):
    columns = rounded(decimals, way, rate_hz)
    log = read_log(write_parquet(tmp_path / "log.parquet", columns))
    true = 5.0 + np.arange(len(columns["time"])) / rate_hz
    read = whole_rows(log).time
    assert np.abs(read - true).max() < 1.1 * 10.0**-decimals
    assert np.abs(np.diff(read) * rate_hz - 1.0).max() < 2e-3
    (found,) = [one for one in log.defects if one.kind == "rounded_stamps"]
    assert found.count == np.count_nonzero(np.diff(columns["time"]) == 0.0)
    assert "jitter" not in {one.kind for one in log.defects}


def test_a_part_of_the_log_has_the_clock_of_the_whole(tmp_path):
    log = read_log(write_csv(tmp_path / "log.csv", rounded(2)))
    np.testing.assert_array_equal(log.source.rows(700, 710).time, whole_rows(log).time[700:710])


@pytest.mark.parametrize("lost", [slice(1000, 1020), slice(300, 303)])
def test_rounded_stamps_beside_which_rows_are_missing_are_refused(lost, tmp_path):
    columns = {name: np.delete(values, lost) for name, values in rounded(2).items()}
    with pytest.raises(LogError, match="stamps occur twice"):
        read_log(write_csv(tmp_path / "log.csv", columns))


def test_a_stamp_that_occurs_twice_and_is_not_rounded_is_refused(tmp_path):
    columns = swing()
    columns["time"] = columns["time"] + 2e-4 * np.random.default_rng(1).uniform(size=3000)
    columns["time"][1000] = columns["time"][999]
    with pytest.raises(LogError, match="stamps occur twice"):
        read_log(write_csv(tmp_path / "log.csv", columns))


def test_stamps_that_are_rounded_and_differ_stay_as_they_are(tmp_path):
    columns = rounded(3)
    log = read_log(write_csv(tmp_path / "log.csv", columns))
    np.testing.assert_array_equal(whole_rows(log).time, columns["time"])


@pytest.mark.parametrize("rows", [1, 2, 3000])
def test_a_log_that_is_one_row_again_and_again_is_refused(rows, tmp_path):
    columns = {name: np.repeat(values[:1], rows) for name, values in swing().items()}
    with pytest.raises(LogError):
        read_log(write_csv(tmp_path / "log.csv", columns))
