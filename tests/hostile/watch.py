"""Watch what hostile files are not to do: open the files of others, and take memory or time.

The kernel reports opened files (inotify), and the memory and waiting of the processes that do the reading.
"""

import ctypes
import os
import re
import threading
import time
from multiprocessing import forkserver
from pathlib import Path
from typing import Self

OPENED = 0x20  # IN_OPEN
EVENT_HEAD = 16
LOOK_EVERY_S = 0.002


class Openings:
    """Count how often files are opened, by whomever."""

    def __init__(self, *paths: Path) -> None:
        libc = ctypes.CDLL(None, use_errno=True)
        self._queue = libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        for path in paths:
            if libc.inotify_add_watch(self._queue, os.fsencode(path), OPENED) < 0:
                raise OSError(ctypes.get_errno(), "cannot be watched", str(path))

    def count(self) -> int:
        """Give the openings since the last count."""
        try:
            return len(os.read(self._queue, 1 << 16)) // EVENT_HEAD
        except BlockingIOError:
            return 0

    def close(self) -> None:
        os.close(self._queue)


class Readers:
    """Follow the processes that may read an upload from now on: the most memory, and their waiting.

    Such processes are forks of one server, and so are those that compute jobs of other services in here.
    Hence what counts is by how much the largest size of one grows: of a new one, beyond the server's. What
    they wait for a processor that others use is the longest wait of one.
    """

    def __init__(self) -> None:
        self.peak_mb = self.waited_s = 0.0
        self._before: dict[str, tuple[float, float]] = {}
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._follow, daemon=True)

    def __enter__(self) -> Self:
        self._before = {fork: (_memory_mb(fork, "VmHWM"), _waited_s(fork)) for fork in _forks()}
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def _follow(self) -> None:
        while not self._over.is_set():
            for fork in _forks():
                memory, waited = self._before.setdefault(fork, (_memory_mb(_server(), "VmRSS"), 0.0))
                self.peak_mb = max(self.peak_mb, _memory_mb(fork, "VmHWM") - memory)
                self.waited_s = max(self.waited_s, _waited_s(fork) - waited)
            time.sleep(LOOK_EVERY_S)


def _forks() -> list[str]:
    server = _server()
    try:
        return Path(f"/proc/{server}/task/{server}/children").read_text().split()
    except OSError:
        return []


def _server() -> str:
    return str(forkserver._forkserver._forkserver_pid)


def _memory_mb(process: str, kind: str) -> float:
    """Give a size of a process, MB: VmRSS is the present one, VmHWM the largest."""
    try:
        found = re.search(rf"{kind}:\s+(\d+) kB", Path(f"/proc/{process}/status").read_text())
    except OSError:
        return 0.0
    return int(found[1]) / 1024.0 if found else 0.0


def _waited_s(process: str) -> float:
    """Give how long a process could have run and had no processor, s."""
    try:
        return int(Path(f"/proc/{process}/schedstat").read_text().split()[1]) / 1e9
    except (OSError, IndexError):
        return 0.0
