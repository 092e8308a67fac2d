"""Text as recorders write it is read: titles, units, blanks, no header, dates, repeated and cut lines."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from tests.core.log.writers import swing
from veritorque.core.errors import LogError
from veritorque.core.log.check import check_log
from veritorque.core.log.formats.odd_rows import MOST_ODD
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)
NAMES = list(COLUMNS)
ROWS = [[f"{value:.9f}" for value in row] for row in zip(*COLUMNS.values(), strict=True)]
WITHOUT_CLOCK = {
    "time": None,
    "rate_hz": 250.0,
    "position": {"columns": ["q_1", "q_2"], "unit": "rad"},
    "torque": {"columns": ["tau_1", "tau_2"], "unit": "N m"},
}
BY_NUMBER = {
    "time": {"column": 1, "unit": "s"},
    "position": {"columns": [2, 3], "unit": "rad"},
    "torque": {"columns": [4, 5], "unit": "N m"},
}


def lines(delimiter=",", *, header=True, rows=ROWS):
    return ([delimiter.join(NAMES)] if header else []) + [delimiter.join(row) for row in rows]


def padded(delimiter):
    """Align the cells in columns, as print and savetxt do."""
    return [delimiter.join(f"{cell:>14}" for cell in row) for row in [NAMES, *ROWS]]


FILES = {
    "title lines": ["Recorder v2.1", "Date: 2024-03-01", "Operator: N. N.", "", *lines()],
    "a title with commas": ["arm, run 7, fast", *lines()],
    "titles in pairs": ["Name\tProject", "Rate\t250", "File\trun.bin", "Start\t133508", "", *lines("\t")],
    "titles above tabs": ["RECORDER\t", "axis log of 3 drives", *lines("\t")],
    "a row of units": [lines()[0], "s,rad,rad,Nm,Nm", *lines()[1:]],
    "a row of units in brackets": [lines(";")[0], "[s];[rad];[rad];[N m];[N m]", *lines(";")[1:]],
    "blanks": lines(" "),
    "aligned blanks": padded("  "),
    "blanks and tabs": padded(" \t"),
    "a trailing blank": [line + " " for line in lines(" ")],
    "a commented header above blanks": ["# " + lines(" ")[0], *lines(" ")[1:]],
    "the header again": [*lines()[:1000], lines()[0], *lines()[1000:], lines()[0]],
    "the header again between blanks": ["run", *lines(" ")[:1000], lines(" ")[0], *lines(" ")[1000:]],
    "a cut last line": [*lines(), "12.000,0.1"],
    "a cut last line of blanks": [*lines(" "), "12.000 0.1"],
    "decimal commas between blanks": [line.replace(".", ",") for line in lines(" ")],
    "a trailing tab": [line + "\t" for line in lines("\t")],
}


@pytest.mark.parametrize("kind", FILES)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_text_as_recorders_write_it_is_read_and_what_was_done_is_said(kind, end, tmp_path):
    path = tmp_path / "log.txt"
    path.write_bytes(end.join(FILES[kind]).encode())
    log = read_log(path)
    np.testing.assert_allclose(whole_rows(log).torque[:, 1], COLUMNS["tau_2"], atol=1e-9)
    assert [defect.kind for defect in log.defects] in ([], ["rearranged"])
    assert bool(log.defects) == (kind not in ("a trailing tab", "blanks and tabs"))


@pytest.mark.parametrize("delimiter", ["\t", " ", ";", ","])
@pytest.mark.parametrize("trailing", [False, True])
def test_a_table_without_header_is_read_by_the_numbers_of_its_columns(delimiter, trailing, tmp_path):
    path = tmp_path / "log.txt"
    after = delimiter if trailing else ""
    path.write_text("".join(line + after + "\n" for line in lines(delimiter, header=False)))
    with pytest.raises(LogError, match="has no header") as refusal:
        read_log(path)
    assert '"column": 1' in refusal.value.remedy
    log = read_log(path, mapping=BY_NUMBER)
    np.testing.assert_allclose(whole_rows(log).position[:, 1], COLUMNS["q_2"], atol=1e-9)
    with pytest.raises(LogError, match="names column 99"):
        read_log(path, mapping={**BY_NUMBER, "time": {"column": 99, "unit": "s"}})


def test_columns_with_names_can_be_given_by_number_too(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["t,a,b,c,d", *lines(header=False)]))
    assert read_log(path, mapping=BY_NUMBER).joints == 2


@pytest.mark.parametrize(
    ("start", "form"),
    [
        (datetime(2024, 3, 1, 10, 0, tzinfo=UTC), "%Y-%m-%dT%H:%M:%S.%f"),
        (datetime(2024, 12, 31, 23, 59, 55, tzinfo=UTC), "%Y-%m-%d %H:%M:%S.%f"),
        (datetime(2024, 3, 1, 10, 0, tzinfo=UTC), "%Y-%m-%dT%H:%M:%S.%fZ"),
        (datetime(2024, 3, 1, 10, 0, tzinfo=UTC), "%Y-%m-%dT%H:%M:%S.%f+01:00"),
        (datetime(2024, 3, 1, 10, 0, tzinfo=UTC), "%H:%M:%S.%f"),
        (datetime(2024, 3, 1, 23, 59, 55, tzinfo=UTC), "%H:%M:%S.%f"),
    ],
)
def test_dates_and_times_of_day_are_seconds_over_midnight_too(start, form, tmp_path):
    stamps = [(start + timedelta(seconds=float(t))).strftime(form) for t in COLUMNS["time"]]
    rows = [[stamp, *row[1:]] for stamp, row in zip(stamps, ROWS, strict=True)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(lines(rows=rows)))
    log = read_log(path)
    np.testing.assert_allclose(whole_rows(log).time, COLUMNS["time"], atol=2e-6)
    assert [defect.kind for defect in log.defects] == ["rearranged"]


def test_an_iso_stamp_without_a_fraction_is_a_stamp_too(tmp_path):
    start = datetime(2024, 3, 1, 10, 0, tzinfo=UTC)
    rows = [
        [(start + timedelta(seconds=float(t))).replace(tzinfo=None).isoformat(), *r[1:]]
        for t, r in zip(COLUMNS["time"], ROWS, strict=True)
    ]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(lines(rows=rows)))
    np.testing.assert_allclose(whole_rows(read_log(path)).time, COLUMNS["time"], atol=2e-6)


@pytest.mark.parametrize(
    ("row", "channel", "unit"),
    [
        ("s,deg,deg,Nm,Nm", "position", "deg"),
        ("ms,rad,rad,Nm,Nm", "time", "ms"),
        ("s,rad,rad,mNm,mNm", "torque", "mN m"),
    ],
)
def test_a_row_of_units_that_contradicts_the_default_names_is_not_passed_over(row, channel, unit, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join([lines()[0], row, *lines()[1:]]))
    with pytest.raises(LogError, match="the file says that") as refusal:
        read_log(path)
    assert refusal.value.evidence["unit_in_the_file"] == unit
    assert f'map {channel} with "unit": "{unit}"' in refusal.value.remedy


ODD = {
    "too few cells": lambda cells: cells[:2],
    "too many cells": lambda cells: [*cells, *cells],
    "two rows in one": lambda cells: [*cells[:3], *cells],
    "a cell alone": lambda cells: cells[:1],
    "a quotation mark of a lost byte": lambda cells: [*cells[:2], '"' + cells[2], *cells[3:]],
    "noise": lambda _: ["\x15\x7f~)"],
}


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " "])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("kind", ODD)
def test_a_few_rows_of_another_length_are_listed_by_line_and_cost_nothing_but_themselves(
    kind, end, delimiter, tmp_path
):
    """Every other row stands where it stood, with a clock and without one."""
    spoilt = [400, 401, 900, len(ROWS) - 1]
    text = ["# a comment", *lines(delimiter)]
    for row in spoilt:
        text[row + 2] = delimiter.join(ODD[kind](ROWS[row]))
    path = tmp_path / "log.txt"
    path.write_bytes(end.join([*text, ""]).encode())
    kept = np.delete(np.arange(len(ROWS)), spoilt)
    log = read_log(path)
    for own, time in (
        (log, COLUMNS["time"]),
        (read_log(path, mapping=WITHOUT_CLOCK), np.arange(len(ROWS)) / 250),
    ):
        rows = whole_rows(own)
        np.testing.assert_allclose(rows.time, time[kept], atol=1e-8)
        np.testing.assert_allclose(rows.torque[:, 1], COLUMNS["tau_2"][kept], atol=1e-9)
    said = log.defects[0].statement
    assert "3 rows with another number of cells than there are columns read as blank" in said
    assert "(lines 403, 404, 903)" in said
    assert f"the last row, cut short, left out (line {len(ROWS) + 2})" in said
    assert "repeated" not in said
    assert [(defect.kind, defect.count) for defect in log.defects[1:]][:1] == [("missing_values", 3)]


@pytest.mark.parametrize("last", ["-", "1.2e-", "-0.5e", "."])
def test_a_last_row_that_breaks_off_within_its_last_number_is_left_out(last, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join([*lines()[:-1], ",".join([*ROWS[-1][:-1], last])]))
    assert read_log(path).samples == len(ROWS) - 1


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize(
    "below",
    [
        ["end of measurement{}"],
        ["end{}", "rows;750{}", "stopped by operator"],
        ["", "stopped by operator", "end{}", ""],
    ],
    ids=["one", "three", "between empty ones"],
)
def test_lines_of_text_below_the_table_are_left_out_and_listed(below, delimiter, tmp_path):
    """They have as many cells as a row, or not; whatever stands above them is read as before."""
    path = tmp_path / "log.txt"
    filled = [line.format(delimiter * (len(ROWS[0]) - 1)) for line in below]
    path.write_text("\n".join([*lines(delimiter), *filled, ""]))
    log = read_log(path)
    np.testing.assert_allclose(whole_rows(log).torque[:, 1], COLUMNS["tau_2"], atol=1e-9)
    assert "below the table left out" in log.defects[0].statement


@pytest.mark.parametrize("where", [1, 400, len(ROWS) - 1])
def test_words_in_one_cell_between_the_rows_are_refused_with_what_was_found(where, tmp_path):
    text = lines()
    text[where] = ",".join([*ROWS[where - 1][:2], "fault", *ROWS[where - 1][3:]])
    path = tmp_path / "log.csv"
    path.write_text("\n".join(text))
    with pytest.raises(LogError, match="not made of numbers") as refusal:
        read_log(path)
    assert refusal.value.evidence["found"] == "fault"


@pytest.mark.parametrize("more", [0, 1])
def test_rows_of_another_length_are_refused_where_they_are_no_rare_damage(more, tmp_path):
    odd = int(MOST_ODD * len(ROWS)) + more
    text = lines()
    for row in range(odd):
        text[3 * row + 11] = "0.1,0.2"
    path = tmp_path / "log.csv"
    path.write_text("\n".join(text))
    if not more:
        assert read_log(path).samples == len(ROWS) - odd
        return
    with pytest.raises(LogError, match="line 12 holds 2 cells, and the header names 5 columns") as refusal:
        read_log(path)
    assert f"{odd} of {len(ROWS)} rows" in refusal.value.cause
    assert refusal.value.evidence["lines"][:3] == [12, 15, 18]
    assert "one cell per column" in refusal.value.remedy


@pytest.mark.parametrize("key", [["shoulder", "elbow"], ["1", "2"]])
def test_a_row_of_another_length_costs_a_long_table_one_joint_at_one_instant(key, tmp_path):
    rows = [
        f"{time:.6f},{name},{COLUMNS[f'q_{j}'][row]:.9f},{COLUMNS[f'tau_{j}'][row]:.9f}"
        for row, time in enumerate(COLUMNS["time"])
        for j, name in enumerate(key, 1)
    ]
    rows[501] = rows[501][:12]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["time,joint,position,effort", *rows]))
    mapping = {
        "position": {"columns": [f"position.{name}" for name in key], "unit": "rad"},
        "torque": {"columns": [f"effort.{name}" for name in key], "unit": "N m"},
    }
    log = read_log(path, mapping=mapping)
    kept = np.delete(np.arange(len(ROWS)), 250)
    np.testing.assert_allclose(whole_rows(log).position[:, 1], COLUMNS["q_2"][kept], atol=1e-8)


@pytest.mark.parametrize("repeated", [False, True])
def test_the_code_page_of_windows_is_read_with_its_degrees_and_umlauts(repeated, tmp_path):
    columns = swing(joints=2)
    names = ["Zeit", "Lage Achse 1 [°]", "Lage Achse 2 [°]", "Moment Größe 1 [Nm]", "Moment Größe 2 [Nm]"]
    rows = [";".join(f"{value:.9g}" for value in row) for row in np.column_stack(list(columns.values()))]
    header = ";".join(names)
    rows = [*rows[:100], header, *rows[100:]] if repeated else rows
    path = tmp_path / "messung.csv"
    path.write_bytes("\r\n".join(["Prüfstand 3", header, *rows]).encode("cp1252"))
    seen = check_log(path)
    assert seen.columns == tuple(names)
    assert seen.suggestion["position"] == {"columns": names[1:3], "unit": "deg"}
    log = read_log(path, mapping=seen.suggestion)
    np.testing.assert_allclose(np.degrees(whole_rows(log).position[:, 0]), columns["q_1"], atol=1e-7)
    assert "read as Windows-1252" in log.defects[0].statement


@pytest.mark.parametrize("order", ["utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("kind", FILES)
def test_text_in_utf_16_with_its_mark_is_read_as_in_utf_8(kind, order, tmp_path):
    text = "\r\n".join(["Prüfstand №3", "", *FILES[kind]])
    (tmp_path / "utf8.txt").write_bytes(text.encode())
    (tmp_path / "utf16.txt").write_bytes(("\ufeff" + text).encode(order))
    expected, log = read_log(tmp_path / "utf8.txt"), read_log(tmp_path / "utf16.txt")
    for own, other in zip(
        whole_rows(log).channels().values(), whole_rows(expected).channels().values(), strict=True
    ):
        np.testing.assert_array_equal(own, other)
    said = log.defects[0].statement
    assert said.replace("the text read as UTF-16; ", "") == expected.defects[0].statement != said


@pytest.mark.parametrize("bytes_more", range(4))
def test_text_in_utf_16_that_ends_within_a_character_loses_no_row_before(bytes_more, tmp_path):
    whole = ("\ufeff" + "\n".join([*lines(), "12.0"])).encode("utf-16-le")
    path = tmp_path / "log.csv"
    path.write_bytes(whole[: len(whole) - bytes_more])
    assert read_log(path).samples == len(ROWS)


@pytest.mark.parametrize(
    ("encoding", "cause"),
    [
        ("utf-16-le", r"UTF-16 text \(lower byte first\) without a byte order mark"),
        ("utf-16-be", r"UTF-16 text \(upper byte first\) without a byte order mark"),
        ("utf-32", "UTF-32 text"),
        ("utf-32-le", "NUL bytes"),
    ],
)
def test_text_in_an_encoding_that_is_not_read_is_refused_with_its_name(encoding, cause, tmp_path):
    path = tmp_path / "log.csv"
    path.write_bytes("\n".join(["Prüfstand 3", *lines()]).encode(encoding))
    with pytest.raises(LogError, match=cause) as refusal:
        read_log(path)
    assert "UTF-8" in refusal.value.remedy or encoding == "utf-32-le"


def test_halves_of_characters_deep_in_utf_16_are_refused_by_their_place(tmp_path):
    whole = ("\ufeff" + "\n".join(lines())).encode("utf-16-le")
    path = tmp_path / "log.csv"
    path.write_bytes(whole[:60_000] + b"\x00\xd8" + whole[60_000:])
    with pytest.raises(LogError, match="not UTF-16") as refusal:
        read_log(path)
    assert refusal.value.evidence["byte"] == 60_000


@pytest.mark.parametrize(("text", "what"), [("{}", "JSON"), ("<a/>", "XML"), ("a,\0", "NUL")])
def test_what_is_no_table_in_utf_8_is_none_in_utf_16(text, what, tmp_path):
    (tmp_path / "upload").write_bytes((text * 20).encode("utf-16"))
    with pytest.raises(LogError, match=what):
        read_log(tmp_path / "upload")
