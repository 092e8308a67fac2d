"""Computations run in processes of their own, and nothing that happens in one of them reaches the service."""

import json
import os
import threading
import time

import pytest

from app.jobs.computation import Computation, Failed, Finished, Stopped
from app.jobs.executor import ProcessExecutor
from tests.app import work

COMPUTATION = Computation(kind="identify", robot={"name": "arm"}, logs=(), options={"essential": True})


def run(kind, *, stop=None, timeout_s=60.0, progress=lambda stage, fraction: None):
    executor = ProcessExecutor(kind)
    return executor.run(COMPUTATION, progress=progress, stop=stop or threading.Event(), timeout_s=timeout_s)


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
    ("kind", "name", "status"),
    [
        (work.refuse, "excitation", 422),
        (work.stumble, "internal", 500),
        (work.not_finite, "internal", 500),
        (work.exhaust, "computation-stopped", 500),
        (work.vanish, "computation-stopped", 500),
        (work.leave, "computation-stopped", 500),
    ],
)
def test_whatever_goes_wrong_in_a_computation_is_a_problem(kind, name, status):
    outcome = run(kind)
    assert isinstance(outcome, Failed)
    assert outcome.problem["type"] == f"urn:veritorque:problem:{name}"
    assert outcome.problem["status"] == status
    assert "secret" not in json.dumps(outcome.problem)


def test_an_error_of_the_science_keeps_its_evidence():
    outcome = run(work.refuse)
    assert outcome.problem["evidence"] == {"speed": 0.01, "bad": "nan"}
    assert outcome.problem["remedy"] == "move faster"
