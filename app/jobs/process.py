"""Be a worker process: compute until told to end, by a signal or by the service's going.

Beside a service it says every second that it lives, on its standard output, and takes the end of its standard
input for the service's end.
"""

import os
import signal
import sys
import threading
from dataclasses import asdict

from app.catalogue import built_in_robots
from app.documents import json_bytes
from app.jobs.computation import Ended
from app.jobs.supervisor import ALIVE, ENDED, READY
from app.services import executor_of, worker_of
from app.settings import Settings
from app.store.store import Store

PULSE_S = 1.0


def work_until_told(store: Store, settings: Settings, *, beside: bool) -> None:
    """Work through the queue; return when told to end and all jobs are handed back."""
    told = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: told.set())
    if beside:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the service, which then ends this
        threading.Thread(target=_hear_the_end, args=(told,), daemon=True).start()
    tell = _tell if beside else None
    worker = worker_of(store, settings, executor_of(settings), built_in_robots(), tell)
    worker.start()
    while not told.wait(PULSE_S):
        if beside:
            _say(READY if worker.ready.is_set() else ALIVE)
    worker.close()


def _hear_the_end(told: threading.Event) -> None:
    os.read(sys.stdin.fileno(), 1)  # nothing is ever sent: it returns when the service is gone
    told.set()


def _tell(ended: Ended) -> None:
    _say(ENDED + b" " + json_bytes(asdict(ended)))


def _say(word: bytes) -> None:
    try:
        os.write(sys.stdout.fileno(), word + b"\n")
    except OSError:  # the service is gone; its end is heard as well
        return
