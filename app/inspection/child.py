"""Read one uploaded file in a process of its own, and tell the service over a pipe what is in it.

A message is one letter and its content: ``r`` the document that was made of it, ``f`` the problem document,
``t`` the traceback of an internal error.
"""

import signal
import traceback
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from multiprocessing.connection import Connection

import pyarrow as pa

from ...core.errors import LogError, VeritorqueError
from ..json_text import json_bytes
from ..problems import problem_of, problem_of_damage
from ..processes.fork_server import READERS
from ..store.errors import DamagedError
from ..store.records import Document
from .confinement import Budget, confine

Work = Callable[[], Document]
RESULT, FAILURE, TRACE = b"r", b"f", b"t"
NEEDED = ("veritorque.app.inspection.log_reading", *READERS)
"""What the work and the libraries that read take long to load."""


def inspect(pipe: Connection) -> None:
    """Wait for work on a file, do it and send what was made of it; the entry point of the process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the service
    pa.set_memory_pool(pa.system_memory_pool())  # the others reserve far more than they use
    for name in NEEDED:  # there already, unless the server ran before it could be told
        with suppress(ImportError):
            import_module(name)
    try:
        work, path, budget = pipe.recv()
    except EOFError:  # the service is gone
        return
    confine(path, budget)
    pipe.send_bytes(_answer_in_time(work, budget))


def _answer_in_time(work: Work, budget: Budget) -> bytes:
    try:
        return RESULT + json_bytes(work())
    except VeritorqueError as error:
        return FAILURE + json_bytes(problem_of(error).document())
    except DamagedError as error:
        return FAILURE + json_bytes(problem_of_damage(error).document())
    except MemoryError:
        return FAILURE + json_bytes(problem_of(too_much_memory(budget)).document())
    except Exception:  # noqa: BLE001  (the boundary of the process: the service decides what its client is told)
        return TRACE + traceback.format_exc().encode(errors="replace")


def too_much_memory(budget: Budget) -> LogError:
    """Say that the memory did not suffice."""
    return LogError(
        "reading the file takes more memory than a file of its size may ask for",
        evidence={"at_most_bytes": budget.memory_bytes},
        remedy="save the log as Parquet, which is read piece by piece, or upload several shorter logs",
    )
