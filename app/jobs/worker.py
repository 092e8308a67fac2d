"""Take waiting jobs from the store and see each to its end, whatever happens meanwhile.

One thread per computation that may run at the same time, which computes in the executor's processes; one more
shows that this worker lives, notices what was dismissed, and looks after the jobs of workers that died. A
worker runs within the service or in a process of its own, as many of them as one likes.
"""

import logging
import threading
import time

from app.jobs.child import mistake
from app.jobs.computation import Computation, Died, Failed, Finished, LogFile, Outcome
from app.jobs.executor import Executor
from app.jobs.lives import Lives
from app.jobs.presence import Presence
from app.jobs.references import reference_file
from app.problems import Problem, problem_of
from app.store.errors import Unavailable
from app.store.records import Document, JobRecord
from app.store.store import Store
from app.store.sweep import Sweep
from core.errors import VeritorqueError

LOGGER = logging.getLogger(__name__)
LOOK_EVERY_S = 0.02
WATCH_EVERY_S = 0.1
BEAT_EVERY_S = 2.0
SWEEP_EVERY_S = 60.0
REPORT_EVERY_S = 0.2
PAUSE_S = 1.0
"""Time to wait where the database does not answer."""


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
    slots
        Jobs at the same time.
    most_per_tenant
        Of these, jobs of one tenant.
    timeout_s
        Longest a job may compute, s.
    """

    def __init__(
        self,
        store: Store,
        executor: Executor,
        *,
        robots: dict[str, Document],
        slots: int,
        most_per_tenant: int,
        timeout_s: float,
    ) -> None:
        self._store, self._executor, self._robots = store, executor, robots
        self._timeout_s, self._most_per_tenant = timeout_s, most_per_tenant
        self._presence = Presence(store.directory / "workers")
        self._lives, self._sweep = Lives(store, self._presence), Sweep(store)
        self._closing = threading.Event()
        self._stops: dict[tuple[str, int], threading.Event] = {}
        self._threads = [threading.Thread(target=self._serve, name=f"job-{n}") for n in range(slots)]
        self._threads.append(threading.Thread(target=self._watch, name="watch"))
        self.ready = threading.Event()

    def start(self) -> None:
        """Begin to work."""
        for thread in (*self._threads, threading.Thread(target=self._prepare, name="prepare", daemon=True)):
            thread.start()

    def close(self) -> None:
        """Stop all computations, hand their jobs back, and wait for the threads."""
        self._closing.set()
        for stop in list(self._stops.values()):
            stop.set()
        for thread in self._threads:
            thread.join()
        self._presence.leave()

    def _prepare(self) -> None:
        try:
            self._executor.prepare()
        except Exception:
            LOGGER.exception("the solver could not be loaded ahead; the first job will try again")
        self.ready.set()

    def _serve(self) -> None:
        while not self._closing.is_set():
            try:
                job = self._store.work.claim(self._presence.name, most_per_tenant=self._most_per_tenant)
                if job is None:
                    self._closing.wait(LOOK_EVERY_S)
                else:
                    self._see_through(job)
            except Unavailable as error:
                LOGGER.warning("the database does not answer: %s", error.reason)
                self._closing.wait(PAUSE_S)

    def _watch(self) -> None:
        beat = sweep = time.monotonic()
        while not self._closing.wait(WATCH_EVERY_S):
            now = time.monotonic()
            try:
                self._stop_what_is_lost()
                if now >= beat:
                    self._store.work.beat(self._presence.name)
                    self._lives.look()
                    beat = now + BEAT_EVERY_S
                if now >= sweep:
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

    def _see_through(self, job: JobRecord) -> None:
        held = (job.id, job.token)
        stop = self._stops[held] = threading.Event()
        try:
            outcome = self._outcome(job, stop)
        except VeritorqueError as error:
            outcome = Failed(problem_of(error).document())
        except Problem as problem:
            outcome = Failed(problem.document())
        except Unavailable:
            raise
        except Exception:
            LOGGER.exception("job %s met a mistake of ours", job.id)
            outcome = Failed(mistake().document())
        finally:
            del self._stops[held]
        self._settle(held, outcome)

    def _outcome(self, job: JobRecord, stop: threading.Event) -> Outcome:
        computation = self._computation(job)
        if self._closing.is_set():
            stop.set()
        progress = _Reporter(self._store, (job.id, job.token))
        return self._executor.run(computation, progress=progress, stop=stop, timeout_s=self._timeout_s)

    def _settle(self, held: tuple[str, int], outcome: Outcome) -> None:
        """Write the outcome down, however long the database takes to answer."""
        while True:
            try:
                return self._settled(held, outcome)
            except Unavailable as error:
                LOGGER.warning("the outcome of %s waits for the database: %s", held[0], error.reason)
                if self._closing.wait(PAUSE_S):
                    return None

    def _settled(self, held: tuple[str, int], outcome: Outcome) -> None:
        if isinstance(outcome, Finished):
            self._store.keep_result(held, outcome.result)
        elif isinstance(outcome, Failed):
            self._store.work.fail(held, outcome.problem)
        elif isinstance(outcome, Died):
            self._store.work.bury(held, outcome.problem)
        else:
            self._store.work.hand_back(held)  # after a shutdown; a dismissed job stays dismissed

    def _computation(self, job: JobRecord) -> Computation:
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
        )


class _Reporter:
    """Write progress to the store: every new stage, and fractions a few times a second."""

    def __init__(self, store: Store, held: tuple[str, int]) -> None:
        self._store, self._held = store, held
        self._stage, self._next = "", 0.0

    def __call__(self, stage: str, fraction: float) -> None:
        if stage == self._stage and time.monotonic() < self._next:
            return
        self._stage, self._next = stage, time.monotonic() + REPORT_EVERY_S
        try:
            self._store.work.report(self._held, stage=stage, fraction=fraction)
        except Unavailable as error:
            LOGGER.warning("progress of %s is not written: %s", self._held[0], error.reason)


def _gone(what: str, identity: str) -> Problem:
    return Problem(
        "not-found",
        f"the {what} {identity} was deleted while the job waited",
        evidence={what: identity},
        remedy="create it again and ask for the job again",
    )
