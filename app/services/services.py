"""Hold what requests need, opened once at the start of the service and closed at its end."""

from dataclasses import dataclass, field
from typing import Annotated

import anyio
from fastapi import Depends, Request

from ..auth.callers import Caller, caller_of
from ..auth.keys import KeyRing
from ..auth.rate_limit import RateLimit
from ..inspection.inspector import Inspector
from ..jobs.executors.executor import Executor
from ..jobs.queue import Queue, Submission
from ..jobs.supervisor import Supervisor
from ..jobs.worker import Worker
from ..kinds.registry import KINDS
from ..problems import Problem
from ..settings import Settings
from ..store.lock import DirectoryLock
from ..store.records import Document, JobRecord, Quota, RobotRecord
from ..store.store import Store, TenantStore
from .batching import Batcher
from .catalogue import Catalogue
from .job_feed import JobFeed
from .metrics import Metrics
from .readiness import Readiness
from .robot_descriptions import built_in_robots
from .workers import executor_of, worker_of


@dataclass(frozen=True)
class RequestContext:
    """Carry what belongs to the tenant of one request; `readers` bounds how many read logs at a time."""

    caller: Caller
    store: TenantStore
    catalogue: Catalogue
    queue: Queue
    readers: anyio.CapacityLimiter
    feed: JobFeed
    batcher: Batcher[Submission, JobRecord]


@dataclass(frozen=True)
class Services:
    """Carry the settings and the parts of the service that requests use.

    `computing` is a worker within this process, or keeps one beside it; None where others compute.
    """

    settings: Settings
    lock: DirectoryLock
    store: Store
    keys: KeyRing
    feed: JobFeed
    batcher: Batcher[Submission, JobRecord]
    rate_limit: RateLimit
    inspector: Inspector
    computing: Worker | Supervisor | None
    metrics: Metrics
    readiness: Readiness
    built_in: dict[str, RobotRecord]
    base_parameters: dict[str, Document] = field(default_factory=dict)

    @classmethod
    def open(
        cls, settings: Settings, metrics: Metrics, executor: Executor | None, supervisor: Supervisor | None
    ) -> "Services":
        """Open the store, and begin to work through the queue where there is something to compute with."""
        lock = DirectoryLock(settings.data_dir)
        quota = Quota(queued=settings.queued_per_tenant, stored_bytes=settings.stored_bytes_per_tenant)
        store = Store(settings.data_dir, settings.database_url, quota=quota)
        store.blobs.remove_leftovers()
        inspector = Inspector()
        built_in = built_in_robots()
        computing: Worker | Supervisor | None = supervisor
        if computing is None and settings.workers:
            chosen = executor or executor_of(settings, store)
            computing = worker_of(store, settings, chosen, built_in, metrics.ended)
        if computing is not None:
            computing.start()
        inspector.prepare()
        for kind in KINDS.values():
            kind.read_example()  # loads what reading options needs, so that no request waits for it

        def alive() -> bool:
            return computing is None or computing.alive

        def ready() -> bool:
            return computing is None or computing.ready.is_set()

        metrics.watch(store, settings, alive)
        readiness = Readiness(store, settings, worker_alive=alive, worker_ready=ready)
        return cls(
            settings=settings,
            lock=lock,
            store=store,
            keys=KeyRing(store.database),
            feed=JobFeed(store.many_jobs),
            batcher=Batcher(computing.wake) if computing else Batcher(),
            rate_limit=RateLimit(settings.requests_per_second),
            inspector=inspector,
            computing=computing,
            metrics=metrics,
            readiness=readiness,
            built_in=built_in,
        )

    def context(self, caller: Caller) -> RequestContext:
        """Open what belongs to the tenant of a request."""
        store = self.store.of(caller.tenant)
        catalogue = Catalogue(store, self.inspector, self.built_in, self.base_parameters)
        queue, readers = Queue(store, catalogue), self.inspector.limiter
        return RequestContext(caller, store, catalogue, queue, readers, self.feed, self.batcher)

    def close(self) -> None:
        """Stop the computations, hand their jobs back, and close the store."""
        if self.computing is not None:
            self.computing.close()
        self.inspector.close()
        self.store.close()
        self.lock.release()


async def _services(request: Request) -> Services:
    services: Services = request.app.state.services
    return services


async def known_caller(request: Request) -> Caller:
    """Find out who asks.

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
        services.rate_limit.count(address)  # limits guesses of keys, too
        raise
    services.rate_limit.count(caller.key.id if caller.key else address)
    return caller


async def context_of(request: Request) -> RequestContext:
    """Open what belongs to the caller.

    Raises
    ------
    Problem
        As `known_caller`.
    """
    services: Services = request.app.state.services
    return services.context(await known_caller(request))


ServicesOf = Annotated[Services, Depends(_services)]
CallerOf = Annotated[Caller, Depends(known_caller)]
ContextOf = Annotated[RequestContext, Depends(context_of)]
