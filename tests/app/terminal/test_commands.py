"""What commands print, where, and how they end."""

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from tests.app.http.test_server import listening_service
from tests.app.planar_arm import csv_log, description
from tests.app.stubs import InlineExecutor, StubExecutor, failing
from tests.app.terminal.conftest import ROOT, run
from tests.core.report.documents import diagnosed, nothing_found
from veritorque.app.client.client import Client
from veritorque.app.jobs import compute as computing
from veritorque.app.problems import KINDS
from veritorque.app.terminal.output.exit_codes import NO_RESULT, NO_SERVICE, Exit
from veritorque.core.errors import ExcitationError, LogError, SolverError

QUICK = ("--set", "bootstrap.draws=0")


@pytest.fixture
def planar(desk):
    """A folder with a robot of two joints and its log."""
    (desk / "arm.json").write_text(json.dumps(description()))
    (desk / "list.json").write_text("[]")
    (desk / "swing.csv").write_bytes(csv_log())
    return desk


def no_tables(ended):
    return ended.stdout == ""


def test_files_and_a_service_give_the_same_document_byte_for_byte(planar, tmp_path_factory):
    here = run("identify", "arm.json", "swing.csv", *QUICK, "--json")
    with listening_service(tmp_path_factory.mktemp("data"), InlineExecutor()) as (_, port):
        url = f"http://127.0.0.1:{port}"
        there = run("identify", "arm.json", "swing.csv", *QUICK, "--json", VERITORQUE_URL=url)
        with Client(url) as client:
            (job,) = client.jobs()
            stored = client.result_bytes(job)
    assert (here.exit_code, there.exit_code) == (0, 0)
    assert here.stdout_bytes == there.stdout_bytes == stored
    assert "estimate" in here.stderr
    assert f"job {job.id}" in there.stderr


def test_what_is_odd_in_a_description_is_said_before_a_result_computed_from_it(planar):
    hanging = description() | {"gravity": [0.0, 0.0, 9.81]}
    (planar / "arm.json").write_text(json.dumps(hanging))
    ended = run("identify", "arm.json", "swing.csv", *QUICK)
    assert "warning: gravity points along +z of the base" in ended.stderr


def test_tables_are_plain_where_they_are_piped(desk, identified, monkeypatch):
    monkeypatch.setattr(
        "veritorque.app.terminal.backend.local.LocalBackend.run", lambda *_: identified.read_bytes()
    )  # the same document, printed
    ended = run("identify", "yumi-left", "examples/yumi/log.csv", COLUMNS="40")
    rows = [line.split() for line in ended.stdout.splitlines()]
    result = json.loads(identified.read_text())
    friction = next(row for row in rows if row and row[0] == "FV1*")
    known = next(row for row in result["base_parameters"] if row["name"] == "FV1")
    assert friction[1] == f"{known['value']:.4g}"
    assert friction[-3:] == ["N", "m", "s/rad"]
    assert [row[0] for row in rows if len(row) == 6 and row[0].isdigit()] == [*"1234567"]
    assert "98 standard -> 71 base" in ended.stdout
    assert "\x1b" not in ended.output


@pytest.mark.parametrize(("document", "code"), [(diagnosed(), Exit.FOUND), (nothing_found(), Exit.DONE)])
def test_a_diagnosis_fails_on_findings_only_where_that_is_asked_for(desk, monkeypatch, document, code):
    content = json.dumps(document).encode()
    monkeypatch.setattr("veritorque.app.terminal.backend.local.LocalBackend.run", lambda *_: content)
    command = ("diagnose", "yumi-left", "examples/yumi/log.csv")
    assert run(*command).exit_code == Exit.DONE
    failing_run = run(*command, "--fail-on-findings", "--json")
    assert (failing_run.exit_code, failing_run.stdout_bytes) == (code, content)


