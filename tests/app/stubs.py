"""An executor that computes nothing: it waits until it is released, then gives its outcome."""

import threading

from app.documents import json_bytes
from app.jobs.computation import Failed, Finished, Stopped
from app.problems import Problem
from tests.core.report.documents import identified

RESULT = identified()


class StubExecutor:
    def __init__(self, outcome=None):
        self.outcome = outcome or Finished(json_bytes(RESULT))
        self.release = threading.Event()
        self.started = threading.Event()
        self.stopped = threading.Event()
        self.computations = []

    def prepare(self):
        pass

    def run(self, computation, *, progress, stop, timeout_s):
        self.computations.append(computation)
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
