"""There is a worker as long as the service runs: one that dies or freezes is replaced, none left behind."""

import contextlib
import subprocess
import sys
import time

import pytest

from veritorque.app.jobs import supervisor as module
from veritorque.app.jobs.supervisor import Supervisor
from veritorque.app.settings import Settings

SPEAKS = "import sys, time\nwhile True: print('ready', flush=True); time.sleep(0.05)"
ENDS_WITH_ITS_INPUT = f"""
import os, threading, sys
threading.Thread(target=lambda: os._exit(len(sys.stdin.read())), daemon=True).start()
{SPEAKS}
"""
DIES = "print('ready', flush=True)"
FALLS_SILENT = "import time\nprint('ready', flush=True)\ntime.sleep(60)"
DEAF = f"import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\n{SPEAKS}"


@contextlib.contextmanager
def supervised(script, told=None):
    """Supervise processes that run a script; `started` lists them."""
    started = []

    def start(settings):
        process = subprocess.Popen(
            [sys.executable, "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        started.append(process)
        return process

    watching = Supervisor(Settings.model_construct(), start, on_ended=told)
    watching.start()
    try:
        yield watching, started
    finally:
        watching.close()


def until(reached, seconds=20.0):
    deadline = time.monotonic() + seconds
    while not reached() and time.monotonic() < deadline:
        time.sleep(0.02)
    assert reached()


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    monkeypatch.setattr(module, "POLL_S", 0.02)
    monkeypatch.setattr(module, "PAUSES_S", (0.0, 0.02))
    monkeypatch.setattr(module, "END_S", 1.0)


def test_a_worker_that_is_ready_says_so():
    with supervised(SPEAKS) as (watching, _):
        assert watching.ready.wait(20.0)
        assert watching.alive


def test_a_worker_that_dies_is_replaced():
    with supervised(DIES) as (_, started):
        until(lambda: len(started) >= 3)


def test_a_worker_that_is_killed_is_replaced():
    with supervised(SPEAKS) as (watching, started):
        watching.ready.wait(20.0)
        started[0].kill()
        until(lambda: len(started) == 2)


def test_a_worker_that_takes_long_to_start_is_waited_for(monkeypatch):
    monkeypatch.setattr(module, "SILENCE_S", 0.2)
    with supervised(f"import time\ntime.sleep(1.0)\n{SPEAKS}") as (watching, started):
        until(watching.ready.is_set)
        assert len(started) == 1


def test_a_worker_that_never_starts_is_replaced(monkeypatch):
    monkeypatch.setattr(module, "START_S", 0.5)
    with supervised("import time\ntime.sleep(60)") as (_, started):
        until(lambda: len(started) > 1)


def test_a_worker_that_falls_silent_is_killed_and_replaced(monkeypatch):
    monkeypatch.setattr(module, "SILENCE_S", 1.0)
    with supervised(FALLS_SILENT) as (_, started):
        until(lambda: len(started) >= 2)
        assert started[0].returncode < 0


@pytest.mark.parametrize("script", [SPEAKS, DEAF], ids=["obedient", "deaf"])
def test_no_worker_outlives_the_service(script):
    with supervised(script) as (watching, started):
        watching.ready.wait(20.0)
    assert [process.poll() is None for process in started] == [False]


def test_a_service_that_is_killed_takes_its_worker_along():
    """Its end of the pipe closes, which the worker reads as the end of its input."""
    with supervised(ENDS_WITH_ITS_INPUT) as (watching, started):
        watching.ready.wait(20.0)
        started[0].stdin.close()
        assert started[0].wait(20.0) == 0


WAKES = """
import os, sys
os.write(1, b"ready\\n")
while os.read(0, 1):
    os.write(1, b"ended {\\"kind\\": \\"identify\\", \\"outcome\\": \\"successful\\", \\"seconds\\": 1.0}\\n")
"""


def test_a_worker_is_told_of_new_jobs_and_one_that_does_not_listen_holds_nobody_up():
    heard = []
    with supervised(WAKES, heard.append) as (watching, _):
        watching.ready.wait(20.0)
        watching.wake()
        until(lambda: heard)
    with supervised(SPEAKS) as (watching, _):
        watching.ready.wait(20.0)
        for _ in range(100_000):  # more than a pipe holds
            watching.wake()
    watching.wake()
