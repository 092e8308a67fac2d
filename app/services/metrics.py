"""Count and time what the service does, in the form that Prometheus reads.

Labels take few values each: a route's template and not the path, the kind of a problem and not its cause.
What the database knows is read at every scrape, so that it stays right over restarts and with any number of
workers.
"""

import shutil
from collections.abc import Callable, Iterator

from prometheus_client import CollectorRegistry, Counter, Histogram, ProcessCollector
from prometheus_client.core import GaugeMetricFamily, InfoMetricFamily, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector

from ..jobs.computation import Ended
from ..settings import Settings
from ..store.records import STATES
from ..store.store import Store
from ..version import VERSION

METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")
REQUEST_SECONDS = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0, 60.0)
JOB_SECONDS = (0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 25.0, 60.0, 150.0, 300.0, 600.0, 1800.0)


class Metrics:
    """Keep the figures of one service."""

    def __init__(self) -> None:
        self._registry = CollectorRegistry()
        ProcessCollector(registry=self._registry)
        self._requests = Histogram(
            "veritorque_http_request_duration_seconds",
            "From the request's head to the end of the answer.",
            ["method", "route", "status"],
            buckets=REQUEST_SECONDS,
            registry=self._registry,
        )
        self._jobs = Histogram(
            "veritorque_job_duration_seconds",
            "From the taking of a job to its outcome: successful, failed, died or stopped.",
            ["kind", "outcome"],
            buckets=JOB_SECONDS,
            registry=self._registry,
        )
        self._problems = Counter(
            "veritorque_job_problems_total",
            "Computations without a result, by the kind of their problem.",
            ["problem"],
            registry=self._registry,
        )

    def answered(self, *, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request."""
        known = method if method in METHODS else "other"
        self._requests.labels(known, route, str(status)).observe(seconds)

    def ended(self, job: Ended) -> None:
        """Count a computation."""
        self._jobs.labels(job.kind, job.outcome).observe(job.seconds)
        if job.problem is not None:
            self._problems.labels(job.problem).inc()

    def watch(self, store: Store, settings: Settings, worker_alive: Callable[[], bool]) -> None:
        """Measure the store, the disk and the worker at every scrape."""
        self._registry.register(_Now(store, settings, worker_alive))

    def written(self, accept: str) -> tuple[bytes, str]:
        """Write all figures in the form that is asked for, and name the form."""
        encode, media_type = choose_encoder(accept)
        return encode(self._registry), media_type


class _Now(Collector):
    """Give what is measured when it is asked for."""

    def __init__(self, store: Store, settings: Settings, worker_alive: Callable[[], bool]) -> None:
        self._store, self._settings, self._worker_alive = store, settings, worker_alive

    def describe(self) -> Iterator[Metric]:
        """Name nothing ahead, so that registering does not ask the database."""
        return iter(())

    def collect(self) -> Iterator[Metric]:
        """Measure."""
        counts = self._store.work.count()
        jobs = GaugeMetricFamily("veritorque_jobs", "Jobs that are kept, by state.", labels=["state"])
        for state in STATES:
            jobs.add_metric([state], counts.get(state, 0))
        yield jobs
        yield GaugeMetricFamily(
            "veritorque_queue_depth", "Jobs that wait for a worker.", value=counts.get("accepted", 0)
        )
        yield GaugeMetricFamily(
            "veritorque_worker_alive",
            "1 while a worker of this service has responded lately, or others compute.",
            value=float(self._worker_alive()),
        )
        yield GaugeMetricFamily(
            "veritorque_disk_free_bytes",
            "Space left where logs and results are kept.",
            value=shutil.disk_usage(self._settings.data_dir).free,
        )
        yield GaugeMetricFamily(
            "veritorque_disk_reserve_bytes",
            "Space below which nothing more is accepted.",
            value=self._settings.disk_reserve_bytes,
        )
        yield InfoMetricFamily("veritorque_build", "What runs.", value={"version": VERSION})
