"""Have uploaded files read by processes that can be killed.

The service's own process reads of a file no more than its first bytes, which tell its format. A file may make
its reader crash, loop or exhaust memory: that ends a process which held nothing else, and is answered with
a problem.
"""

import json
import logging
import os
import signal
from functools import partial
from pathlib import Path

import anyio

from ...core.errors import LogError
from ..problems import Problem, problem_of
from ..processes.fork_server import Child, ProcessPool, fork_server
from ..store.records import Document
from . import child
from .confinement import Budget, budget_for
from .log_reading import ChannelSelection, LogFile, summarise_log, trace_log

LOGGER = logging.getLogger(__name__)
LONGEST_ANSWER = 16 * 1024**2


class Inspector:
    """Read uploaded files, as many at the same time as there are processors.

    Attributes
    ----------
    limiter
        Coroutines pass this to the thread that waits, so that uploads which wait for
        their turn hold no thread.
    """

    def __init__(self) -> None:
        self._context = fork_server("veritorque.app.inspection.child", *child.NEEDED)
        self._pool = ProcessPool(lambda: Child(self._context, child.inspect))
        self._at_once = os.cpu_count() or 1
        self.limiter = anyio.CapacityLimiter(self._at_once)

    def prepare(self) -> None:
        """Have processes made that wait for files, without waiting for them."""
        self._pool.prepare(self._at_once)

    def summarise(self, log: LogFile, *, size: int, media_type: str | None) -> Document:
        """Say what is in a log of so many bytes.

        Raises
        ------
        Problem
            If the log cannot be used, or reading it costs more than it may.
        """
        work = partial(summarise_log, log, media_type=media_type)
        document: Document = json.loads(self._read(work, log.path, size))
        return document

    def trace(self, log: LogFile, selection: ChannelSelection, *, size: int) -> bytes:
        """Draw the channels of a log, as the document that is sent.

        Raises
        ------
        Problem
            If reading the log costs more than it may, or its bytes are not what they were.
        """
        return self._read(partial(trace_log, log, selection), log.path, size)

    def _read(self, work: child.Work, path: Path, size: int) -> bytes:
        """Let a process of its own do the work, and give the document that it made."""
        budget = budget_for(size)
        with self._pool.child() as process:
            process.pipe.send((work, path, budget))
            return _answer(process, budget)

    def close(self) -> None:
        """End the processes that wait."""
        self._pool.close()


def _answer(process: Child, budget: Budget) -> bytes:
    if not process.pipe.poll(budget.wall_s):
        raise problem_of(_too_slow(budget.wall_s, "time"))
    try:
        message = process.pipe.recv_bytes(LONGEST_ANSWER)
    except (EOFError, OSError):
        raise problem_of(_exit_error(process.exit_code(), budget)) from None
    letter, content = message[:1], message[1:]
    if letter == child.TRACE:
        LOGGER.error("reading a log failed with an internal error:\n%s", content.decode(errors="replace"))
        raise Problem("internal", "reading the log failed with an internal error", remedy="report it")
    if letter == child.FAILURE:
        raise Problem.from_document(json.loads(content))
    return content


def _exit_error(exit_code: int | None, budget: Budget) -> LogError:
    """Say why the process ended without a word; a negative exit code is a signal's number."""
    if exit_code == -signal.SIGPROF:
        return _too_slow(budget.processor_s, "processor time")
    if exit_code == -signal.SIGKILL:  # the kernel's, where the machine itself is out of memory
        return child.too_much_memory(budget)
    return LogError(
        "the file is so damaged that its reader crashed",
        evidence={"exit_code": exit_code},
        remedy="write the file again and upload it whole",
    )


def _too_slow(seconds: float, what: str) -> LogError:
    return LogError(
        f"reading the file takes more {what} than a file of its size may ask for",
        evidence={"at_most_s": seconds},
        remedy="write the file again with the columns of the log only, or upload several shorter logs",
    )
