"""Make what computes, as the settings ask for; a worker process loads nothing of what answers requests."""

from collections.abc import Callable
from functools import partial

from ..jobs.computation import Ended
from ..jobs.executors.executor import Executor
from ..jobs.executors.limits import Limits
from ..jobs.executors.process_executor import ProcessExecutor
from ..jobs.rehearsal import rehearse
from ..jobs.worker import Capacity, Worker
from ..settings import Settings
from ..store.records import RobotRecord
from ..store.store import Store


def executor_of(settings: Settings, store: Store) -> Executor:
    """Make the executor by the settings; it rehearses with scratch files of the store."""
    limits = Limits(settings.job_memory_bytes, settings.job_cpus)
    return ProcessExecutor(limits=limits, rehearse=partial(rehearse, store.blobs), at_once=settings.workers)


def worker_of(
    store: Store,
    settings: Settings,
    executor: Executor,
    built_in: dict[str, RobotRecord],
    on_ended: Callable[[Ended], None] | None,
) -> Worker:
    """Make a worker by the settings; `on_ended` is called with the outcome of every computation."""
    return Worker(
        store,
        executor,
        robots={identity: robot.description for identity, robot in built_in.items()},
        capacity=Capacity(
            slots=settings.workers,
            most_per_tenant=settings.running_per_tenant,
            timeout_s=settings.job_timeout_s,
            retention_days=settings.retention_days,
        ),
        on_ended=on_ended,
    )
