"""Be a worker process: compute until told to end, by a signal or by the service's going.

Beside a service it says every second that it lives, on its standard output. It takes a line of its standard
input for the news of a job, and the end for the service's end.
"""

import os
import signal
import sys
import threading
from dataclasses import asdict

from ..json_text import json_bytes
from ..services.catalogue import built_in_robots
from ..services.services import executor_of, worker_of
from ..settings import Settings
from ..store.store import Store
from .computation import Ended
from .supervisor import ALIVE, ENDED, READY
from .worker import Worker

PULSE_S = 1.0


def work_until_stopped(store: Store, settings: Settings, *, beside: bool) -> None:
    """Work through the queue; return when told to end and all jobs are handed back."""
    told = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: told.set())
    if beside:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the service, which then ends this
    tell = _tell if beside else None
    worker = worker_of(store, settings, executor_of(settings, store), built_in_robots(), tell)
    worker.start()
    if beside:
        threading.Thread(target=_hear, args=(worker, told), daemon=True).start()
    while not told.wait(PULSE_S):
        if beside:
            _say(READY if worker.ready.is_set() else ALIVE)
    worker.close()


def _hear(worker: Worker, told: threading.Event) -> None:
    while os.read(sys.stdin.fileno(), 4096):
        worker.wake()
    told.set()  # the service is gone


def _tell(ended: Ended) -> None:
    _say(ENDED + b" " + json_bytes(asdict(ended)))


def _say(word: bytes) -> None:
    try:
        os.write(sys.stdout.fileno(), word + b"\n")
    except OSError:  # the service is gone; its end is heard as well
        return
