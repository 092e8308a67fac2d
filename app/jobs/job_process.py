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

from ...core.errors import VeritorqueError
from ..json_text import json_bytes
from ..problems import Problem, problem_of, problem_of_damage
from ..store.errors import Damaged
from .computation import Computation, Progress, Rehearse, Work
from .limits import Limits

PROGRESS, RESULT, FAILURE, TRACE = b"p", b"r", b"f", b"t"
IDLE_S = 0.02
"""Where no computation comes for so long, there is time to rehearse."""


def compute(pipe: Connection, work: Work, limits: Limits, rehearse: Rehearse) -> None:
    """Wait for a computation and carry it out; the entry point of the process.

    Where there is time, the work is rehearsed meanwhile.
    """
    for told in (signal.SIGINT, signal.SIGTERM):
        signal.signal(told, signal.SIG_IGN)  # they are for the service, which then stops its computations
    limits.hold()
    if not pipe.poll(IDLE_S):
        _rehearse(pipe, rehearse)
    try:
        computation, timeout_s = pipe.recv()
    except EOFError:  # the service is gone
        return
    threading.Thread(target=_end_with_the_service, args=(pipe,), daemon=True).start()
    limits.hold_to_time(timeout_s)
    _carry_out(pipe, work, computation, limits)


def nothing(_progress: Progress) -> None:
    """Rehearse nothing."""


def _carry_out(pipe: Connection, work: Work, computation: Computation, limits: Limits) -> None:
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


class _WantedError(Exception):
    """End a rehearsal: there is a computation."""


def _rehearse(pipe: Connection, rehearse: Rehearse) -> None:
    def look(_stage: str, _fraction: float) -> None:
        if pipe.poll():
            raise _WantedError

    with suppress(Exception):  # whatever stands in the way of a rehearsal, the computation itself will tell
        rehearse(look)


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
        pipe.poll(None)  # nothing more is sent this way: it returns when the other end is gone
    os._exit(1)
