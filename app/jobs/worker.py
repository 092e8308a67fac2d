"""Take waiting jobs from the store and see each to its end, whatever happens meanwhile.

One thread per computation that may run at the same time, which computes in the executor's processes; one more
shows that this worker lives, notices what was dismissed, and looks after the jobs of workers that died. A
worker runs within the service or in a process of its own, as many of them as one likes.
"""

import logging
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from ...core.errors import VeritorqueError
from .. import logging as journal
from ..lifecycle.retention import expire
from ..problems import URN, Problem, problem_of
from ..settings import Kept
from ..store.errors import Unavailable
from ..store.records import Document, JobRecord
from ..store.store import Store
from ..store.sweep import Sweep
from ..store.work import Held
from .computation import Computation, Died, Ended, Failed, Finished, LogFile, Outcome, Stopped
from .executor import Executor
from .job_process import mistake
from .liveness import Presence
from .progress import Reporter
from .reclaim import Lives
from .references import reference_file

LOGGER = logging.getLogger(__name__)
LOOK_EVERY_S = 0.02
WATCH_EVERY_S = 0.1
BEAT_EVERY_S = 2.0
SWEEP_EVERY_S = 60.0
PAUSE_S = 1.0
"""Time to wait where the database does not answer, or the disk is full."""
OUTCOMES = {Finished: "successful", Failed: "failed", Died: "died", Stopped: "stopped"}


@dataclass(frozen=True)
class Capacity:
    """Say how much a worker takes on.

    Attributes
    ----------
    slots
        Jobs at the same time.
    most_per_tenant
        Of these, jobs of one tenant.
    timeout_s
        Longest a job may compute, s.
    retention_days
        How long finished jobs and the like are kept; see `app.lifecycle.retention`.
    """

    slots: int
    most_per_tenant: int
    timeout_s: float
    retention_days: Mapping[Kept, float]