def test_every_kind_of_problem_has_one_exit_code():
    assert NO_RESULT.isdisjoint(NO_SERVICE)
    assert (NO_RESULT - {"dismissed"}) | NO_SERVICE <= set(KINDS)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("identify", "nobody", "swing.csv"), "yumi-left"),
        (("identify", "arm.json", "absent.csv"), "absent.csv cannot be read"),
        (("identify", "yumi-left", "swing.csv"), "different numbers of joints"),
        (("identify", "arm.json", "swing.csv", "--set", "estimator=guess"), "sdp"),
        (("identify", "arm.json", "swing.csv", "--set", "estimator"), "is not an option"),
        (("identify", "arm.json", "swing.csv", "--options", "{"), "the options cannot be read"),
        (("identify", "arm.json", "swing.csv", "--mapping", "[1]"), "the mapping must be a JSON object"),
        (("identify", "arm.json", "swing.csv", "--out", "nowhere/result.json"), "cannot be written"),
        (("diagnose", "arm.json", "swing.csv", "--reference", "gone.json"), "no result gone.json"),
        (("diagnose", "arm.json", "swing.csv", "--reference", "swing.csv"), "cannot be read as a result"),
        (("diagnose", "arm.json", "swing.csv", "--reference", "arm.json"), "is not a result document"),
        (("diagnose", "arm.json", "swing.csv", "--reference", "list.json"), "is not a result document"),
        (("report", "swing.csv"), "cannot be read as a result"),
        (("report", "arm.json"), "is not a result document"),
        (("export", "result.json", "robot.step"), "robot.urdf"),
        (("robots", "show", "arm.json", "--gravity", "down"), "not three numbers"),
        (("identify", "arm.json", "swing.csv", "--out", "examples"), "it is a folder"),
        (("identify", "arm.json", "swing.csv", "--set", "a=1", "--set", "a.b=1"), "not both"),
        (("identify", "arm.json", "swing.csv", "--options", "[1]"), "the options must be a JSON object"),
        (("robots", "show", "arm.json", "--gravity", "0,0,1"), "is no URDF"),
        (("robots", "show", "yumi", "--base-link", "base"), "is no URDF"),
        (("robots", "check", "list.json"), "the description is not an object"),
        (("robots", "check", "./gone.json", "--url", "http://127.0.0.1:1"), "gone.json cannot be read"),
        (("report", "./gone.json", "--url", "http://127.0.0.1:1"), "cannot be read as a result"),
        (("logs", "check", "absent.csv"), "it is not there"),
        (("logs", "check", "examples"), "it is no file"),
        (("logs", "check", "swing.csv", "arm.json"), "log: arm.json"),
        (("identify",), "Missing argument"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_what_cannot_be_used_ends_with_2_and_says_what_to_do(planar, arguments, said):
    ended = run(*arguments)
    assert ended.exit_code == Exit.INPUT
    assert said in ended.stderr
    assert no_tables(ended)
    assert "Traceback" not in ended.output


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (LogError("the log is empty", remedy="move"), Exit.INPUT),
        (ExcitationError("the motion is too slow", remedy="move"), Exit.NO_RESULT),
        (SolverError("no optimum", remedy="move"), Exit.NO_RESULT),
        (KeyboardInterrupt(), Exit.INTERRUPTED),
    ],
)
def test_a_computation_that_gives_nothing_says_so_by_its_code(planar, monkeypatch, error, code):
    def stopped(*_):
        raise error

    monkeypatch.setattr(computing, "compute", stopped)
    ended = run("identify", "arm.json", "swing.csv", "--json")
    assert (ended.exit_code, no_tables(ended)) == (code, True)
    assert getattr(error, "cause", "interrupted") in ended.stderr


def test_a_mistake_of_ours_leaves_its_trace_in_a_file_and_not_on_the_screen(planar, monkeypatch):
    def mistaken(*_):
        raise ZeroDivisionError("by zero")

    monkeypatch.setattr(computing, "compute", mistaken)
    monkeypatch.setattr(tempfile, "tempdir", str(planar))
    ended = run("identify", "arm.json", "swing.csv")
    assert ended.exit_code == Exit.MISTAKE
    assert "Traceback" not in ended.output
    (trace,) = planar.glob("veritorque-*.txt")
    assert str(trace) in ended.stderr
    assert "ZeroDivisionError: by zero" in trace.read_text()


def test_a_service_that_is_not_there_ends_with_4_and_never_shows_the_key(planar):
    ended = run("robots", "list", "--url", "http://127.0.0.1:9", VERITORQUE_KEY="the-secret")
    assert ended.exit_code == Exit.NO_SERVICE
    assert "veritorque serve" in ended.stderr
    assert "the-secret" not in ended.output


