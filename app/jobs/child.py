"""Compute one job in a process of its own, and tell the service how it goes over a pipe.

A message is one letter and its content: ``p`` progress, ``r`` the result document, ``f`` the problem
document, ``t`` the trace of a mistake of ours (for the service's own log, never for clients). A computation
does not outlive the service.
"""

import errno
import os
import signal
import threading
import traceback
from contextlib import suppress
from multiprocessing.connection import Connection

from app.documents import json_bytes
from app.jobs.computation import Computation, Work
from app.jobs.limits import Limits
from app.problems import Problem, problem_of, problem_of_damage
from app.store.errors import Damaged
from core.errors import VeritorqueError

PROGRESS, RESULT, FAILURE, TRACE = b"p", b"r", b"f", b"t"


def compute(pipe: Connection, work: Work, computation: Computation, limits: Limits, timeout_s: float) -> None:
    """Do the work within its limits and send its outcome; the entry point of the process."""
    for told in (signal.SIGINT, signal.SIGTERM):
        signal.signal(told, signal.SIG_IGN)  # they are for the service, which then stops its computations
    threading.Thread(target=_end_with_the_service, args=(pipe,), daemon=True).start()
    limits.hold(seconds=timeout_s)
    sending = threading.Lock()

    def send(letter: bytes, content: bytes) -> None:
        with sending:
            pipe.send_bytes(letter + content)

    def progress(stage: str, fraction: float) -> None:
        send(PROGRESS, json_bytes([stage, min(max(float(fraction), 0.0), 1.0)]))

    try:
        send(RESULT, json_bytes(work(computation, progress)))
    except Exception as error:  # noqa: BLE001  (the boundary of the process: what is not ours becomes a problem without internals)
        problem = _problem(error, limits)
        if problem is None:
            send(TRACE, traceback.format_exc().encode(errors="replace"))
        send(FAILURE, json_bytes((problem or mistake()).document()))


def nothing() -> None:
    """Do nothing; the work of the process that is started to load the solver."""


def out_of_memory(limits: Limits) -> Problem:
    """Say that the memory did not suffice."""
    return Problem(
        "job-memory",
        f"the computation needs more memory than the {limits.memory_bytes} bytes that it may use",
        evidence={"limit_bytes": limits.memory_bytes},
        remedy=(
            "shorten the log, raise the decimation, or let the operator raise VERITORQUE_JOB_MEMORY_BYTES"
        ),
    )


def no_room() -> Problem:
    """Say that the disk did not suffice."""
    return Problem(
        "disk-full",
        "the disk is full, so that what was computed could not be kept",
        remedy="delete logs and jobs, or let the operator make room, and ask for the job again",
    )


def mistake() -> Problem:
    """Say that the mistake is ours."""
    return Problem(
        "internal",
        "the computation met a mistake of the service",
        remedy="report it; the service's own log holds the details",
    )


def _problem(error: Exception, limits: Limits) -> Problem | None:
    """Say what went wrong; None where the mistake is ours."""
    if isinstance(error, VeritorqueError):
        return problem_of(error)
    if isinstance(error, Damaged):
        return problem_of_damage(error)
    if isinstance(error, MemoryError):
        limits.lift_memory()
        return out_of_memory(limits)
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return no_room()
    return None


def _end_with_the_service(pipe: Connection) -> None:
    with suppress(OSError):
        pipe.poll(None)  # nothing is ever sent this way: it returns when the other end is gone
    os._exit(1)
