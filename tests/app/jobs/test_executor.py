"""Computations run in processes of their own, and nothing that happens in one of them reaches the service."""

import json
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from tests.app import work
from veritorque.app.jobs.computation import Computation, Died, Failed, Finished, Stopped, Workspace
from veritorque.app.jobs.executors.process_executor import ProcessExecutor

ROOT = Path(__file__).parents[3]
COMPUTATION = Computation(kind="identify", robot={"name": "arm"}, logs=(), options={"essential": True})


def run(kind, *, stop=None, timeout_s=60.0, progress=lambda stage, fraction: None):
    executor = ProcessExecutor(kind)
    return executor.run(
        COMPUTATION, Workspace(), progress=progress, stop=stop or threading.Event(), timeout_s=timeout_s
    )


def test_a_computation_gives_its_document_from_another_process():
    seen = []
    outcome = run(work.echo, progress=lambda stage, fraction: seen.append((stage, fraction)))
    assert isinstance(outcome, Finished)
    document = json.loads(outcome.result)
    assert document["pid"] != os.getpid()
    assert document["robot"] == COMPUTATION.robot
    assert seen == [("echo", 0.5)]


def test_a_computation_that_is_stopped_ends_at_once():
    stop = threading.Event()
    begun = time.monotonic()
    outcome = run(work.sleep, stop=stop, progress=lambda stage, fraction: stop.set())
    assert isinstance(outcome, Stopped)
    assert time.monotonic() - begun < 30.0  # the work itself sleeps for 60 s


def test_a_computation_that_takes_too_long_is_ended_with_a_reason():
    outcome = run(work.sleep, timeout_s=0.2)
    assert isinstance(outcome, Failed)
    assert outcome.problem["type"] == "urn:veritorque:problem:job-timeout"


@pytest.mark.parametrize(
    ("kind", "end", "name", "status"),
    [
        (work.refuse, Failed, "excitation", 422),
        (work.stumble, Failed, "internal", 500),
        (work.fill_the_disk, Failed, "disk-full", 507),
        (work.not_finite, Failed, "internal", 500),
        (work.vanish, Died, "computation-stopped", 500),
        (work.leave, Died, "computation-stopped", 500),
    ],
)
def test_whatever_goes_wrong_in_a_computation_is_a_problem(kind, end, name, status):
    outcome = run(kind)
    assert isinstance(outcome, end)
    assert outcome.problem["type"] == f"urn:veritorque:problem:{name}"
    assert outcome.problem["status"] == status
    assert "secret" not in json.dumps(outcome.problem)


def test_an_error_of_the_science_keeps_its_evidence():
    outcome = run(work.refuse)
    assert outcome.problem["evidence"] == {"speed": 0.01, "bad": "nan"}
    assert outcome.problem["remedy"] == "move faster"


def test_a_computation_does_not_outlive_the_service():
    """Kill a service the hard way: the process that computes for it notices and ends."""
    script = (
        "import threading; from veritorque.app.jobs.executors.process_executor import ProcessExecutor\n"
        "from tests.app import work; "
        "from tests.app.jobs.test_executor import COMPUTATION, Workspace\n"
        "def tell(stage, fraction): print(stage, flush=True)\n"
        "if __name__ == '__main__':\n"
        "    ProcessExecutor(work.name_yourself).run("
        "COMPUTATION, Workspace(), progress=tell, stop=threading.Event(), timeout_s=60.0)\n"
    )
    service = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    with service:
        computing = int(service.stdout.readline())
        service.kill()
    deadline = time.monotonic() + 10.0
    while _lives(computing) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not _lives(computing)


def _lives(process_id):
    try:
        os.kill(process_id, 0)
    except ProcessLookupError:
        return False
    return True
