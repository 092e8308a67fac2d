"""Take waiting jobs from the store, have them computed, and write down their outcomes.

One thread per computation that may run at the same time waits for the executor; one more sends heartbeats,
stops computations of dismissed jobs, and reclaims the jobs of workers that died. Workers run within the
service or in processes of their own, any number of them.
"""

import logging
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from ...core.errors import VeritorqueError
from .. import logging as service_log
from ..lifecycle.retention import expire
from ..problems import URN, Problem, problem_of
from ..settings import Kept
from ..store.blobs.sweep import Sweep
from ..store.errors import UnavailableError
from ..store.records import Document, JobRecord
from ..store.store import Store
from ..store.work import Held
from .computation import Died, Ended, Failed, Finished, Outcome, Stopped
from .executors.executor import Executor
from .executors.job_process import internal_error
from .inputs import computation_of, open_workspace
from .liveness import Presence
from .reclaim import Reclaimer

LOGGER = logging.getLogger(__name__)
REPORT_EVERY_S = 0.2
POLL_S, LONGEST_POLL_S, GROWTH = 0.02, 0.25, 1.5
"""Time between two looks for jobs right after one, s, at rest, and the ratio by which it grows in between."""
WATCH_EVERY_S = 0.1
HEARTBEAT_S = 2.0
SWEEP_EVERY_S = 60.0
PAUSE_S = 1.0
"""Time to wait where the database does not answer, or the disk is full."""
OUTCOMES = {Finished: "successful", Failed: "failed", Died: "died", Stopped: "stopped"}


