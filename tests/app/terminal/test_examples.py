"""Every command shows an example in its help, and every example runs."""

import json
import logging
import re
import shlex
import signal
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from typer.main import get_command

from tests.app.http.test_server import listening_service
from tests.app.stubs import StubExecutor
from tests.app.terminal.conftest import ROOT, run
from tests.core.joint_model.plant import Plant, Run, recorded, robot_of
from tests.core.report.documents import diagnosed
from veritorque.app.jobs import worker_process as process
from veritorque.app.jobs.computation import Finished
from veritorque.app.json_text import json_bytes
from veritorque.app.terminal.backend.local import LocalBackend
from veritorque.app.terminal.commands import serve
from veritorque.app.terminal.main import COMMANDS
from veritorque.app.terminal.output.exit_codes import Exit
from veritorque.core.robot.writing import to_description


def walk(command, path=()):
    """Give every command with the words that call it."""
    yield path, command
    names = command.list_commands(None) if hasattr(command, "list_commands") else command.commands
    for name in names:
        inner = command.get_command(None, name)
        if hasattr(inner, "commands"):
            yield from walk(inner, (*path, name))
        else:
            yield (*path, name), inner


EVERY = {" ".join(path): command for path, command in walk(get_command(COMMANDS))}


def examples(command):
    return re.findall(r"^ *((?:[A-Z_]+=\S+ )*veritorque .*)$", command.epilog or "", re.MULTILINE)


def test_the_commands_that_were_promised_are_there():
    promised = {"identify", "diagnose", "serve", "robots list", "robots show", "robots check", "logs check"}
    assert promised | {"robots base-parameters", "report", "export", "keys create", "doctor"} <= set(EVERY)


@pytest.mark.parametrize("name", EVERY)
def test_every_command_has_help_with_an_example_of_itself(name):
    shown = run(*name.split(), "--help")
    assert shown.exit_code == 0
    for example in examples(EVERY[name]):
        assert example in shown.stdout
        assert f"veritorque {name}".strip() in example or not name
    assert examples(EVERY[name])


class _Recording(StubExecutor):
    """Leave what a computation leaves instant by instant, where a log is diagnosed; it is not looked into."""

    def run(self, computation, workspace, **more):
        ended = super().run(computation, workspace, **more)
        if computation.kind != "diagnose":
            return ended
        workspace.traces.write_bytes(b"PAR1")
        return Finished(json_bytes(diagnosed()))


@pytest.fixture(scope="module")
def names(tmp_path_factory):
    """What examples call by name and this machine calls otherwise: a service, and a job on it."""
    executor = _Recording()
    executor.release.set()
    with listening_service(tmp_path_factory.mktemp("served"), executor) as (_, port):
        url = f"http://127.0.0.1:{port}"
        jobs = []
        for study in ("identify", "diagnose"):
            asked = run(study, "yumi-left", str(ROOT / "examples/yumi/log.csv"), "--url", url)
            assert asked.exit_code == Exit.DONE, asked.output
            jobs += re.findall(r"^job (\S+)$", asked.stderr, re.MULTILINE)
        yield {
            "http://127.0.0.1:8000": url,
            "5f0c1d9e residuals": f"{jobs[1]} residuals",
            "5f0c1d9e": jobs[0],
        }


@cache
def sweep() -> str:
    """Record a joint that moves alone under a controller whose references are logged."""
    signals = recorded(Plant.with_mode(12.0), Run(highest_hz=18.0, seconds=6.0, noise=np.radians(1e-3)))
    columns = [signals[name] for name in ("time", "position", "torque", "reference", "torque")]
    rows = (",".join(f"{cell:.9g}" for cell in row) for row in np.column_stack(columns))
    return "\n".join(["time,q_1,tau_1,position_ref_1,torque_ref_1", *rows])


@pytest.fixture
def prepared(monkeypatch, desk):
    """A folder in which a robot was exported and a service run: with a key and a backup; gives its name."""
    monkeypatch.setattr(serve, "_listen", lambda _: None)
    monkeypatch.setattr(process, "work_until_stopped", lambda *_, **__: None)
    assert run("keys", "create", "lab").exit_code == 0
    assert run("backup", "backup-of-sunday").exit_code == 0
    assert run("export", "result.json", "robot.urdf").exit_code == 0
    for name, prefix in (("positions.csv", "q"), ("torques.csv", "tau")):
        rows = [f"{0.01 * row},{np.sin(0.03 * row)}" for row in range(500)]
        Path(name).write_text("\n".join([f"time,{prefix}_1", *rows]))
    Path("sweep.csv").write_text(sweep())
    Path("robot.json").write_text(json.dumps(to_description(robot_of())))
    return {"3f2a91": run("keys", "list").stdout.split()[0]}


QUICK = sorted({line for name, one in EVERY.items() for line in examples(one) if name != "diagnose"})


@pytest.mark.parametrize("line", QUICK)
def test_every_example_runs(line, names, prepared):
    ended = called(line, names | prepared)
    assert ended.exit_code == 0, ended.output


@pytest.mark.usefixtures("prepared")
def test_a_study_leaves_it_to_the_tests_what_a_request_to_end_them_means():
    before = signal.getsignal(signal.SIGTERM)
    run("identify", "nobody", "nothing.csv")
    assert signal.getsignal(signal.SIGTERM) is before


@pytest.mark.usefixtures("prepared")
def test_a_command_that_opened_the_journal_leaves_none_to_a_standard_error_that_is_closed(capsys):
    assert run("work").exit_code == 0
    logging.getLogger("veritorque.app.jobs.worker").warning("computed")
    assert "Logging error" not in capsys.readouterr().err


@pytest.mark.usefixtures("prepared")
def test_the_examples_of_a_diagnosis_find_what_is_hidden_in_its_log(monkeypatch):
    """The science of it is tested elsewhere and takes its time; here it is what the command does with it."""
    asked = []
    monkeypatch.setattr(LocalBackend, "run", lambda _, *given: asked.append(given) or json_bytes(diagnosed()))
    ends = [called(line, {}).exit_code for line in examples(EVERY["diagnose"])]
    assert ends == [Exit.FOUND, Exit.DONE]
    (study, _, report), (other, _, none) = asked
    assert (study.kind, study.robot, study.logs[0].is_file()) == ("diagnose", "yumi-left", True)
    assert (report, none) == (Path("diagnosis.html"), None)
    assert (Path(other.robot).is_file(), other.part.tip_link) == (True, "joint_7")


def called(line, names):
    """Run an example; what a shell would do with it is done here."""
    for written, meant in names.items():
        line = line.replace(written, meant)
    words = shlex.split(line.partition(" > ")[0])
    start = words.index("veritorque")
    environment = dict(word.split("=", 1) for word in words[:start])
    return run(*words[start + 1 :], **environment)