def test_a_job_that_fails_on_a_service_ends_as_it_would_here(planar, tmp_path_factory):
    executor = failing()
    executor.release.set()
    with listening_service(tmp_path_factory.mktemp("data"), executor) as (_, port):
        ended = run("identify", "arm.json", "swing.csv", "--url", f"http://127.0.0.1:{port}")
    assert (ended.exit_code, no_tables(ended)) == (Exit.NO_RESULT, True)
    assert "the motion is too slow" in ended.stderr
    assert "move faster" in ended.stderr


def test_a_report_made_from_files_shows_what_was_measured_and_estimated_as_the_service_s_does(
    planar, tmp_path_factory
):
    with listening_service(tmp_path_factory.mktemp("data"), InlineExecutor()) as (_, port):
        url = f"http://127.0.0.1:{port}"
        for name, service in (("here.html", ""), ("there.html", url)):
            asked = ("identify", "arm.json", "swing.csv", *QUICK, "--report", name)
            assert run(*asked, VERITORQUE_URL=service).exit_code == 0
    here, there = ((planar / name).read_text() for name in ("here.html", "there.html"))
    assert here.count("<svg") == there.count("<svg") >= 4


def test_what_a_job_computed_instant_by_instant_is_fetched_as_a_file_and_missed_in_a_result(
    planar, tmp_path_factory
):
    with listening_service(tmp_path_factory.mktemp("data"), InlineExecutor()) as (_, port):
        service = ("--url", f"http://127.0.0.1:{port}")
        asked = run("identify", "arm.json", "swing.csv", *QUICK, "--out", "arm-result.json", *service)
        job = asked.stderr.partition("job ")[2].split()[0]
        assert run("export", job, "residuals.parquet", *service).exit_code == Exit.DONE
    table = pq.read_table(planar / "residuals.parquet")
    assert {"time", "residual_1", "torque_estimated_2", "used_2"} <= set(table.column_names)
    assert table.num_rows > 100
    refused = run("export", "arm-result.json", "residuals.parquet")
    assert (refused.exit_code, "--url" in refused.stderr) == (Exit.INPUT, True)
    assert "residuals.parquet" in run("export", "--list").stdout


def test_a_report_of_a_result_says_which_figures_it_cannot_have(desk):
    whole = run("report", "result.json", "--out", "page.html")
    assert (whole.exit_code, "identify --report" in whole.stderr) == (Exit.DONE, True)
    assert (desk / "page.html").is_file()


def test_a_job_that_was_taken_before_the_interruption_came_is_dismissed_all_the_same(
    planar, tmp_path_factory, monkeypatch
):
    submit, taken = Client.submit, []

    def interrupted(client, *asked):
        taken.append(submit(client, *asked))
        if len(taken) == 1:
            raise KeyboardInterrupt
        return taken[-1]

    monkeypatch.setattr(Client, "submit", interrupted)
    with listening_service(tmp_path_factory.mktemp("data"), StubExecutor()) as (_, port):
        url = f"http://127.0.0.1:{port}"
        ended = run("identify", "arm.json", "swing.csv", VERITORQUE_URL=url)
        with Client(url) as client:
            (job,) = client.jobs()
    assert (ended.exit_code, job.state) == (Exit.INTERRUPTED, "dismissed")


@pytest.mark.parametrize("spoilt", [{"robot": None}, {"logs": None}, {"kind": "guess"}])
def test_a_result_that_was_changed_is_refused_by_name(planar, spoilt):
    (planar / "spoilt.json").write_text(json.dumps(nothing_found() | spoilt))
    ended = run("report", "spoilt.json")
    assert ended.exit_code == Exit.INPUT
    assert "spoilt.json is not a result document" in ended.stderr
    assert next(iter(spoilt)) in ended.stderr


