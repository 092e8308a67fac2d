"""A look at a log says what is in it, what is wrong, and how to say what is missing; and loads no solver."""

import json
import subprocess
import sys

import numpy as np
import pytest

from tests.app.planar_arm import columns
from tests.app.terminal.conftest import ROOT, run
from veritorque.app.terminal.output.exit_codes import Exit


def written(path, names, *, time_factor=1.0, angle_factor=1.0, change=lambda table: table):
    time, position, torque = columns(seconds=12.0)
    table = change(np.column_stack([time_factor * time, angle_factor * position, torque]))
    np.savetxt(path, table, delimiter=",", header=",".join(names), comments="", fmt="%.9g")
    return str(path)


DEFAULT = ("time", "q_1", "q_2", "tau_1", "tau_2")


def test_a_clean_log_is_told_with_its_columns_units_rate_and_reach(tmp_path):
    ended = run("logs", "check", written(tmp_path / "clean.csv", DEFAULT))
    assert ended.exit_code == 0
    words = " ".join(ended.stdout.split())
    assert "clean.csv: CSV, 5 columns" in words
    assert "2400 samples, 11.99 s at 200 Hz, 2 joints" in words
    assert "position rad q_1 q_2" in words
    assert "torque N m tau_1 tau_2" in words
    position = columns(seconds=12.0)[1]
    assert f"{position[:, 0].min():.4g} .. {position[:, 0].max():.4g}" in words
    assert ended.stdout.endswith("0 defects\n")


def broken(table):
    """A gap of half a second, a spike, and a stretch of repeated rows."""
    table = np.delete(table, slice(400, 500), axis=0)
    table[200, 3] += 500.0
    table[600:640, 1:] = table[600, 1:]
    return table


def test_defects_are_told_and_fail_only_where_that_is_asked_for(tmp_path):
    path = written(tmp_path / "broken.csv", DEFAULT, change=broken)
    ended = run("logs", "check", path)
    assert ended.exit_code == Exit.DONE
    kinds = {line.split()[0] for line in ended.stdout.partition("defects:")[2].splitlines() if line}
    assert {"gap", "outliers", "repeated_rows"} <= kinds
    assert "3 segments" in ended.stdout  # the recorder copied a row while the robot moved on
    assert run("logs", "check", path, "--fail-on-defects").exit_code == Exit.FOUND
    assert {
        one["kind"] for one in json.loads(run("logs", "check", path, "--json").stdout)["defects"]
    } == kinds


NAMES = {
    "words": ("Time [ms]", "Joint1 Position", "Joint2 Position", "Joint1 Torque", "Joint2 Torque"),
    "short": ("t", "pos1", "pos2", "trq1", "trq2"),
    "camel": ("timeStamp", "jointAngle0", "jointAngle1", "motorCurrent0", "motorCurrent1"),
}


def test_who_computes_with_a_foreign_file_is_told_what_suggests_its_mapping(tmp_path):
    path = written(tmp_path / "foreign.csv", NAMES["words"], time_factor=1.0, angle_factor=1.0)
    refused = run("identify", "yumi-left", path)
    assert refused.exit_code == Exit.INPUT
    assert "veritorque logs check LOG suggests a mapping" in refused.stderr


@pytest.mark.parametrize("names", NAMES.values(), ids=list(NAMES))
def test_the_mapping_that_is_suggested_is_one_that_can_be_used(tmp_path, names):
    path = written(tmp_path / "foreign.csv", names, time_factor=1000.0, angle_factor=57.29578)
    refused = run("logs", "check", path)
    assert refused.exit_code == Exit.INPUT
    assert "no column for time" in refused.stderr
    suggested = refused.stderr.partition("--mapping '")[2].partition("'")[0]
    mapping = json.loads(suggested)
    assert (mapping["time"]["unit"], mapping["position"]["unit"]) == ("ms", "deg")
    assert mapping["position"]["columns"] == list(names[1:3])
    mended = run("logs", "check", path, "--mapping", suggested, "--json")
    assert mended.exit_code == Exit.DONE
    told = json.loads(mended.stdout)
    assert told["rate_hz"] == pytest.approx(200.0, rel=1e-6)
    reach = next(one for one in told["reach"] if one["channel"] == "position")
    assert np.allclose(reach["high"], columns(seconds=12.0)[1].max(axis=0), atol=1e-6)


