"""Take waiting jobs from the store and see each to its end, even past a restart of the service.

One thread per computation that may run at the same time; the computing itself happens in the executor's
processes.
"""

import logging
import threading
import time

from app.jobs.computation import Computation, Failed, Finished, LogFile, Outcome
from app.jobs.executor import Executor
from app.jobs.references import reference_file
from app.jobs.worker import mistake
from app.problems import Problem, problem_of
from app.store.records import Document, JobRecord
from app.store.store import Store
from core.errors import VeritorqueError

LOGGER = logging.getLogger(__name__)
LOOK_EVERY_S = 1.0
REPORT_EVERY_S = 0.2


class Runner:
    """Work through the queue.

    Parameters
    ----------
    store
        Where jobs wait and results go.
    executor
        What computes.
    robots
        Descriptions of the built-in robots by id.
    workers
        Jobs at the same time.
    timeout_s
        Longest a job may compute, s.
    """

    def __init__(
        self, store: Store, executor: Executor, *, robots: dict[str, Document], workers: int, timeout_s: float
    ) -> None:
        self._store, self._executor, self._robots, self._timeout_s = store, executor, robots, timeout_s
        self._wake = threading.Semaphore(0)
        self._closing = threading.Event()
        self._stops: dict[str, threading.Event] = {}
        self._threads = [threading.Thread(target=self._serve, name=f"job-{n}") for n in range(workers)]
        self.ready = threading.Event()

    def start(self) -> None:
        """Take up what was left, and begin to work."""
        self._store.jobs.recover(_crashed().document())
        for thread in (*self._threads, threading.Thread(target=self._prepare, name="prepare", daemon=True)):
            thread.start()

    def close(self) -> None:
        """Stop all computations, queue their jobs again, and wait for the threads."""
        self._closing.set()
        for stop in list(self._stops.values()):
            stop.set()
        self._wake.release(len(self._threads))
        for thread in self._threads:
            thread.join()

    def wake(self) -> None:
        """Say that a job waits."""
        self._wake.release()

    def stop(self, job_id: str) -> None:
        """Stop a job's computation where it runs; its state is the caller's business."""
        stop = self._stops.get(job_id)
        if stop is not None:
            stop.set()

    def _prepare(self) -> None:
        try:
            self._executor.prepare()
        except Exception:
            LOGGER.exception("the solver could not be loaded ahead; the first job will try again")
        self.ready.set()

    def _serve(self) -> None:
        while not self._closing.is_set():
            job = self._store.jobs.claim()
            if job is None:
                self._wake.acquire(timeout=LOOK_EVERY_S)
            else:
                self._see_through(job)

    def _see_through(self, job: JobRecord) -> None:
        stop = self._stops[job.id] = threading.Event()
        try:
            outcome = self._outcome(job, stop)
        except VeritorqueError as error:
            outcome = Failed(problem_of(error).document())
        except Problem as problem:
            outcome = Failed(problem.document())
        except Exception:
            LOGGER.exception("job %s met a mistake of ours", job.id)
            outcome = Failed(mistake().document())
        finally:
            del self._stops[job.id]
        self._settle(job.id, outcome)

    def _outcome(self, job: JobRecord, stop: threading.Event) -> Outcome:
        computation = self._computation(job)
        now = self._store.jobs.get(job.id)
        if now is None or now.state != "running" or self._closing.is_set():
            stop.set()  # it was dismissed before it could be told
        progress = _Reporter(self._store, job.id)
        return self._executor.run(computation, progress=progress, stop=stop, timeout_s=self._timeout_s)

    def _settle(self, job_id: str, outcome: Outcome) -> None:
        if isinstance(outcome, Finished):
            self._store.keep_result(job_id, outcome.result)
        elif isinstance(outcome, Failed):
            self._store.jobs.fail(job_id, outcome.problem)
        else:
            self._store.jobs.put_back(job_id)  # after a shutdown; a dismissed job stays dismissed

    def _computation(self, job: JobRecord) -> Computation:
        robot = self._store.robots.get(job.request.robot)
        description = robot.description if robot else self._robots.get(job.request.robot)
        if description is None:
            raise _gone("robot", job.request.robot)
        return Computation(
            kind=job.request.kind,
            robot=description,
            logs=tuple(self._log_file(identity) for identity in job.request.logs),
            options=job.request.options,
            reference=reference_file(self._store, job.request.kind, job.request.options),
        )

    def _log_file(self, identity: str) -> LogFile:
        log = self._store.logs.get(identity)
        if log is None:
            raise _gone("log", identity)
        mapping = log.summary["mapping"]
        return LogFile(
            path=self._store.blobs.path(log.sha256),
            name=str(log.summary["name"]),
            mapping=mapping if isinstance(mapping, dict) else None,
            sha256=log.sha256,
        )


class _Reporter:
    """Write progress to the store: every new stage, and fractions a few times a second."""

    def __init__(self, store: Store, job_id: str) -> None:
        self._store, self._job_id = store, job_id
        self._stage, self._next = "", 0.0

    def __call__(self, stage: str, fraction: float) -> None:
        if stage == self._stage and time.monotonic() < self._next:
            return
        self._stage, self._next = stage, time.monotonic() + REPORT_EVERY_S
        self._store.jobs.report(self._job_id, stage=stage, fraction=fraction)


def _gone(what: str, identity: str) -> Problem:
    return Problem(
        "not-found",
        f"the {what} {identity} was deleted while the job waited",
        evidence={what: identity},
        remedy="create it again and ask for the job again",
    )


def _crashed() -> Problem:
    return Problem(
        "computation-stopped",
        "the service stopped several times while it computed this job",
        remedy="shorten the log or raise the decimation; the service's own log may say more",
    )