@pytest.mark.parametrize("told", [signal.SIGINT, signal.SIGTERM])
def test_interrupting_the_command_dismisses_the_job(planar, tmp_path_factory, told):
    executor = StubExecutor()
    with listening_service(tmp_path_factory.mktemp("data"), executor) as (_, port):
        url = f"http://127.0.0.1:{port}"
        command = [sys.executable, "-m", "veritorque", "identify", "arm.json", "swing.csv", "--url", url]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        # Whoever runs the tests in the background has told their children to be deaf to Ctrl-C.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True) as process:
            signal.signal(signal.SIGINT, before)
            assert executor.started.wait(60.0)
            process.send_signal(told)
            _, said = process.communicate(timeout=60.0)
        assert (process.returncode, said.splitlines()[-1]) == (Exit.INTERRUPTED, "interrupted")
        assert executor.stopped.wait(10.0)


def test_a_result_on_disk_is_what_a_diagnosis_compares_with(planar, monkeypatch):
    assert run("identify", "arm.json", "swing.csv", *QUICK, "--out", "before.json").exit_code == 0
    seen = []

    def looked(computation, workspace, _):
        seen.append(json.loads(workspace.files[computation.reference].read_bytes()))
        assert computation.options == {"reference": "before.json"}
        return diagnosed()

    monkeypatch.setattr(computing, "compute", looked)
    assert run("diagnose", "arm.json", "swing.csv", "--reference", "before.json").exit_code == 0
    assert seen == [json.loads(Path("before.json").read_text())]


@pytest.mark.parametrize("command", ["identify", "check"])
def test_how_a_log_was_read_stands_in_what_is_printed(planar, command):
    (planar / "cut.csv").write_bytes(csv_log().rstrip()[:-20])
    asked = (*QUICK,) if command == "identify" else ()
    assert "the last row, cut short, left out" in " ".join(
        run(command, "arm.json", "cut.csv", *asked).stdout.split()
    )


def test_robots_are_shown_as_they_are_understood(planar):
    listed = run("robots", "list").stdout.splitlines()
    assert [line.split()[:2] for line in listed] == [["yumi-left", "7"], ["yumi-right", "7"], ["yumi", "14"]]
    written = json.loads(run("robots", "show", "arm.json", "--json").stdout)
    (planar / "again.json").write_text(json.dumps(written))
    assert json.loads(run("robots", "show", "again.json", "--json").stdout) == written
    assert "planar arm: 2 joints" in run("robots", "check", "arm.json").stdout
    # 22 standard parameters would be an arm with rotor inertias; 12 of these are distinguished in a plane
    assert "12 base parameters" in run("robots", "base-parameters", "arm.json").stdout


def test_what_is_rarely_meant_is_told_and_fails_only_where_that_is_asked_for(planar):
    odd = description() | {"gravity": [0.0, 0.0, 9.81]}
    (planar / "odd.json").write_text(json.dumps(odd | {"joints": [odd["joints"][0] | {"alpha": 90.0}]}))
    ended = run("robots", "check", "odd.json")
    assert (ended.exit_code, "warning:" in ended.stdout) == (Exit.DONE, True)
    assert run("robots", "check", "odd.json", "--fail-on-findings").exit_code == Exit.FOUND


def test_a_urdf_is_a_robot_and_becomes_a_description(desk):
    from veritorque.app.schemas.examples import PENDULUM_URDF

    (desk / "pendulum.urdf").write_text(PENDULUM_URDF)
    shown = json.loads(run("robots", "show", "pendulum.urdf", "--gravity=0,-9.81,0", "--json").stdout)
    assert (len(shown["joints"]), shown["gravity"]) == (1, [0.0, -9.81, 0.0])


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_complete_commands_without_a_network(shell):
    script = run("--show-completion", shell, SHELL=shell)
    asked = {"_VERITORQUE_COMPLETE": f"complete_{shell}", "COMP_WORDS": "veritorque ide", "COMP_CWORD": "1"}
    asked |= {"_TYPER_COMPLETE_ARGS": "veritorque ide", "_TYPER_COMPLETE_FISH_ACTION": "get-args"}
    called = "import sys; sys.argv[0] = 'veritorque'; from veritorque.app.terminal.main import main; main()"
    command = [sys.executable, "-c", called]
    ended = subprocess.run(
        command, env={**os.environ, **asked}, capture_output=True, text=True, cwd=ROOT, check=True
    )
    assert "identify" in ended.stdout
    assert script.exit_code == 0


