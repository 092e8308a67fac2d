"""Run as a worker process: compute until a signal or the end of the service ends it.

Beside a service it writes a line to its standard output every second. A line on its standard input announces
a job, and the end of the input is the end of the service.
"""

import os
import signal
import sys
import threading
from dataclasses import asdict

from ..json_text import json_bytes
from ..services.robot_descriptions import built_in_robots
from ..services.workers import executor_of, worker_of
from ..settings import Settings
from ..store.store import Store
from .computation import Ended
from .supervisor import ALIVE, ENDED, READY
from .worker import Worker

PULSE_S = 1.0


def work_until_stopped(store: Store, settings: Settings, *, beside: bool) -> None:
    """Work through the queue; return after a signal, when all jobs are handed back."""
    stopped = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stopped.set())
    if beside:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the service, which then ends this
    report = _report if beside else None
    worker = worker_of(store, settings, executor_of(settings, store), built_in_robots(), report)
    worker.start()
    if beside:
        threading.Thread(target=_listen, args=(worker, stopped), daemon=True).start()
    while not stopped.wait(PULSE_S):
        if beside:
            _write(READY if worker.ready.is_set() else ALIVE)
    worker.close()


def _listen(worker: Worker, stopped: threading.Event) -> None:
    while os.read(sys.stdin.fileno(), 4096):
        worker.wake()
    stopped.set()  # the service is gone


def _report(ended: Ended) -> None:
    _write(ENDED + b" " + json_bytes(asdict(ended)))


def _write(line: bytes) -> None:
    try:
        os.write(sys.stdout.fileno(), line + b"\n")
    except OSError:  # the service is gone; `_listen` notices as well
        return
