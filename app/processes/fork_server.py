"""Start processes as forks of one server process that has loaded what they need, and end them for good.

Python keeps one such server per process, hence everybody who forks names here what it shall load before the
first fork. A child does one task, which it is sent over its pipe; so it can be there before its task is.
"""

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from multiprocessing import forkserver
from multiprocessing.context import ForkServerContext
from queue import Empty, SimpleQueue
from threading import Event, Lock

READERS = (
    "h5py",
    "pandas",
    "pyarrow.csv",
    "pyarrow.parquet",
    "rosbags.rosbag1",
    "rosbags.rosbag2.storage_mcap",
    "rosbags.typesys",
    "scipy.io.matlab",
    "sqlite3",
)
"""What reads logs; what is not installed is passed over. Where pandas is installed, Arrow loads it."""
POLL_S = 0.05
GRACE_S = 3.0
"""How long a child that is being started may still take when it is not needed any more."""
_PRELOAD: list[str] = []


def fork_server(*preload: str) -> ForkServerContext:
    """Give the context in which to start processes; the server loads these modules, too, unless it runs."""
    _PRELOAD.extend(name for name in preload if name not in _PRELOAD)
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(_PRELOAD))
    return context


class NotNeeded(Exception):  # noqa: N818 - no error: nothing went wrong
    """Signal that a child is not needed any more, because its task was stopped."""


class Child:
    """Start a process, and hold the other end of the pipe that is its first argument.

    Attributes
    ----------
    pipe
        Takes its task, and gives what it sends.
    """

    def __init__(self, context: ForkServerContext, target: Callable[..., None], *arguments: object) -> None:
        self.pipe, theirs = context.Pipe()
        self._process = context.Process(target=target, args=(theirs, *arguments), daemon=True)
        try:
            self._process.start()
        except BaseException:
            self.pipe.close()
            raise
        finally:
            theirs.close()

    @property
    def alive(self) -> bool:
        """Return whether it has not ended yet."""
        return self._process.is_alive()

    def exit_code(self) -> int | None:
        """Wait for its end, and give its exit code; a negative one is a signal's number."""
        self._process.join()
        return self._process.exitcode

    def kill(self) -> None:
        """End it, whatever it is doing; `end` has to follow."""
        self._process.kill()

    def end(self) -> None:
        """End it, and release its pipe and process."""
        self._process.kill()
        self._process.join()
        self._process.close()
        self.pipe.close()


class ProcessPool:
    """Keep children that wait for tasks, so that no task waits for a child.

    Each is used once; it is removed and replaced in the background.

    Parameters
    ----------
    make
        Starts a child.
    """

    def __init__(self, make: Callable[[], Child]) -> None:
        self._make = make
        self._coming: SimpleQueue[Future[Child]] = SimpleQueue()
        self._keeper = ThreadPoolExecutor(1, thread_name_prefix="process-pool")
        self._making: set[Future[Child]] = set()
        self._closed, self._parting = False, Lock()

    def prepare(self, count: int) -> list["Future[Child]"]:
        """Have so many children made, none after `close`; as many tasks at the same time wait for none."""
        with self._parting:
            coming = [self._make_child(self._make) for _ in range(0 if self._closed else count)]
            for child in coming:
                self._coming.put(child)
        return coming

    @contextmanager
    def child(self, stop: Event | None = None) -> Iterator[Child]:
        """Give a child, and end it afterwards.

        Raises
        ------
        OSError, EOFError
            If there is none to be had.
        NotNeeded
            If none had come yet when `stop` was set.
        """
        try:
            coming, kept = self._coming.get_nowait(), True
        except Empty:  # more tasks at a time than were prepared for
            coming, kept = self._make_child(self._make), False
        while stop is not None and not coming.done():
            if stop.is_set():
                if kept:
                    self._coming.put(coming)
                elif not coming.cancel():
                    coming.add_done_callback(_end_unwanted)
                raise NotNeeded
            wait([coming], POLL_S)
        used: list[Child] = []
        try:
            used.append(coming.result())
            if not used[0].alive:
                used.append(self._make())
            yield used[-1]
        finally:
            for child in used:
                child.kill()
            self._clear_away(used, followed=kept)

    def close(self) -> None:
        """End all that wait; none may be in use any more.

        A child that stayed would keep this process from ending: it heeds no request to end. So would a server
        that is still loading; at the very first start that takes as long as compiling does.
        """
        with self._parting:
            self._closed = True
        self._keeper.shutdown(wait=False, cancel_futures=True)
        for coming in list(self._making):
            with suppress(OSError, EOFError, CancelledError):
                _child_of(coming)
        with suppress(Empty):
            while True:
                coming = self._coming.get_nowait()
                with suppress(OSError, EOFError, CancelledError):
                    coming.result().end()
        self._keeper.shutdown()

    def _make_child(self, make: Callable[..., Child], *arguments: object) -> "Future[Child]":
        coming = self._keeper.submit(make, *arguments)
        self._making.add(coming)
        coming.add_done_callback(self._making.discard)
        return coming

    def _clear_away(self, used: list[Child], *, followed: bool) -> None:
        try:
            if followed:
                self._coming.put(self._make_child(self._successor, used))
            else:
                self._keeper.submit(_end, used)
        except RuntimeError:  # closed meanwhile
            _end(used)

    def _successor(self, used: list[Child]) -> Child:
        _end(used)
        return self._make()


def _end(used: list[Child]) -> None:
    for child in used:
        child.end()


def _end_unwanted(made: "Future[Child]") -> None:
    if not made.cancelled() and made.exception() is None:
        made.result().end()


def _child_of(coming: "Future[Child]") -> Child:
    """Give the child, or end the server that is still loading what it would have been forked with."""
    while True:
        try:
            return coming.result(GRACE_S)
        except TimeoutError:
            if coming.done():
                return coming.result()
            _end_server()


def _end_server() -> None:
    """Kill the server process; the next child starts a new one."""
    server = forkserver._forkserver._forkserver_pid  # type: ignore[attr-defined]  # noqa: SLF001  # it has no public name
    if server is not None:
        with suppress(ProcessLookupError):
            os.kill(server, signal.SIGKILL)