@dataclass(frozen=True)
class Capacity:
    """Bound what a worker takes on."""

    slots: int
    """Jobs at the same time."""
    most_per_tenant: int
    """Of these, jobs of one tenant."""
    timeout_s: float
    """Longest a job may compute, s."""
    retention_days: Mapping[Kept, float]
    """How long finished jobs and the like are kept; see `app.lifecycle.retention`."""


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
    on_ended
        Called with the outcome of every computation.
    """

    def __init__(
        self,
        store: Store,
        executor: Executor,
        *,
        robots: dict[str, Document],
        capacity: Capacity,
        on_ended: Callable[[Ended], None] | None = None,
    ) -> None:
        self._store, self._executor, self._robots = store, executor, robots
        self._capacity, self._on_ended = capacity, on_ended
        self._presence = Presence(store.directory / "workers")
        self._reclaimer, self._sweep = Reclaimer(store, self._presence), Sweep(store)
        self._closing, self._woken, self._notices = threading.Event(), threading.Condition(), 0
        self._stops: dict[Held, threading.Event] = {}
        self._unknown: set[Held] = set()
        self._threads = [threading.Thread(target=self._serve, name=f"job-{n}") for n in range(capacity.slots)]
        self._threads.append(threading.Thread(target=self._watch, name="watch"))
        self.ready = threading.Event()

    @property
    def alive(self) -> bool:
        """Return whether all of its threads run."""
        return all(thread.is_alive() for thread in self._threads)

    def start(self) -> None:
        """Begin to work."""
        for thread in (*self._threads, threading.Thread(target=self._prepare, name="prepare", daemon=True)):
            thread.start()

    def wake(self) -> None:
        """Look for jobs at once."""
        with self._woken:
            self._notices += 1
            self._woken.notify_all()

    def close(self) -> None:
        """Stop all computations, hand their jobs back, and wait for the threads."""
        self._closing.set()
        self.wake()
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
            LOGGER.exception("the solver could not be loaded in advance; the first job will try again")
        self.ready.set()

    def _serve(self) -> None:
        pause = POLL_S
        while not self._closing.is_set():
            try:
                seen = self._notices
                job = self._claim()
                if job is not None:
                    self._process(job)
                woken = job is not None or self._wait(seen, pause)
                pause = POLL_S if woken else min(GROWTH * pause, LONGEST_POLL_S)
            except UnavailableError as error:
                LOGGER.warning("the database does not answer: %s", error.reason)
                self._closing.wait(PAUSE_S)
            except Exception:
                LOGGER.exception("taking a job failed with an internal error")
                self._closing.wait(PAUSE_S)

    def _wait(self, seen: int, seconds: float) -> bool:
        """Wait until there is a notice beyond those seen, or so long; tell whether there is."""
        with self._woken:
            return self._woken.wait_for(lambda: self._notices != seen, seconds)

    def _claim(self) -> JobRecord | None:
        most = self._capacity.most_per_tenant
        return self._store.work.claim(self._presence.name, most_per_tenant=most)

    def _watch(self) -> None:
        beat = sweep = time.monotonic()
        while not self._closing.wait(WATCH_EVERY_S):
            now = time.monotonic()
            try:
                self._stop_lost_jobs()
                if now >= beat:
                    self._store.work.beat(self._presence.name)
                    self._reclaimer.run()
                    self._hand_back_unknown_jobs()
                    beat = now + HEARTBEAT_S
                if now >= sweep:
                    expire(self._store.database, self._capacity.retention_days)
                    self._sweep.run()
                    sweep = now + SWEEP_EVERY_S
            except UnavailableError as error:
                LOGGER.warning("the database does not answer: %s", error.reason)
            except Exception:
                LOGGER.exception("supervising the jobs failed with an internal error")

    def _stop_lost_jobs(self) -> None:
        """End the computations of jobs that were dismissed, or given to another worker."""
        running = dict(self._stops)
        if not running:
            return
        held = self._store.work.held(self._presence.name)
        for lost in running.keys() - held:
            running[lost].set()

    def _hand_back_unknown_jobs(self) -> None:
        """Hand back jobs that this worker holds and does not know of, twice in a row.

        The database had given them when the answer was cut off.
        """
        unknown = self._store.work.held(self._presence.name) - self._stops.keys()
        for held in unknown & self._unknown:
            self._store.work.hand_back(held)
        self._unknown = unknown

    def _process(self, job: JobRecord) -> None:
        held = (job.id, job.token)
        stop = self._stops[held] = threading.Event()
        begin = time.monotonic()
        try:
            with service_log.bound(job=job.id, trace=job.trace), self._store.blobs.scratch_file() as traces:
                outcome = self._outcome(job, stop, traces)
                self._settle(held, outcome, traces)
                self._report(job, outcome, time.monotonic() - begin)
        finally:
            del self._stops[held]

    def _outcome(self, job: JobRecord, stop: threading.Event, traces: Path) -> Outcome:
        """Compute a job, and turn every error into an outcome."""
        try:
            return self._run(job, stop, traces)
        except VeritorqueError as error:
            return Failed(problem_of(error).document())
        except Problem as problem:
            return Failed(problem.document())
        except UnavailableError as error:
            LOGGER.warning("the job is handed back because the database does not answer: %s", error.reason)
            self._closing.wait(PAUSE_S)
            return Stopped()
        except Exception:
            LOGGER.exception("the job failed with an internal error")
            return Failed(internal_error().document())

    def _run(self, job: JobRecord, stop: threading.Event, traces: Path) -> Outcome:
        task = computation_of(job, self._store.of(job.tenant), self._robots)
        if self._closing.is_set():
            stop.set()
        progress, timeout_s = Reporter(self._store, (job.id, job.token)), self._capacity.timeout_s
        with open_workspace(task, self._store.blobs, traces) as workspace:
            return self._executor.run(task, workspace, progress=progress, stop=stop, timeout_s=timeout_s)

    def _report(self, job: JobRecord, outcome: Outcome, seconds: float) -> None:
        problem = outcome.problem if isinstance(outcome, Failed | Died) else None
        kind = None if problem is None else str(problem["type"]).removeprefix(URN)
        ended = Ended(job.request.kind, OUTCOMES[type(outcome)], round(seconds, 6), kind)
        LOGGER.info("computed", extra=asdict(ended))
        if self._on_ended is not None:
            self._on_ended(ended)

    def _settle(self, held: Held, outcome: Outcome, traces: Path) -> None:
        """Write the outcome down, and try again while the database does not answer or the disk is full."""
        while True:
            try:
                return self._write(held, outcome, traces)
            except (UnavailableError, OSError) as error:
                LOGGER.warning("the outcome cannot be written yet: %s", error)
                if self._closing.wait(PAUSE_S):
                    return None

    def _write(self, held: Held, outcome: Outcome, traces: Path) -> None:
        if isinstance(outcome, Finished):
            self._store.keep_result(held, outcome.result, traces)
        elif isinstance(outcome, Failed):
            self._store.work.fail(held, outcome.problem)
        elif isinstance(outcome, Died):
            self._store.work.retry_or_fail(held, outcome.problem)
        else:
            self._store.work.hand_back(held)  # after a shutdown; a dismissed job stays dismissed


class Reporter:
    """Write progress to the store: every new stage, fractions so seldom that they cost less than the work."""

    def __init__(self, store: Store, held: Held) -> None:
        self._store, self._held = store, held
        self._stage, self._next = "", 0.0

    def __call__(self, stage: str, fraction: float) -> None:
        """Say how far a job is."""
        if stage == self._stage and time.monotonic() < self._next:
            return
        self._stage, self._next = stage, time.monotonic() + REPORT_EVERY_S
        try:
            self._store.work.report(self._held, stage=stage, fraction=fraction)
        except UnavailableError as error:
            LOGGER.warning("progress is not written: %s", error.reason)
