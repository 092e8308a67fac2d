"""Rows that lack a value are left out as if they had been cut out by hand, and are listed."""

import numpy as np
import pytest

from tests.core.log.writers import WRITERS, swing, write_csv, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.defects.examine import examine
from veritorque.core.log.model import whole_rows
from veritorque.core.log.pieces import missing, source, survey
from veritorque.core.log.reader import log_from_arrays, read_log

ROWS = 3000
SCATTERED = np.sort(np.random.default_rng(7).choice(np.arange(1, ROWS - 1), 60, replace=False))
PATTERNS = {"scattered": SCATTERED, "a stretch": np.arange(1200, 1700), "both": np.r_[SCATTERED, 2000:2050]}


def without(columns, rows):
    return {name: np.delete(values, rows) for name, values in columns.items()}


def same_log(log, by_hand):
    for name, values in whole_rows(by_hand).channels().items():
        np.testing.assert_array_equal(getattr(whole_rows(log), name), values)
    np.testing.assert_array_equal(whole_rows(log).time, whole_rows(by_hand).time)
    assert (log.rate_hz, log.segments, log.channels) == (by_hand.rate_hz, by_hand.segments, by_hand.channels)
    others = [defect for defect in log.defects if defect.kind not in ("missing_values", "bad_end")]
    assert others == list(by_hand.defects)


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("form", WRITERS)
def test_rows_that_lack_a_value_count_as_if_they_were_cut_out_by_hand(form, pattern, tmp_path):
    """What is computed of a log is computed of these rows and segments, so that it is the same as well."""
    columns, rows = swing(), PATTERNS[pattern]
    name, write = WRITERS[form]
    by_hand = read_log(write(tmp_path / f"hand-{name}", without(columns, rows)))
    for number, channel in enumerate(("q_1", "tau_1", "q_3", "tau_3", "time")):
        columns[channel][rows[number::5]] = [np.nan, np.inf, -np.inf, 1e300, np.nan][number]
    log = read_log(write(tmp_path / name, columns))
    same_log(log, by_hand)
    (defect,) = [defect for defect in log.defects if defect.kind == "missing_values"]
    assert defect.count == len(np.unique(rows))
    assert defect.joint is None
    assert f"'tau_3' in {len(rows[3::5])} rows from row {rows[3] + 1} on" in defect.statement


def test_what_is_missing_has_its_place_its_joint_and_its_first_row():
    time = np.arange(ROWS) / 250.0
    swing_ = np.sin(np.outer(time, [3.0, 4.0]))
    torque = 5.0 * swing_
    torque[[700, 701, 702, 1500], 1] = np.nan
    defect, *others = log_from_arrays("log", time, swing_, torque).defects
    assert [other.kind for other in others] == ["gap", "jitter"]
    assert (defect.kind, defect.channel, defect.joint, defect.count) == ("missing_values", "torque", 2, 4)
    assert defect.intervals == ((time[700], time[702]), (time[1500], time[1500]))
    assert "'tau_2' in 4 rows from row 701 on" in defect.statement


@pytest.mark.parametrize(
    "word", ["", "nan", "NaN", "NULL", "None", "-", "N/A", "inf", "-1.#IND", " ", " nan", " None"]
)
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_every_word_for_a_missing_value_leaves_its_row_out(word, delimiter, tmp_path):
    path = write_csv(tmp_path / "log.csv", swing(), delimiter)
    lines = path.read_text(encoding="utf-8").splitlines()
    for row in (500, 1200):
        lines[row] = delimiter.join([*lines[row].split(delimiter)[:-1], word])
    path.write_text("\n".join(lines), encoding="utf-8")
    log = read_log(path)
    assert log.samples == ROWS - 2
    defect, jitter = log.defects
    assert (defect.kind, defect.count, defect.joint) == ("missing_values", 2, 3)
    assert (jitter.kind, jitter.count) == ("jitter", 2)


def test_a_uniform_clock_runs_on_over_rows_that_lack_a_value(tmp_path):
    columns = swing()
    columns["q_2"][1000:1200] = np.nan
    del columns["time"]
    log = read_log(write_csv(tmp_path / "log.csv", columns), mapping={"rate_hz": 250.0})
    stamps = whole_rows(log).time
    np.testing.assert_allclose(np.max(np.diff(stamps)), 201 / 250.0)
    assert log.segments == ((0, 1000), (1000, ROWS - 200))


def test_ends_that_lack_values_are_bad_ends_however_long_and_cost_the_middle_nothing(tmp_path):
    columns = swing()
    columns["q_1"][:1200] = columns["tau_1"][-900:] = columns["tau_2"][[1500, 1600]] = np.nan
    log = read_log(write_parquet(tmp_path / "log.parquet", columns, group=500))
    assert log.samples == ROWS - 2102
    kinds = {defect.kind: defect for defect in log.defects}
    assert (kinds["bad_end"].count, kinds["missing_values"].count) == (2100, 2)
    np.testing.assert_allclose(
        kinds["bad_end"].intervals, [(0.0, 1199 / 250.0), (2100 / 250.0, 2999 / 250.0)]
    )


