"""Processes wait for their tasks ahead of time, and whatever happens to them costs no task."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from tests.app import work
from tests.app.jobs.test_executor import COMPUTATION
from veritorque.app.jobs.computation import Finished, Workspace
from veritorque.app.jobs.executors.process_executor import ProcessExecutor
from veritorque.app.processes.fork_server import Child, ProcessPool, fork_server

CONTEXT = fork_server()
ROOT = Path(__file__).parents[3]


@pytest.fixture
def pool():
    kept = ProcessPool(lambda: Child(CONTEXT, work.answer))
    yield kept
    kept.close()


def asked(pool):
    with pool.child() as child:
        child.pipe.send("who are you")
        return child.pipe.recv()


def alive(process):
    """Tell whether a process runs; what was killed is cleared away by its server in its own time."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_every_task_has_a_process_of_its_own(pool):
    pool.prepare(1)
    assert len({asked(pool) for _ in range(3)}) == 3


def test_a_process_is_there_before_its_task(pool):
    coming = pool.prepare(1)[0].result()
    assert coming.alive
    assert asked(pool) == coming._process.pid


def test_a_waiting_process_that_died_costs_no_task(pool):
    coming = pool.prepare(1)[0].result()
    os.kill(coming._process.pid, signal.SIGKILL)
    coming.exit_code()
    assert asked(pool) > 0
    assert asked(pool) > 0


def test_as_many_tasks_at_once_as_were_prepared_for_find_processes_and_more_get_them(pool):
    pool.prepare(2)
    with pool.child() as one, pool.child() as other, pool.child() as third:
        pids = set()
        for child in (one, other, third):
            child.pipe.send("")
            pids.add(child.pipe.recv())
    assert len(pids) == 3


def test_what_waits_ends_with_those_who_made_it():
    kept = ProcessPool(lambda: Child(CONTEXT, work.answer))
    process = kept.prepare(1)[0].result()._process.pid
    kept.close()
    deadline = time.monotonic() + 10.0
    while alive(process) and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not alive(process)


class Counted:
    """Stand in for a child: count those that were made, and those that ended."""

    made = ended = 0

    def __init__(self):
        Counted.made += 1

    def end(self):
        Counted.ended += 1


def test_nobody_is_left_waiting_where_they_part_while_others_prepare():
    often = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(300):
            kept = ProcessPool(Counted)
            preparing = threading.Thread(target=kept.prepare, args=(3,))
            preparing.start()
            kept.close()
            preparing.join()
            assert Counted.made == Counted.ended
    finally:
        sys.setswitchinterval(often)
    assert Counted.made > 0
    assert kept.prepare(1) == []


def test_a_rehearsal_makes_way_for_a_computation():
    executor = ProcessExecutor(work.echo, preload=(), rehearse=work.rehearse_for_ever)
    executor.prepare()
    time.sleep(0.3)
    outcome = executor.run(COMPUTATION, Workspace(), progress=print, stop=threading.Event(), timeout_s=60.0)
    executor.close()
    assert isinstance(outcome, Finished)
    assert json.loads(outcome.result)["robot"] == COMPUTATION.robot


def test_a_rehearsal_that_fails_does_no_harm():
    executor = ProcessExecutor(work.echo, preload=(), rehearse=work.refuse_to_rehearse)
    executor.prepare()
    time.sleep(0.3)
    outcome = executor.run(COMPUTATION, Workspace(), progress=print, stop=threading.Event(), timeout_s=60.0)
    executor.close()
    assert isinstance(outcome, Finished)


SLOW_TO_LOAD = """
import pathlib, time
pathlib.Path(__file__).with_name("begun").touch()
time.sleep(300.0)
"""

STOPPED_EARLY = """
import threading
from veritorque.app.jobs.executors.process_executor import ProcessExecutor
from tests.app import work
from tests.app.jobs.test_executor import COMPUTATION, Workspace

def asked():
    print(executor.run(COMPUTATION, Workspace(), progress=print, stop=stop, timeout_s=60.0))

stop = threading.Event()
executor = ProcessExecutor(work.echo, preload=("slow_to_load",))
threading.excepthook = lambda _: None
preparing = threading.Thread(target=executor.prepare)
preparing.start()
asking = threading.Thread(target=asked)
asking.start()
stop.wait(1.0)
stop.set()
asking.join()
executor.close()
preparing.join()
"""


def test_nobody_waits_for_a_solver_that_is_still_loading_when_all_is_to_end(tmp_path):
    (tmp_path / "slow_to_load.py").write_text(SLOW_TO_LOAD)
    begun = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-c", STOPPED_EARLY],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert done.stdout == "Stopped()\n"
    assert time.monotonic() - begun < 60.0
    assert (tmp_path / "begun").exists()
