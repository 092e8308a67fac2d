"""Tables keep every number whole, however narrow the terminal is."""

import io
import json
import re

import pytest
from rich.console import Console

from tests.app.terminal.conftest import run
from tests.core.report.documents import checked, conflict, diagnosed
from veritorque.app.json_text import json_bytes
from veritorque.app.schemas.setup_check import CheckDocument
from veritorque.app.terminal.output.columns import Column, print_table
from veritorque.app.terminal.output.findings import print_diagnosis
from veritorque.app.terminal.output.setup_check import print_check
from veritorque.app.terminal.output.tables import effort_column, print_result

COMMANDS = {
    "identify yumi-left examples/yumi/log.csv": "identify",
    "diagnose yumi-left examples/yumi/log.csv": "diagnose",
    "robots show yumi-left": "show",
}


@pytest.fixture
def printed(desk, identified, monkeypatch):
    """Print what a command prints in a terminal of some width."""
    documents = {"identify": identified.read_bytes(), "diagnose": json_bytes(diagnosed())}
    monkeypatch.setattr(
        "veritorque.app.terminal.backend.local.LocalBackend.run", lambda _, study, *__: documents[study.kind]
    )

    def at(width, command):
        monkeypatch.setattr("veritorque.app.terminal.output.streams.PIPED_WIDTH", width)
        ended = run(*command.split())
        assert ended.exit_code == 0, ended.output
        return ended.stdout

    return at


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("width", [79, 60, 40, 30, 16])
def test_a_narrow_terminal_shows_no_number_that_a_wide_one_does_not(printed, command, width):
    wide, narrow = printed(200, command), printed(width, command)
    assert "…" not in narrow
    assert set(re.findall(r"-?\d[\d.e+-]*", narrow)) <= set(re.findall(r"-?\d[\d.e+-]*", wide))


@pytest.mark.parametrize("width", [79, 40, 30])
def test_every_parameter_keeps_its_value_and_its_precision(printed, identified, width):
    rows = [line.split() for line in printed(width, next(iter(COMMANDS))).splitlines()]
    shown = {row[0].rstrip("*"): row[1:] for row in rows if row}
    for row in json.loads(identified.read_bytes())["base_parameters"]:
        assert shown[row["name"]][0] == f"{row['value']:.4g}"


def drawn(width, *columns):
    console = Console(width=width, file=io.StringIO())
    print_table(console, columns)
    return console.file.getvalue()


FOUR = (
    Column("joint", ["1", "2"]),
    Column("held out range", ["12.345", "0.1"], spare=1),
    Column("seen", ["-1.5e-07", "3"], spare=2),
    Column("name", ["shoulder", "é[red]"], is_text=True),
)


def test_headings_are_folded_before_a_column_is_left_out_and_the_column_that_is_is_named():
    widths = {width: drawn(width, *FOUR) for width in range(60, 5, -1)}
    assert "held out range" in widths[60]
    folded = next(text for text in widths.values() if "held out range" not in text)
    assert "columns omitted" not in folded
    first = next(text for text in widths.values() if "columns omitted" in text)
    assert first.endswith("columns omitted: seen\n")
    for width, text in widths.items():
        assert {"1", "2", "shoulder", "é[red]"} <= set(text.split())
        rows = [line for line in text.splitlines() if "shoulder" in line]
        assert len(rows) == 1
        assert len(rows[0].rstrip()) <= max(width, len("  joint  shoulder"))


@pytest.mark.parametrize(
    ("kinds", "heading", "cells"),
    [
        (("revolute", "revolute"), "rms, N m", ["1", "2"]),
        (("prismatic", "prismatic"), "rms, N", ["1", "2"]),
        (("prismatic", "revolute"), "rms", ["1 N", "2 N m"]),
    ],
)
def test_forces_of_prismatic_joints_are_told_in_newtons(kinds, heading, cells):
    document = {"robot": {"joints": [{"type": kind} for kind in kinds]}}
    rows = [{"joint": 1, "rms_torque": 1.0}, {"joint": 2, "rms_torque": 2.0}]
    column = effort_column(document, "rms", rows, "rms_torque", spare=1)
    assert (column.heading, list(column.cells)) == (heading, cells)


@pytest.mark.parametrize("show", [print_result, print_diagnosis])
def test_conflicts_and_warnings_come_before_every_result(show):
    document = diagnosed() | {"conflicts": [conflict()], "doubts": ["its conflict", "Motion is short"]}
    told = io.StringIO()
    show(Console(file=told, width=200), document)
    lines = told.getvalue().splitlines()
    assert lines[0] == "Robot and log disagree: exchange the channels of joints 1 and 2, error 47.1 → 4.83 %"
    begin, end = lines.index("{"), lines.index("}")
    assert json.loads("".join(lines[begin : end + 1])) == {
        "mapping": {"torque": {"columns": ["tau_2", "tau_1"]}}
    }
    assert lines[end + 2] == "Warning: Motion is short"
    assert "its conflict" not in told.getvalue()


def test_a_check_says_whether_it_agrees_and_what_the_log_shows():
    told = io.StringIO()
    CheckDocument.model_validate(checked())
    print_check(Console(file=told, width=160), checked())
    text = told.getvalue()
    order = [
        "Robot and log disagree",
        "Warning: Motion is short",
        "once they are corrected",
        "1 of 3 identifiable",
        "Poorly: MX2.",
        "Only with another motion: MY2.",
        "<1500",
        "Not separable: joint elasticity and torque ripple: this motion shows both on no joint",
    ]
    assert [text.index(words) for words in order] == sorted(text.index(words) for words in order)
    assert re.search(r"torque ripple +all", text)
    short = io.StringIO()
    print_check(Console(file=short, width=160), checked(shown=[], separable={}, not_separable=[]))
    assert "too short for a diagnosis" in short.getvalue()