def test_a_recorder_that_is_known_is_suggested_by_its_name(tmp_path):
    names = ("timestamp", "actual_q_0", "actual_q_1", "actual_current_0", "actual_current_1")
    path = written(tmp_path / "ur.csv", names)
    refused = run("logs", "check", path)
    assert """--mapping '{"profile": "ur-rtde"}'""" in refused.stderr
    assert run("logs", "check", path, "--profile", "ur-rtde").exit_code == Exit.DONE


def test_names_that_tell_nothing_are_not_guessed_at(tmp_path):
    refused = run("logs", "check", written(tmp_path / "dumb.csv", ("a", "b", "c", "d", "e")))
    assert (refused.exit_code, "--mapping" in refused.stderr) == (Exit.INPUT, False)


def test_what_is_no_log_says_so(tmp_path):
    (tmp_path / "page.csv").write_text("<html>")
    for name in ("page.csv", "absent.csv"):
        refused = run("logs", "check", str(tmp_path / name))
        assert (refused.exit_code, "remedy:" in refused.stderr) == (Exit.INPUT, True)


def test_a_look_loads_no_solver_and_no_service(tmp_path):
    """What is loaded decides how long it takes: the rest is reading the file."""
    path = written(tmp_path / "clean.csv", DEFAULT)
    script = (
        "import sys; from typer.testing import CliRunner; from veritorque.app.terminal.main import COMMANDS\n"
        f"assert CliRunner().invoke(COMMANDS, ['logs', 'check', {path!r}]).exit_code == 0\n"
        "print(*sys.modules)"
    )
    ended = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, cwd=ROOT, check=True
    )
    loaded = set(ended.stdout.split())
    heavy = {"numba", "cvxpy", "clarabel", "scipy", "sklearn", "fastapi", "sqlalchemy", "httpx2", "pandas"}
    assert not loaded & heavy
    assert "pyarrow" in loaded


def without(*columns):
    kept = [place for place, name in enumerate(DEFAULT) if name not in columns]
    return [DEFAULT[place] for place in kept], lambda table: table[:, kept]


def renamed(**names):
    return [names.get(name, name) for name in DEFAULT], lambda table: table


def set_to(row, column, value):
    """Write a value, or that of the row before where it is None."""

    def change(table):
        table[row, column] = table[row - 1, column] if value is None else value
        return table

    return DEFAULT, change


