"""Executors for tests, one that waits until it is released and one that computes in the thread; and a job."""

import threading

from tests.core.report.documents import identified
from veritorque.app.jobs.computation import Failed, Finished, Stopped
from veritorque.app.jobs.compute import compute
from veritorque.app.json_text import json_bytes
from veritorque.app.problems import Problem, problem_of
from veritorque.app.store.queueing import NewJob
from veritorque.core.errors import VeritorqueError

RESULT = identified()


def add_job(jobs, request, *, key=None):
    """Queue one job as requests do, or raise why not."""
    (outcome,) = jobs.begin_to_add([NewJob(request, key, None)])()
    if isinstance(outcome, Exception):
        raise outcome
    return outcome


class StubExecutor:
    def __init__(self, outcome=None):
        self.outcome = outcome or Finished(json_bytes(RESULT))
        self.release = threading.Event()
        self.started = threading.Event()
        self.stopped = threading.Event()
        self.computations, self.workspaces = [], []

    def prepare(self):
        pass

    def close(self):
        pass

    def run(self, computation, workspace, *, progress, stop, timeout_s):
        self.computations.append(computation)
        self.workspaces.append(workspace)
        progress("estimate", 0.5)
        self.started.set()
        while not self.release.wait(0.005):
            if stop.is_set():
                self.stopped.set()
                return Stopped()
        return self.outcome


def failing(kind="excitation", cause="the motion is too slow"):
    problem = Problem(kind, cause, evidence={"speed": 0.01}, remedy="move faster")
    return StubExecutor(Failed(problem.document()))


class InlineExecutor:
    """Let the science run in the tests' process, where warnings are errors and shapes are checked.

    What is not an error of its own becomes a 5xx. `told` are the last computation's stages and fractions.
    """

    def __init__(self):
        self.told = []

    def prepare(self):
        pass

    def close(self):
        pass

    def run(self, computation, workspace, *, progress, stop, timeout_s):
        self.told = []

        def tell(stage, fraction):
            self.told.append((stage, fraction))
            progress(stage, fraction)

        try:
            return Finished(json_bytes(compute(computation, workspace, tell)))
        except VeritorqueError as error:
            return Failed(problem_of(error).document())
