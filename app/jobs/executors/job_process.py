"""Compute one job in a process of its own, and report to the service over a pipe.

A message is one letter and its content: ``p`` progress, ``r`` the result document, ``f`` the problem
document, ``t`` the traceback of an internal error (for the service's own log, never for clients). A
computation does not outlive the service.
"""

import errno
import os
import signal
import threading
import traceback
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection

from ....core.errors import VeritorqueError
from ...json_text import json_bytes
from ...kinds.kind import Progress
from ...problems import Problem, problem_of, problem_of_damage
from ...store.errors import DamagedError
from ...store.records import Document
from ..computation import Rehearse, Work
from .limits import Limits

PROGRESS, RESULT, FAILURE, TRACE = b"p", b"r", b"f", b"t"
IDLE_S = 0.02
"""Time without a computation after which the work is rehearsed."""


def compute(pipe: Connection, work: Work, limits: Limits, rehearse: Rehearse) -> None:
    """Wait for a computation and run it; the entry point of the process.

    The work is rehearsed while no computation comes.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # the service handles them, and stops its computations
    limits.hold()
    if not pipe.poll(IDLE_S):
        _rehearse(pipe, rehearse)
    try:
        computation, workspace, timeout_s = pipe.recv()
    except EOFError:  # the service is gone
        return
    threading.Thread(target=_end_with_service, args=(pipe,), daemon=True).start()
    limits.hold_to_time(timeout_s)
    _report(pipe, partial(work, computation, workspace), limits)


def nothing(_progress: Progress) -> None:
    """Rehearse nothing."""


def _report(pipe: Connection, work: Callable[[Progress], Document], limits: Limits) -> None:
    sending = threading.Lock()

    def send(letter: bytes, content: bytes) -> None:
        with sending:
            pipe.send_bytes(letter + content)

    def progress(stage: str, fraction: float) -> None:
        send(PROGRESS, json_bytes([stage, min(max(float(fraction), 0.0), 1.0)]))

    try:
        send(RESULT, json_bytes(work(progress)))
    except Exception as error:  # noqa: BLE001  (the boundary of the process: what is not ours becomes a problem without internals)
        problem = _problem(error, limits)
        if problem is None:
            send(TRACE, traceback.format_exc().encode(errors="replace"))
        send(FAILURE, json_bytes((problem or internal_error()).document()))


def out_of_memory(limits: Limits) -> Problem:
    """Report that the memory did not suffice."""
    return Problem(
        "job-memory",
        f"the computation needs more memory than the {limits.memory_bytes} bytes that it may use",
        evidence={"limit_bytes": limits.memory_bytes},
        remedy=(
            "shorten the log, raise the decimation, or let the operator raise VERITORQUE_JOB_MEMORY_BYTES"
        ),
    )


def no_room() -> Problem:
    """Report that the disk did not suffice."""
    return Problem(
        "disk-full",
        "the disk is full, so that what was computed could not be kept",
        remedy="delete logs and jobs, or let the operator make room, and ask for the job again",
    )


def internal_error() -> Problem:
    """Report an error of the service itself."""
    return Problem(
        "internal",
        "the computation failed with an internal error",
        remedy="report it; the service's own log holds the details",
    )


class _ComputationWaitsError(Exception):
    """End a rehearsal, because there is a computation."""


def _rehearse(pipe: Connection, rehearse: Rehearse) -> None:
    def stop_if_needed(_stage: str, _fraction: float) -> None:
        if pipe.poll():
            raise _ComputationWaitsError

    with suppress(Exception):  # a real computation will report what made the rehearsal fail
        rehearse(stop_if_needed)


def _problem(error: Exception, limits: Limits) -> Problem | None:
    """Give the problem that an error means; None where it is an internal error."""
    if isinstance(error, VeritorqueError):
        return problem_of(error)
    if isinstance(error, DamagedError):
        return problem_of_damage(error)
    if isinstance(error, MemoryError):
        limits.lift_memory()
        return out_of_memory(limits)
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return no_room()
    return None


def _end_with_service(pipe: Connection) -> None:
    with suppress(OSError):
        pipe.poll(None)  # nothing more is sent this way: it returns when the other end is gone
    os._exit(1)
