import os
import signal
import subprocess
import sys

import pytest

from tests.app.planar_arm import csv_log
from veritorque.app.inspection import inspector as module
from veritorque.app.inspection.confinement import MEGABYTE, Budget, budget_for
from veritorque.app.inspection.inspector import Inspector
from veritorque.app.inspection.log_reading import LogFile
from veritorque.app.problems import Problem

PLENTY = budget_for(0)


@pytest.fixture(scope="module")
def inspector():
    return Inspector()


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "upload"
    path.write_bytes(csv_log(seconds=4.0))
    return LogFile(path, "arm", None, "f" * 64)


@pytest.fixture(scope="module")
def long_log(tmp_path_factory):
    """Take many ticks of the kernel's timers to read, and some memory."""
    path = tmp_path_factory.mktemp("long log") / "upload"
    path.write_bytes(csv_log(seconds=400.0))
    return LogFile(path, "arm", None, "f" * 64)


def refusal(inspector, log, monkeypatch, budget):
    monkeypatch.setattr(module, "budget_for", lambda size: budget)
    with pytest.raises(Problem) as caught:
        inspector.summarise(log, size=0, media_type=None)
    assert caught.value.status_code == 422
    assert caught.value.remedy
    return caught.value


def test_a_sound_log_is_summarised(inspector, log):
    summary = inspector.summarise(log, size=log.path.stat().st_size, media_type="text/csv")
    assert (summary["samples"], summary["joints"], summary["name"]) == (800, 2, "arm")


def test_a_log_that_cannot_be_used_is_refused_in_the_words_of_core(inspector, log):
    with pytest.raises(Problem, match="its bytes are CSV"):
        inspector.summarise(log, size=0, media_type="application/x-npz")


def test_reading_ends_when_its_processor_time_is_used_up(inspector, long_log, monkeypatch):
    problem = refusal(inspector, long_log, monkeypatch, Budget(0.001, 30.0, PLENTY.memory_bytes))
    assert "processor time" in problem.detail


def test_reading_ends_when_its_time_by_the_clock_is_over(inspector, log, monkeypatch):
    problem = refusal(inspector, log, monkeypatch, Budget(5.0, 0.0, PLENTY.memory_bytes))
    assert problem.evidence == {"at_most_s": 0.0}


def test_reading_ends_when_its_memory_is_used_up(inspector, long_log, monkeypatch):
    problem = refusal(inspector, long_log, monkeypatch, Budget(5.0, 30.0, MEGABYTE))
    assert "memory" in problem.detail or "crashed" in problem.detail or "cannot be read" in problem.detail


@pytest.mark.parametrize("number", [signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGKILL])
def test_a_reader_that_dies_is_answered_and_the_next_log_is_read(inspector, log, monkeypatch, number):
    with monkeypatch.context() as patch:
        patch.setattr(module.child, "inspect", Dying(number))
        with pytest.raises(Problem) as caught:
            inspector.summarise(log, size=0, media_type=None)
    assert caught.value.status_code == 422
    assert inspector.summarise(log, size=0, media_type=None)["samples"] == 800


class Dying:
    """Stand for a reader which a library takes down."""

    def __init__(self, number):
        self.number = number

    def __call__(self, *_):
        os.kill(os.getpid(), self.number)


def test_what_a_file_may_cost_grows_with_its_size_and_stays_below_the_promise_for_small_ones():
    assert budget_for(100 * MEGABYTE).memory_bytes > budget_for(MEGABYTE).memory_bytes
    assert budget_for(MEGABYTE).processor_s < 2.0
    assert budget_for(MEGABYTE).memory_bytes < 400 * MEGABYTE


LATE = """
import sys
from importlib import import_module
from pathlib import Path
from veritorque.app.inspection.child import NEEDED
for name in NEEDED:
    import_module(name)
loaded = set(sys.modules)
from veritorque.app.inspection.log_reading import LogFile, summarise_log
summarise_log(LogFile(Path(sys.argv[1]), "arm", None, "f" * 64), media_type=None)
print(*(name for name in sys.modules if name not in loaded and not name.startswith("encodings.")))
"""


def test_whoever_waits_for_a_file_has_loaded_all_that_reading_it_takes(log):
    """Loading it when the file is there took twenty times longer than reading a small one."""
    command = [sys.executable, "-c", LATE, str(log.path)]
    assert subprocess.run(command, check=True, capture_output=True, text=True).stdout.split() == []