@pytest.mark.parametrize(("share", "left_out"), [(0.05, False), (0.2, True), (1.0, True)])
@pytest.mark.parametrize("prefix", ["temperature", "qd", "current"])
def test_a_channel_that_a_log_may_lack_is_left_out_rather_than_many_rows(prefix, share, left_out, tmp_path):
    columns, random = swing(), np.random.default_rng(2)
    names = {"temperature": "temperature", "qd": "velocity", "current": "current"}
    columns |= {f"{prefix}_{j}": np.gradient(columns[f"q_{j}"], columns["time"]) for j in (1, 2, 3)}
    rows = random.choice(np.arange(1, ROWS - 1), int(share * (ROWS - 2)), replace=False)
    columns[f"{prefix}_2"][rows] = np.nan
    log = read_log(write_csv(tmp_path / "log.csv", columns))
    assert (names[prefix] in log.channels) is not left_out
    assert log.samples == ROWS - (0 if left_out else len(rows))
    assert [d.channel for d in log.defects if d.kind == "missing_values"] == [names[prefix]]
    assert (f"{prefix}_2" in log.ignored_columns) is left_out


def test_rows_are_surveyed_block_by_block_to_the_same_end(tmp_path, monkeypatch):
    columns = swing()
    columns["q_1"][SCATTERED] = np.nan
    columns["time"][[5, 1800]] = np.nan
    path = write_parquet(tmp_path / "log.parquet", columns, group=700)
    whole = read_log(path)
    for module in (missing, source, survey):
        monkeypatch.setattr(module, "BLOCK_ROWS", 97)
    pieces = read_log(path)
    assert (pieces.defects, pieces.segments) == (whole.defects, whole.segments)
    np.testing.assert_array_equal(whole_rows(pieces).position, whole_rows(whole).position)
    assert pieces.source.samples == ROWS - 62
    for start in (0, 40, 1790, 2900):
        np.testing.assert_array_equal(
            pieces.source.rows(start, start + 30).time, whole_rows(whole).time[start : start + 30]
        )


@pytest.mark.parametrize("spoil", ["two runs", "shuffled"])
def test_rows_out_of_order_are_judged_without_those_that_lack_a_value(spoil, tmp_path):
    columns = swing()
    order = np.arange(ROWS)
    if spoil == "two runs":
        columns["time"][1500:] -= columns["time"][1500]
    else:
        order = np.random.default_rng(1).permutation(ROWS)
    columns = {name: values[order] for name, values in columns.items()}
    gaps = np.array([3, 700, 1499, 1500, 2000])
    by_hand = read_log(write_csv(tmp_path / "hand.csv", without(columns, gaps)))
    columns["time"][gaps[:2]] = columns["tau_1"][gaps[2:]] = np.nan
    log = read_log(write_csv(tmp_path / "log.csv", columns))
    np.testing.assert_array_equal(whole_rows(log).position, whole_rows(by_hand).position)
    assert log.segments == by_hand.segments
    if spoil == "two runs":
        statement = next(defect for defect in log.defects if defect.kind == "time_restarts").statement
        assert "in row 1502:" in statement  # of the file: row 1501, the run's first, lacks a value


def test_a_log_with_hardly_a_whole_row_is_refused_for_what_it_lacks(tmp_path):
    columns = swing()
    columns["tau_2"][60:] = np.nan
    with pytest.raises(LogError, match="'tau_2' holds 2940 values missing"):
        read_log(write_csv(tmp_path / "log.csv", columns))


def test_a_log_whose_joints_lack_values_in_turn_is_refused_although_each_has_most(tmp_path):
    columns = swing()
    for joint in (1, 2, 3):
        for shift in range(8):
            columns[f"tau_{joint}"][joint * 10 + shift :: 40] = np.nan
    with pytest.raises(LogError, match="1800 of 3000 rows lack a value") as caught:
        read_log(write_csv(tmp_path / "log.csv", columns))
    assert "veritorque logs join" in caught.value.remedy


def test_the_finders_see_no_row_that_lacks_a_value(tmp_path, monkeypatch):
    columns = swing()
    columns["tau_1"][SCATTERED] = np.nan
    seen = []
    monkeypatch.setattr(
        "veritorque.core.log.reader.examine",
        lambda source, *rest: (seen.append(source.rows(0, source.samples)), examine(source, *rest))[1],
    )
    read_log(write_csv(tmp_path / "log.csv", columns))
    assert np.isfinite(seen[0].torque).all()
