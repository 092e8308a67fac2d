"""Run every computation in a process of its own.

Processes are forked ahead of time from a server process that has loaded the solver, and wait for their
computations. A crash, a dismissal or a timeout ends one such process and nothing else.
"""

import json
import logging
import signal
import time
from multiprocessing.connection import wait
from threading import Event

from ...kinds.kind import Progress
from ...kinds.registry import KINDS
from ...problems import Problem
from ...processes.fork_server import READERS, Child, NotNeeded, ProcessPool, fork_server
from .. import compute
from ..computation import Computation, Died, Failed, Finished, Outcome, Rehearse, Stopped, Work, Workspace
from . import job_process
from .limits import Limits

LOGGER = logging.getLogger(__name__)
POLL_S = 0.05
PRELOAD = tuple(dict.fromkeys(module for kind in KINDS.values() for module in kind.preload))


class ProcessExecutor:
    """Give every computation a process of its own.

    Parameters
    ----------
    work
        What is computed; a function that the process can import.
    limits
        What a computation may use.
    preload
        Modules that the server process loads before it forks.
    rehearse
        Rehearses the work in a process that waits, so that its libraries and memory are ready.
    at_once
        Processes that wait for computations.
    """

    def __init__(
        self,
        work: Work = compute.compute,
        *,
        limits: Limits = Limits(),  # noqa: B008 - it never changes
        preload: tuple[str, ...] = (*PRELOAD, *READERS),
        rehearse: Rehearse = job_process.nothing,
        at_once: int = 1,
    ) -> None:
        self._context = fork_server(
            "veritorque.app.processes.ignore_sigterm", "veritorque.app.jobs.executors.job_process", *preload
        )
        self._at_once = at_once
        self._pool = ProcessPool(lambda: Child(self._context, job_process.compute, work, limits, rehearse))

    def prepare(self) -> None:
        """Let the server process load the solver, and compile the kernels where the disk holds none yet."""
        for coming in self._pool.prepare(self._at_once):
            coming.result()

    def run(
        self, task: Computation, workspace: Workspace, *, progress: Progress, stop: Event, timeout_s: float
    ) -> Outcome:
        """Run a computation in a process of its own; see `Executor`."""
        try:
            with self._pool.child(stop) as process:
                process.pipe.send((task, workspace, timeout_s))
                return _follow(process, progress=progress, stop=stop, timeout_s=timeout_s)
        except NotNeeded:
            return Stopped()
        except (EOFError, OSError) as error:  # the server that forks is gone; it is started again by itself
            LOGGER.warning("no process for a computation could be started: %r", error)
            return Died(_ended_without_result(None).document())

    def close(self) -> None:
        """End the processes that wait."""
        self._pool.close()


def _follow(process: Child, *, progress: Progress, stop: Event, timeout_s: float) -> Outcome:
    deadline = time.monotonic() + timeout_s
    while not stop.is_set():
        if time.monotonic() > deadline:
            return Failed(_too_slow(timeout_s).document())
        if not wait([process.pipe], timeout=POLL_S):
            continue
        try:
            message = process.pipe.recv_bytes()
        except (EOFError, OSError):
            exit_code = process.exit_code()
            if exit_code == -signal.SIGXCPU:
                return Failed(_too_slow(timeout_s).document())
            return Died(_ended_without_result(exit_code).document())
        outcome = _read(message, progress)
        if outcome is not None:
            return outcome
    return Stopped()


def _read(message: bytes, progress: Progress) -> Outcome | None:
    letter, content = message[:1], message[1:]
    if letter == job_process.RESULT:
        return Finished(content)
    if letter == job_process.FAILURE:
        return Failed(json.loads(content))
    if letter == job_process.TRACE:
        LOGGER.error("a computation failed with an internal error:\n%s", content.decode(errors="replace"))
    else:
        stage, fraction = json.loads(content)
        progress(stage, fraction)
    return None


def _too_slow(timeout_s: float) -> Problem:
    return Problem(
        "job-timeout",
        f"the computation took longer than {timeout_s:g} s",
        evidence={"timeout_s": timeout_s},
        remedy="shorten the log, raise the decimation, or let the operator raise VERITORQUE_JOB_TIMEOUT_S",
    )


def _ended_without_result(exit_code: int | None) -> Problem:
    """Report a process that ended without a result; a negative exit code is a signal's number."""
    return Problem(
        "computation-stopped",
        "the computation's process ended without a result",
        evidence={"exit_code": exit_code},
        remedy="a signal 9 points to too little memory: shorten the log or raise the decimation",
    )