def test_the_script_that_is_installed_is_the_command_line():
    import tomllib
    from importlib import import_module

    (name, target), *_ = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["scripts"].items()
    module, _, function = target.partition(":")
    assert (name, callable(getattr(import_module(module), function))) == ("veritorque", True)


def as_a_shell_does(*arguments, stdout, **environment):
    """Run a command in a process of its own; give how it ended and what stands on standard error."""
    ended = subprocess.run(
        [sys.executable, "-m", "veritorque", *arguments],
        cwd=ROOT,
        env=os.environ | environment,
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    return ended.returncode, ended.stderr


@pytest.mark.parametrize("command", ["list", "show yumi", "show yumi --json"])
def test_a_reader_who_has_read_enough_is_no_failure(command):
    reading, writing = os.pipe()
    os.close(reading)
    try:
        assert as_a_shell_does("robots", *command.split(), stdout=writing) == (Exit.DONE, "")
    finally:
        os.close(writing)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no disk that is always full")
def test_a_full_disk_is_told_as_what_it_is():
    with Path("/dev/full").open("wb") as full:
        code, said = as_a_shell_does("robots", "show", "yumi", stdout=full)
    assert code == Exit.INPUT
    assert "no space left" in said
    assert "free space" in said


def closed(number, *arguments):
    """Run a command one of whose streams was closed by whoever called it, as ``>&-`` does in a shell."""
    script = f"import os, sys; os.close({number}); os.execv(sys.executable, [sys.executable, *sys.argv[1:]])"
    command = [sys.executable, "-c", script, "-m", "veritorque", *arguments]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    return ended.returncode, ended.stdout, ended.stderr


@pytest.mark.parametrize(
    "command", ["version", "--version", "--help", "robots show yumi", "robots show yumi --json"]
)
def test_a_command_that_has_something_to_say_tells_that_its_output_is_closed(command):
    code, _, said = closed(1, *command.split())
    assert code == Exit.INPUT
    assert said.startswith("error: standard output is closed")
    assert "remedy: " in said


def test_a_command_that_writes_a_file_needs_no_output_and_lends_its_number_to_no_file(desk):
    assert closed(1, "export", "result.json", "robot.urdf") == (Exit.DONE, "", "saved robot.urdf\n")
    assert (desk / "robot.urdf").read_text().endswith("</robot>\n")


def test_a_command_whose_errors_nobody_reads_works_and_ends_as_ever():
    assert closed(2, "version")[0] == Exit.DONE
    assert closed(2, "robots", "show", "nobody") == (Exit.INPUT, "", "")


@pytest.mark.parametrize(
    "loaded",
    [
        "veritorque.app.terminal.interruption",
        "veritorque.app.terminal.main",
        "typer",
        "veritorque.app.terminal.guard",
        "veritorque.app.terminal.commands.robots",
        "veritorque.app.terminal.backend.local",
    ],
)
def test_an_interruption_while_the_command_is_being_loaded_ends_as_any_other(loaded):
    script = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "class Interrupting:\n"
        "    def find_spec(self, name, *_):\n"
        f"        if name == {loaded!r}: os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Interrupting())\n"
        "sys.argv = ['veritorque', 'robots', 'list']\n"
        "from veritorque.app.terminal.start import main\n"
        "main()\n"
    )
    command = [sys.executable, "-c", script]
    ended = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (Exit.INTERRUPTED, "")
    assert ended.stderr in ("", "interrupted\n")


def test_a_name_that_the_alphabet_of_the_terminal_lacks_stops_nothing(tmp_path):
    log = tmp_path / "Übung.csv"
    log.write_bytes(csv_log())
    with (tmp_path / "said").open("wb") as said:
        assert as_a_shell_does("logs", "check", str(log), stdout=said, PYTHONIOENCODING="ascii")[0] == 0
    assert (tmp_path / "said").read_bytes().startswith(rb"\xdcbung.csv: CSV")


def test_a_setting_that_cannot_be_is_named(desk):
    ended = run("doctor", VERITORQUE_PORT="abc")
    assert ended.exit_code == Exit.INPUT
    assert "port: " in ended.stderr


def test_a_service_does_not_start_where_another_one_listens(desk):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        ended = run("serve", "--port", str(taken.getsockname()[1]))
    assert ended.exit_code == Exit.INPUT
    assert "choose another --host or --port" in ended.stderr
