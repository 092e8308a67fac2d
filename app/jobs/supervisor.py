"""Keep a worker process alive beside the service: started again when it dies, killed when it freezes.

The worker writes a line a second; silence means that it is frozen. The service writes a line when there is a
job, and the worker ends by itself when that pipe closes, so that none is left behind when the service is
killed.
"""

import json
import logging
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from ..settings import Settings
from .computation import Ended

LOGGER = logging.getLogger(__name__)
SILENCE_S = 10.0
"""A worker that writes nothing for so long is frozen."""
START_S = 120.0
"""What it may take until its first word: on a busy machine the libraries alone take long to load."""
POLL_S = 0.5
PAUSES_S = (0.0, 0.5, 2.0, 5.0)
"""Before a worker is started again, by how often in a row that failed at once."""
STABLE_S = 10.0
END_S = 15.0
READY, ALIVE, ENDED = b"ready", b"alive", b"ended"
"""What a worker says; after the last comes how the computation went, as JSON."""
Start = Callable[[Settings], "subprocess.Popen[bytes]"]


class Supervisor:
    """Start a worker process, and see that there is one as long as the service runs.

    Parameters
    ----------
    start
        Starts the process; its standard output says that it lives, and the end of its standard input that it
        shall end.
    on_ended
        Called with the outcome of every computation.
    """

    def __init__(
        self,
        settings: Settings,
        start: Start | None = None,
        *,
        on_ended: Callable[[Ended], None] | None = None,
    ) -> None:
        self._settings, self._start, self._on_ended = settings, start or start_worker, on_ended
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="supervisor")
        self._last_word = 0.0
        self._notice_pipe: int | None = None
        self._notice_lock = threading.Lock()
        self.ready = threading.Event()

    @property
    def alive(self) -> bool:
        """Return whether a worker has written recently."""
        return time.monotonic() - self._last_word < SILENCE_S

    def start(self) -> None:
        """Start the first worker."""
        self._thread.start()

    def wake(self) -> None:
        """Let the worker look for jobs at once; without that it would look a little later."""
        with self._notice_lock:
            if self._notice_pipe is not None:
                with suppress(OSError):  # the worker is gone, or its pipe is full of notices
                    os.write(self._notice_pipe, b"\n")

    def close(self) -> None:
        """Let the worker hand its jobs back and end."""
        self._closing.set()
        self._thread.join()

    def _serve(self) -> None:
        failures = 0
        while not self._closing.wait(PAUSES_S[min(failures, len(PAUSES_S) - 1)]):
            begun = time.monotonic()
            with self._start(self._settings) as process:
                self._last_word = begun + START_S - SILENCE_S
                threading.Thread(target=self._listen, args=(process,), daemon=True).start()
                with self._notices_to(process):
                    self._watch(process)
                _end(process)
            lived = time.monotonic() - begun
            failures = 0 if lived > STABLE_S else failures + 1
            if not self._closing.is_set():
                LOGGER.error("the worker ended (%s) after %.1f s", process.returncode, lived)

    @contextmanager
    def _notices_to(self, process: "subprocess.Popen[bytes]") -> Iterator[None]:
        """Let `wake` reach a worker until its pipe is closed, whose number may then be another file's."""
        if process.stdin is not None:
            os.set_blocking(process.stdin.fileno(), False)
            self._notice_pipe = process.stdin.fileno()
        try:
            yield
        finally:
            with self._notice_lock:
                self._notice_pipe = None

    def _watch(self, process: "subprocess.Popen[bytes]") -> None:
        while not self._closing.wait(POLL_S) and process.poll() is None:
            if not self.alive:
                LOGGER.error("the worker %d says nothing for %g s and is killed", process.pid, SILENCE_S)
                process.kill()

    def _listen(self, process: "subprocess.Popen[bytes]") -> None:
        for line in _said(process):
            self._last_word = time.monotonic()
            word, _, content = line.strip().partition(b" ")
            if word == READY:
                self.ready.set()
            elif word == ENDED and self._on_ended is not None:
                self._on_ended(Ended(**json.loads(content)))


def _said(process: "subprocess.Popen[bytes]") -> Iterator[bytes]:
    """Read what a worker says until it ends, or until its pipe is closed during the reading."""
    try:
        yield from process.stdout or ()
    except ValueError:  # what Python says of a file that another thread closes meanwhile
        return


def start_worker(settings: Settings) -> "subprocess.Popen[bytes]":
    """Start a worker process with the settings of the service."""
    return subprocess.Popen(
        [sys.executable, "-m", "veritorque", "work", "--beside"],
        env={**os.environ, **settings.environment()},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )


def _end(process: "subprocess.Popen[bytes]") -> None:
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(END_S)
        except subprocess.TimeoutExpired:
            process.kill()
