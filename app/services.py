"""Hold what requests need, opened once at the start of the service and closed at its end."""

from dataclasses import dataclass, field
from typing import Annotated

import anyio
from fastapi import Depends, Request

from app.callers import Caller, caller_of
from app.catalogue import Catalogue, built_in_robots
from app.feed import JobFeed
from app.inspection.inspector import Inspector
from app.intake import Intake
from app.jobs import science
from app.jobs.executor import Executor, ProcessExecutor
from app.jobs.queue import Queue
from app.jobs.supervisor import Supervisor
from app.jobs.worker import Worker
from app.keys import KeyRing
from app.pace import Pace
from app.problems import Problem
from app.settings import Settings
from app.store.lock import DirectoryLock
from app.store.records import Document, JobRecord, Quota, RobotRecord
from app.store.store import Store, TenantStore


@dataclass(frozen=True)
class Desk:
    """Carry what belongs to the tenant of one request; `readers` bounds how many read logs at a time."""

    caller: Caller
    store: TenantStore
    catalogue: Catalogue
    queue: Queue
    readers: anyio.CapacityLimiter
    feed: JobFeed
    intake: Intake[JobRecord]


@dataclass(frozen=True)
class Services:
    """Carry the settings and the parts of the service that requests use.

    `worker` computes within this process, `supervisor` keeps one beside it; None where others do.
    """

    settings: Settings
    lock: DirectoryLock
    store: Store
    keys: KeyRing
    feed: JobFeed
    intake: Intake[JobRecord]
    pace: Pace
    worker: Worker | None
    supervisor: Supervisor | None
    inspector: Inspector
    built_in: dict[str, RobotRecord]
    base_parameters: dict[str, Document] = field(default_factory=dict)

    @classmethod
    def open(cls, settings: Settings, executor: Executor | None, supervisor: Supervisor | None) -> "Services":
        """Open the store, and begin to work through the queue where there is something to compute with."""
        lock = DirectoryLock(settings.data_dir)
        quota = Quota(queued=settings.queued_per_tenant, stored_bytes=settings.stored_bytes_per_tenant)
        store = Store(settings.data_dir, settings.database_url, quota=quota)
        store.blobs.remove_leftovers()
        inspector = Inspector()
        built_in = built_in_robots()
        worker = None
        if supervisor is None and settings.workers:
            worker = worker_of(store, settings, executor or ProcessExecutor(), built_in)
        for computing in (worker, supervisor):
            if computing is not None:
                computing.start()
        inspector.prepare()
        science.check_options("identify", {})  # loads what that needs, so that no request waits for it
        return cls(
            settings=settings,
            lock=lock,
            store=store,
            keys=KeyRing(store.database),
            feed=JobFeed(store.many_jobs),
            intake=Intake(),
            pace=Pace(settings.requests_per_second),
            worker=worker,
            supervisor=supervisor,
            inspector=inspector,
            built_in=built_in,
        )

    @property
    def ready(self) -> bool:
        """Tell whether whoever computes has loaded the solver."""
        computing = self.worker or self.supervisor
        return computing is None or computing.ready.is_set()

    def desk(self, caller: Caller) -> Desk:
        """Open what belongs to the tenant of a request."""
        store = self.store.of(caller.tenant)
        catalogue = Catalogue(store, self.inspector, self.built_in, self.base_parameters)
        queue, readers = Queue(store), self.inspector.limiter
        return Desk(caller, store, catalogue, queue, readers, self.feed, self.intake)

    def close(self) -> None:
        """Stop the computations, hand their jobs back, and close the store."""
        for computing in (self.worker, self.supervisor):
            if computing is not None:
                computing.close()
        self.store.close()
        self.lock.release()


def worker_of(
    store: Store, settings: Settings, executor: Executor, built_in: dict[str, RobotRecord]
) -> Worker:
    """Make a worker as the settings ask for it."""
    return Worker(
        store,
        executor,
        robots={identity: robot.description for identity, robot in built_in.items()},
        slots=settings.workers,
        most_per_tenant=settings.running_per_tenant,
        timeout_s=settings.job_timeout_s,
    )


async def _services(request: Request) -> Services:
    services: Services = request.app.state.services
    return services


async def desk_of(request: Request) -> Desk:
    """Open what belongs to whoever asks.

    Raises
    ------
    Problem
        If the request may not be answered to them, or not yet (401, 403, 429).
    """
    services: Services = request.app.state.services
    if not services.keys.fresh:
        await anyio.to_thread.run_sync(services.keys.read)
    address = request.client.host if request.client else ""
    try:
        caller = caller_of(request, services.keys, open_to_all=not services.settings.needs_keys)
    except Problem:
        services.pace.keep(address)  # whoever guesses keys is held up, too
        raise
    services.pace.keep(caller.key.id if caller.key else address)
    return services.desk(caller)


ServicesOf = Annotated[Services, Depends(_services)]
DeskOf = Annotated[Desk, Depends(desk_of)]
