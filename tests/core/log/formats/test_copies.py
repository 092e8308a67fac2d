"""A clock that is written before every channel is one clock where its copies agree, as in TwinCAT Scope."""

import numpy as np
import pytest

from tests.core.log.writers import swing
from veritorque.core.errors import LogError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)
CHANNELS = {
    "Axis 1.ActPos": "q_1",
    "Axis 2.ActPos": "q_2",
    "Axis 1.ActTorque": "tau_1",
    "Axis 2.ActTorque": "tau_2",
}
LABELS = {
    "SymbolComment": "",
    "Data-Type": "REAL64",
    "SampleTime[ms]": "4",
    "Offset": "0",
    "ScaleFactor": "1",
}


def table(clock, groups, delimiter, *, late=0.0):
    """Give a line of names and rows, with a clock before each group of channels, the last perhaps late."""
    names, rows = [], []
    for number, group in enumerate(groups, start=1):
        names += [clock, *group]
        time = COLUMNS["time"] + (late if number == len(groups) else 0.0)
        rows += [[f"{1e3 * value:.3f}" for value in time]]
        rows += [[f"{value:.9f}" for value in COLUMNS[CHANNELS[name]]] for name in group]
    return [delimiter.join(names), *(delimiter.join(row) for row in zip(*rows, strict=True))]


def scope(groups, delimiter, end, *, symbols=True):
    """Write as TwinCAT Scope does: the project, a line per property of the channels, rows, a last word."""
    names, *rows = table("Name", groups, delimiter)
    first = [delimiter.join(pair) + end for pair in (("Name", "Project"), ("File", "C:\\scope.tcscopex"))]
    times = delimiter.join(["Starttime of export", "132245678901234567", "Montag", "10:23:11.123"])
    units = {"Unit": "rad"} if symbols else {}
    properties = [
        delimiter.join(cell for group in groups for cell in (word, *[value] * len(group)))
        for word, value in (LABELS | units if symbols else {}).items()
    ]
    return [*first, times, "", names + end, *(line + end for line in properties), "", *rows, "EOF"]


def suggested(path):
    with pytest.raises(LogError) as refusal:
        read_log(path)
    return refusal.value.evidence["suggested_mappings"][0]


ONE_EACH = [[name] for name in CHANNELS]
TOGETHER = [list(CHANNELS)]
IN_PAIRS = [list(CHANNELS)[:2], list(CHANNELS)[2:]]


@pytest.mark.parametrize("groups", [ONE_EACH, TOGETHER, IN_PAIRS])
@pytest.mark.parametrize(("delimiter", "end"), [(",", ""), ("\t", ""), ("\t", "\t"), (";", ";")])
def test_a_scope_of_twincat_is_read_by_the_mapping_that_is_suggested(groups, delimiter, end, tmp_path):
    path = tmp_path / "scope.csv"
    path.write_bytes("\r\n".join(scope(groups, delimiter, end)).encode())
    mapping = suggested(path)
    rows = whole_rows(read_log(path, mapping=mapping))
    assert mapping["time"] == {"column": "Time [ms]", "unit": "ms"}
    np.testing.assert_allclose(rows.time, COLUMNS["time"], atol=1e-9)
    np.testing.assert_allclose(rows.position[:, 1], COLUMNS["q_2"], atol=1e-9)
    np.testing.assert_allclose(rows.torque[:, 0], COLUMNS["tau_1"], atol=1e-9)


def test_a_scope_of_names_alone_is_read_too(tmp_path):
    path = tmp_path / "scope.csv"
    path.write_text("\n".join(scope(ONE_EACH, ",", "", symbols=False)))
    rows = whole_rows(read_log(path, mapping=suggested(path)))
    np.testing.assert_allclose(rows.torque[:, 1], COLUMNS["tau_2"], atol=1e-9)


def test_copies_of_a_clock_are_one_and_that_is_said(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join(table("Time", ONE_EACH, ",")))
    log = read_log(path, mapping=suggested(path))
    np.testing.assert_allclose(whole_rows(log).time, COLUMNS["time"], atol=1e-9)
    assert "'Time', which 4 columns are called and all hold alike" in log.defects[0].statement


@pytest.mark.parametrize("late", [1e-3, 0.5])
def test_clocks_of_one_name_that_differ_are_refused(late, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join(table("Time", ONE_EACH, ",", late=late)))
    with pytest.raises(LogError, match="two columns carry the same name") as refusal:
        read_log(path)
    assert "logs join" in refusal.value.remedy


@pytest.mark.parametrize("mark", ["|", ":"])
def test_text_of_one_column_is_refused_as_such(mark, tmp_path):
    path = tmp_path / "log.txt"
    path.write_text("\n".join(line.replace(",", mark) for line in table("Time", ONE_EACH, ",")))
    with pytest.raises(LogError, match="one column only") as refusal:
        read_log(path)
    assert "separate names and numbers" in refusal.value.remedy


@pytest.mark.parametrize(
    ("cell", "remedy"),
    [
        ("1.006,25", "between thousands"),
        ("1,006.25", "between thousands"),
        ("11/14/2023 10:13:23.204 PM", "2024-03-01 10:00:00.004"),
    ],
)
def test_the_remedy_for_a_cell_says_what_it_is(cell, remedy, tmp_path):
    path = tmp_path / "log.csv"
    cells = [f'"{cell}",0.1,0.2' for _ in range(200)]
    path.write_text("\n".join(["time,q_1,tau_1", *cells]))
    with pytest.raises(LogError, match="not made of numbers") as refusal:
        read_log(path)
    assert remedy in refusal.value.remedy


def test_a_list_over_two_lines_is_called_so(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["time,q,tau", *(['0.1,"[1. 2. 3.', ' 4. 5. 6.]","[1. 2. 3.]"'] * 200)]))
    with pytest.raises(LogError, match=r"quotation in line \d+ goes on") as refusal:
        read_log(path)
    assert "tolist" in refusal.value.remedy
