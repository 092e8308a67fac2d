"""Find out whether the service can do its work: the database takes writes, a worker lives, the disk has room.

Probes may come often and from anybody, so that the database is asked once a second at most.
"""

import shutil
import threading
import time
from collections.abc import Callable

import anyio

from ..problems import Problem
from ..settings import Settings
from ..store.errors import UnavailableError
from ..store.store import Store

FRESH_S = 1.0
PROBE_WAIT_S = 1.0
"""How long a probe waits for the one before it."""
LOADING_S = 60.0
"""How long a request waits that cannot be answered without the solver."""
POLL_S = 0.1
Check = Callable[[], bool]


class Readiness:
    """Check what the service needs.

    Parameters
    ----------
    worker_alive
        Whether a worker is alive, as far as this service knows.
    worker_ready
        Whether the worker has loaded the solver.
    """

    def __init__(self, store: Store, settings: Settings, *, worker_alive: Check, worker_ready: Check) -> None:
        self._store, self._settings = store, settings
        self._worker_alive, self._worker_ready = worker_alive, worker_ready
        self._probing = threading.Lock()
        self._refused: str | None = None
        self._until = 0.0

    def require(self) -> None:
        """Return where the service can do its work.

        Raises
        ------
        Problem
            If it cannot, with the first of the reasons and the remedy (503).
        """
        for problem in (self._database(), self._disk(), self._worker()):
            if problem is not None:
                raise problem

    async def wait_for_solver(self) -> None:
        """Return once the worker has loaded the solver.

        To compile it here as well would hold up every other request.

        Raises
        ------
        Problem
            If it takes longer than a client waits (503).
        """
        with anyio.move_on_after(LOADING_S):
            while not self._worker_ready():  # noqa: ASYNC110  # it gets ready in a thread or process of its own
                await anyio.sleep(POLL_S)
            return
        raise _loading_problem()

    def _database(self) -> Problem | None:
        refused = self._refusal()
        if refused is None:
            return None
        return _not_ready(
            "the database cannot be written",
            {"reason": refused},
            "see whether its disk is full, its files are writable, and its server runs",
        )

    def _refusal(self) -> str | None:
        """Say why the database takes no writes; None where it does."""
        if not self._probing.acquire(timeout=PROBE_WAIT_S):
            return f"it has not answered for {PROBE_WAIT_S:g} s"
        try:
            if time.monotonic() >= self._until:
                self._refused = self._write()
                self._until = time.monotonic() + FRESH_S
            return self._refused
        finally:
            self._probing.release()

    def _write(self) -> str | None:
        try:
            self._store.prove_writable()
        except UnavailableError as error:
            return error.reason
        return None

    def _disk(self) -> Problem | None:
        free, reserve = shutil.disk_usage(self._settings.data_dir).free, self._settings.disk_reserve_bytes
        if free >= reserve:
            return None
        return _not_ready(
            "the disk has less room than its reserve",
            {"free_bytes": free, "reserve_bytes": reserve},
            "make room, delete logs and jobs, or run: veritorque gc",
        )

    def _worker(self) -> Problem | None:
        if not self._worker_ready():
            return _loading_problem()
        if not self._worker_alive():
            return _not_ready(
                "the worker does not respond; another is started in its place",
                {},
                "jobs may be sent and will wait; the service's own log says why it ended",
            )
        return None


def _loading_problem() -> Problem:
    return _not_ready(
        "the solver is being loaded; at the very first start it is compiled",
        {},
        "jobs may be sent and will wait; ask again in a few seconds",
    )


def _not_ready(cause: str, evidence: dict[str, object], remedy: str) -> Problem:
    return Problem("not-ready", cause, evidence=evidence, remedy=remedy, headers={"Retry-After": "2"})