FAULTS = {
    "no torque at all": (without("tau_1", "tau_2"), "no column for torque", "log the torque of every joint"),
    "torque of one joint absent": (without("tau_2"), "absent: tau_2", "log torque of every joint"),
    "position of the last joint absent": (without("q_2"), "absent: q_2", "log position of every joint"),
    "position of the first joint absent": (without("q_1"), "no column for position: q_1", "of every joint"),
    "counted from 0": (
        renamed(q_1="q_0", q_2="q_1", tau_1="tau_0", tau_2="tau_1"),
        "counted from 0",
        "rename them q_1",
    ),
    "no clock": (without("time"), "no column for time", '{"rate_hz": 250}'),
    "values that are none": (set_to(slice(100, 2000), 2, np.nan), "first_rows: 101", "logs join"),
    "a stamp twice": (set_to(200, 0, None), "duplicate stamps: 1", '"time": null'),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_what_is_wrong_is_told_by_cause_evidence_and_remedy(tmp_path, fault):
    (names, change), evidence, remedy = FAULTS[fault]
    refused = run("logs", "check", written(tmp_path / "faulty.csv", names, change=change))
    assert refused.exit_code == Exit.INPUT
    said, told = refused.stderr.split("  remedy: ")
    assert said.startswith("error: ")
    assert "log: faulty.csv" in said
    assert evidence in said
    assert remedy in told.splitlines()[0]


@pytest.mark.parametrize("fault", FAULTS)
def test_a_suggestion_is_made_only_where_it_leads_somewhere(tmp_path, fault):
    (names, change), *_ = FAULTS[fault]
    path = written(tmp_path / "faulty.csv", names, change=change)
    suggested = run("logs", "check", path).stderr.partition("--mapping '")[2].partition("'")[0]
    assert bool(suggested) == (fault in ("counted from 0", "no clock"))
    if suggested:
        known = suggested.replace('"?"', "200")
        assert run("logs", "check", path, "--mapping", known).exit_code == Exit.DONE


def test_default_names_in_degrees_are_told_with_the_mapping_that_corrects_them(tmp_path):
    path = written(tmp_path / "scaled.csv", DEFAULT, angle_factor=57.29578)
    seen = run("logs", "check", path)
    assert (seen.exit_code, "implausible_unit" in seen.stdout) == (Exit.DONE, True)
    assert run("logs", "check", path, "--fail-on-defects").exit_code == Exit.FOUND
    suggested = seen.stderr.partition("--mapping '")[2].partition("'")[0]
    assert list(json.loads(suggested)) == ["position"]
    assert json.loads(suggested)["position"]["unit"] == "deg"
    mended = run("logs", "check", path, "--mapping", suggested, "--fail-on-defects")
    assert (mended.exit_code, mended.stderr) == (Exit.DONE, "")


def test_a_default_clock_in_milliseconds_is_refused_with_the_mapping_that_reads_it(tmp_path):
    path = written(tmp_path / "scaled.csv", DEFAULT, time_factor=1000.0)
    seen = run("logs", "check", path)
    assert seen.exit_code == Exit.INPUT
    suggested = seen.stderr.partition("--mapping '")[2].partition("'")[0]
    assert json.loads(suggested)["time"] == {"column": "time", "unit": "ms"}
    mended = run("logs", "check", path, "--mapping", suggested, "--fail-on-defects")
    assert (mended.exit_code, mended.stderr) == (Exit.DONE, "")


def test_a_recorder_whose_clock_counts_otherwise_is_suggested_with_the_clock_that_there_is(tmp_path):
    path = written(tmp_path / "panda.csv", ("time", "q[0]", "q[1]", "tau_J[0]", "tau_J[1]"))
    suggested = run("logs", "check", path).stderr.partition("--mapping '")[2].partition("'")[0]
    assert json.loads(suggested) == {"profile": "franka", "time": {"column": "time", "unit": "s"}}
    told = json.loads(run("logs", "check", path, "--mapping", suggested, "--json").stdout)
    assert told["rate_hz"] == pytest.approx(200.0, rel=1e-6)


def text_of(path, change):
    written(path, DEFAULT)
    path.write_text(change(path.read_text()))
    return str(path)


TEXTS = {
    "decimal commas between commas": (lambda text: text.replace(".", ","), "decimal commas", "semicolons"),
    "a line of other units": (
        lambda text: text.replace("\n", "\ns,deg,deg,Nm,Nm\n", 1),
        "unit in the file: deg",
        'map position with "unit": "deg"',
    ),
    "rows in the middle cut short": (
        lambda text: text.replace("\n", "\n0.0,1.0\n", 200).replace("\n0.0,1.0\n", "\n", 50),
        "holds 2 cells",
        "one cell per column",
    ),
    "a decimal comma further down": (
        lambda text: text.replace(",", ";")[::-1].replace(".", ",", 1)[::-1],
        "not made of numbers",
        "decimal commas in every row",
    ),
}


@pytest.mark.parametrize("fault", TEXTS)
def test_a_table_that_is_written_otherwise_says_how(tmp_path, fault):
    change, cause, remedy = TEXTS[fault]
    refused = run("logs", "check", text_of(tmp_path / "odd.csv", change))
    assert refused.exit_code == Exit.INPUT
    assert cause in refused.stderr.partition("  remedy: ")[0]
    assert remedy in refused.stderr.partition("  remedy: ")[2]


@pytest.mark.parametrize("sign", [";", "\t"])
def test_decimal_commas_are_understood_where_columns_are_not_set_apart_by_commas(tmp_path, sign):
    path = text_of(tmp_path / "comma.csv", lambda text: text.replace(",", sign).replace(".", ","))
    told = json.loads(run("logs", "check", path, "--json").stdout)
    assert (told["rate_hz"], told["defects"]) == (pytest.approx(200.0, rel=1e-6), [])


def test_files_of_one_run_are_joined_into_one_log(tmp_path):
    time, position, torque = columns(seconds=12.0)
    for name, values, prefix in (("positions", position, "q"), ("torques", torque, "tau")):
        header = f"time,{prefix}_1,{prefix}_2"
        np.savetxt(
            tmp_path / f"{name}.csv",
            np.column_stack([time, values]),
            delimiter=",",
            header=header,
            comments="",
        )
    both = [str(tmp_path / "positions.csv"), str(tmp_path / "torques.csv")]
    joined = run("logs", "join", *both, "-o", str(tmp_path / "run.parquet"))
    assert (joined.exit_code, "2400 rows" in joined.stdout) == (Exit.DONE, True)
    assert run("logs", "check", str(tmp_path / "run.parquet")).stdout.endswith("0 defects\n")
    assert run("logs", "join", *both, "-o", str(tmp_path / "none" / "run.parquet")).exit_code == Exit.INPUT