class Worker:
    """Work through the queue.

    Parameters
    ----------
    store
        Where jobs wait and results go.
    executor
        What computes.
    robots
        Descriptions of the built-in robots by id.
    capacity
        How much it takes on.
    told
        Hears how every computation went.
    """

    def __init__(
        self,
        store: Store,
        executor: Executor,
        *,
        robots: dict[str, Document],
        capacity: Capacity,
        told: Callable[[Ended], None] | None = None,
    ) -> None:
        self._store, self._executor, self._robots = store, executor, robots
        self._capacity, self._told = capacity, told
        self._presence = Presence(store.directory / "workers")
        self._lives, self._sweep = Lives(store, self._presence), Sweep(store)
        self._closing, self._woken = threading.Event(), threading.Condition()
        self._stops: dict[Held, threading.Event] = {}
        self._forgotten: set[Held] = set()
        self._threads = [threading.Thread(target=self._serve, name=f"job-{n}") for n in range(capacity.slots)]
        self._threads.append(threading.Thread(target=self._watch, name="watch"))
        self.ready = threading.Event()

    @property
    def alive(self) -> bool:
        """Tell whether all that belongs to it works."""
        return all(thread.is_alive() for thread in self._threads)

    def start(self) -> None:
        """Begin to work."""
        for thread in (*self._threads, threading.Thread(target=self._prepare, name="prepare", daemon=True)):
            thread.start()

    def wake(self) -> None:
        """Look for jobs at once: there is a new one."""
        with self._woken:
            self._woken.notify_all()

    def close(self) -> None:
        """Stop all computations, hand their jobs back, and wait for the threads."""
        self._closing.set()
        for stop in list(self._stops.values()):
            stop.set()
        for thread in self._threads:
            thread.join()
        self._executor.close()
        self._presence.leave()

    def _prepare(self) -> None:
        try:
            self._executor.prepare()
        except Exception:
            if self._closing.is_set():
                return
            LOGGER.exception("the solver could not be loaded ahead; the first job will try again")
        self.ready.set()

    def _serve(self) -> None:
        while not self._closing.is_set():
            try:
                job = self._claim()
                if job is not None:
                    self._see_through(job)
                    continue
                with self._woken:
                    self._woken.wait(LOOK_EVERY_S)
            except Unavailable as error:
                LOGGER.warning("the database does not answer: %s", error.reason)
                self._closing.wait(PAUSE_S)
            except Exception:
                LOGGER.exception("taking a job met a mistake of ours")
                self._closing.wait(PAUSE_S)

    def _claim(self) -> JobRecord | None:
        most = self._capacity.most_per_tenant
        return self._store.work.claim(self._presence.name, most_per_tenant=most)

    def _watch(self) -> None:
        beat = sweep = time.monotonic()
        while not self._closing.wait(WATCH_EVERY_S):
            now = time.monotonic()
            try:
                self._stop_what_is_lost()
                if now >= beat:
                    self._store.work.beat(self._presence.name)
                    self._lives.look()
                    self._hand_back_what_is_forgotten()
                    beat = now + BEAT_EVERY_S
                if now >= sweep:
                    expire(self._store.database, self._capacity.retention_days)
                    self._sweep.look()
                    sweep = now + SWEEP_EVERY_S
            except Unavailable as error:
                LOGGER.warning("the database does not answer: %s", error.reason)
            except Exception:
                LOGGER.exception("looking after the jobs met a mistake of ours")

    def _stop_what_is_lost(self) -> None:
        """End the computations of jobs that were dismissed, or given to another worker."""
        running = dict(self._stops)
        if not running:
            return
        held = self._store.work.held(self._presence.name)
        for lost in running.keys() - held:
            running[lost].set()

    def _hand_back_what_is_forgotten(self) -> None:
        """Let go of jobs that this worker holds and does not know of, twice in a row.

        The database had given them when the answer was cut off.
        """
        forgotten = self._store.work.held(self._presence.name) - self._stops.keys()
        for held in forgotten & self._forgotten:
            self._store.work.hand_back(held)
        self._forgotten = forgotten

    def _see_through(self, job: JobRecord) -> None:
        held = (job.id, job.token)
        stop = self._stops[held] = threading.Event()
        begun = time.monotonic()
        try:
            with journal.bound(job=job.id, trace=job.trace), self._store.blobs.aside() as traces:
                outcome = self._computed(job, stop, traces)
                self._settle(held, outcome, traces)
                self._tell(job, outcome, time.monotonic() - begun)
        finally:
            del self._stops[held]

    def _computed(self, job: JobRecord, stop: threading.Event, traces: Path) -> Outcome:
        """Compute a job, and give how that went, whatever happened."""
        try:
            return self._outcome(job, stop, traces)
        except VeritorqueError as error:
            return Failed(problem_of(error).document())
        except Problem as problem:
            return Failed(problem.document())
        except Unavailable as error:
            LOGGER.warning("the job is handed back, for the database does not answer: %s", error.reason)
            self._closing.wait(PAUSE_S)
            return Stopped()
        except Exception:
            LOGGER.exception("the job met a mistake of ours")
            return Failed(mistake().document())

    def _outcome(self, job: JobRecord, stop: threading.Event, traces: Path) -> Outcome:
        computation = self._computation(job, traces)
        if self._closing.is_set():
            stop.set()
        progress, timeout_s = Reporter(self._store, (job.id, job.token)), self._capacity.timeout_s
        return self._executor.run(computation, progress=progress, stop=stop, timeout_s=timeout_s)

    def _tell(self, job: JobRecord, outcome: Outcome, seconds: float) -> None:
        problem = outcome.problem if isinstance(outcome, Failed | Died) else None
        kind = None if problem is None else str(problem["type"]).removeprefix(URN)
        ended = Ended(job.request.kind, OUTCOMES[type(outcome)], round(seconds, 6), kind)
        LOGGER.info("computed", extra=asdict(ended))
        if self._told is not None:
            self._told(ended)

    def _settle(self, held: Held, outcome: Outcome, traces: Path) -> None:
        """Write the outcome down, however long the database or room on the disk takes to come."""
        while True:
            try:
                return self._settled(held, outcome, traces)
            except (Unavailable, OSError) as error:
                LOGGER.warning("the outcome waits to be written: %s", error)
                if self._closing.wait(PAUSE_S):
                    return None

    def _settled(self, held: Held, outcome: Outcome, traces: Path) -> None:
        if isinstance(outcome, Finished):
            self._store.keep_result(held, outcome.result, traces)
        elif isinstance(outcome, Failed):
            self._store.work.fail(held, outcome.problem)
        elif isinstance(outcome, Died):
            self._store.work.bury(held, outcome.problem)
        else:
            self._store.work.hand_back(held)  # after a shutdown; a dismissed job stays dismissed

    def _computation(self, job: JobRecord, traces: Path) -> Computation:
        store = self._store.of(job.tenant)
        robot = store.robots.get(job.request.robot)
        description = robot.description if robot else self._robots.get(job.request.robot)
        if description is None:
            raise _gone("robot", job.request.robot)
        logs = []
        for identity in job.request.logs:
            log = store.logs.get(identity)
            if log is None:
                raise _gone("log", identity)
            mapping = log.summary["mapping"]
            known = mapping if isinstance(mapping, dict) else None
            logs.append(LogFile(store.blobs.path(log.sha256), str(log.summary["name"]), known, log.sha256))
        return Computation(
            kind=job.request.kind,
            robot=description,
            logs=tuple(logs),
            options=job.request.options,
            reference=reference_file(store, job.request.kind, job.request.options),
            traces=traces,
        )


def _gone(what: str, identity: str) -> Problem:
    return Problem(
        "not-found",
        f"the {what} {identity} was deleted while the job waited",
        evidence={what: identity},
        remedy="create it again and ask for the job again",
    )
