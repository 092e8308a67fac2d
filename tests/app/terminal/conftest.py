import logging
import os
import shutil
import signal
from pathlib import Path

import pytest
from typer.testing import CliRunner

from veritorque.app.terminal.main import COMMANDS

ROOT = Path(__file__).parents[3]


def run(*arguments, **environment):
    """Run a command as a shell would; standard output and standard error are apart.

    A command opens the journal, and takes a request to end for an interruption, for its process, which here
    goes on: later lines would go to a standard error that is closed by then, and whoever ends the tests would
    only make one of them fail.
    """
    journal = logging.getLogger()
    handlers, level = journal.handlers, journal.level
    told_to_end = signal.getsignal(signal.SIGTERM)
    try:
        return CliRunner().invoke(COMMANDS, arguments, env={"COLUMNS": "120"} | environment)
    finally:
        journal.handlers = handlers
        journal.setLevel(level)
        signal.signal(signal.SIGTERM, told_to_end)


@pytest.fixture(autouse=True)
def the_environment_is_left_as_it_was():
    before = dict(os.environ)
    yield
    os.environ.clear()
    os.environ.update(before)


@pytest.fixture(scope="session")
def identified(tmp_path_factory):
    """The result document of the YuMi log, computed once by the command itself; gives its file."""
    path = tmp_path_factory.mktemp("results") / "result.json"
    log = ROOT / "examples" / "yumi" / "log.csv"
    ended = run("identify", "yumi-left", str(log), "--set", "bootstrap.draws=0", "--out", str(path))
    assert ended.exit_code == 0, ended.output
    return path


@pytest.fixture
def desk(tmp_path, monkeypatch, identified):
    """An empty folder to work in, with the examples and a result; nothing of the environment is set."""
    for name in [name for name in os.environ if name.startswith("VERITORQUE_")]:
        monkeypatch.delenv(name)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    shutil.copy(identified, tmp_path / "result.json")
    monkeypatch.chdir(tmp_path)
    return tmp_path
