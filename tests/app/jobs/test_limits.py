"""A computation that asks for more than its share fails with a reason, and harms nobody else."""

import os
import threading
from types import SimpleNamespace

import pytest

from tests.app import work
from tests.app.jobs.test_executor import COMPUTATION
from veritorque.app.jobs.computation import Failed, Stopped, Workspace
from veritorque.app.jobs.executors import limits
from veritorque.app.jobs.executors.limits import Limits
from veritorque.app.jobs.executors.process_executor import ProcessExecutor

SMALL = Limits(memory_bytes=512 * 1024**2)


def test_a_computation_that_takes_too_much_memory_fails_with_the_limit_as_evidence():
    executor = ProcessExecutor(work.hoard, limits=SMALL)
    outcome = executor.run(COMPUTATION, Workspace(), progress=print, stop=threading.Event(), timeout_s=60.0)
    assert isinstance(outcome, Failed)
    assert outcome.problem["type"] == "urn:veritorque:problem:job-memory"
    assert outcome.problem["status"] == 422
    assert outcome.problem["evidence"] == {"limit_bytes": SMALL.memory_bytes}


def test_a_computation_whose_worker_is_frozen_ends_when_its_cpu_time_is_up(monkeypatch):
    """The worker looks at its clock; this one does not, and the system ends the process all the same."""
    monkeypatch.setattr(f"{ProcessExecutor.__module__}.time", SimpleNamespace(monotonic=lambda: 0.0))
    executor = ProcessExecutor(work.spin, limits=SMALL)
    outcome = executor.run(COMPUTATION, Workspace(), progress=print, stop=threading.Event(), timeout_s=0.5)
    assert isinstance(outcome, Failed)
    assert outcome.problem["type"] == "urn:veritorque:problem:job-timeout"


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system does not pin processes")
@pytest.mark.parametrize("cpus", [1, 2])
def test_a_computation_keeps_to_as_many_cpus_as_it_may_use(cpus):
    stop, told = threading.Event(), []

    def hear(stage, fraction):
        told.append(stage.split())
        stop.set()

    executor = ProcessExecutor(work.name_your_cpus, limits=Limits(cpus=cpus))
    assert isinstance(
        executor.run(COMPUTATION, Workspace(), progress=hear, stop=stop, timeout_s=60.0), Stopped
    )
    assert len(told[0]) == min(cpus, len(os.sched_getaffinity(0)))


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system does not pin processes")
def test_computations_share_a_cpu_only_where_there_are_more_of_them_than_cpus(monkeypatch):
    chosen = []
    first = 10_000 * os.getpid()  # on CPUs that nobody else on this machine can have taken
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {first, first + 1})
    monkeypatch.setattr(os, "sched_setaffinity", lambda process, cpus: chosen.append(cpus))
    processes = [[], [], []]  # what each of them has taken
    for taken in processes:
        monkeypatch.setattr(limits, "_reserved", taken)
        limits._pin(1)
    assert chosen[:2] == [[first], [first + 1]]
    assert len(chosen[2]) == 1
    for address in (*processes[0], *processes[1]):
        address.close()
