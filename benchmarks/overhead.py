"""What the service adds to a computation: a job that is waited for, and the same by the library, in turns.

Both read the log from its file, and write the result's traces beside it.
Between them the service comes to rest, so that neither pays for the other. Beside it stand jobs that wait for
each other, asked for all at once.
"""

import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from benchmarks.demo_log import demo_robot
from benchmarks.figures import Figure
from benchmarks.running import LOG, Running, running_service
from veritorque.core.log.reader import read_log
from veritorque.core.study import IdentifyRequest, identify

REST_S = 1.0
OPTIONS: dict[str, object] = {"bootstrap": {"draws": 0}}


def run(*, quick: bool) -> list[Figure]:
    """Compute the same log again and again, each time with another cut-off, so that nothing is known yet."""
    repeats = 1 if quick else 20
    _by_library(9.0)
    served, computed = [], []
    with running_service(workers=1) as service:
        _seconds(lambda: service.ask("POST", "/v1/jobs", service.job(**_options(9.0)), Prefer="wait=60"))
        for number in range(repeats):
            cutoff = 10.0 + 0.01 * number
            time.sleep(REST_S)
            computed.append(_seconds(lambda cutoff=cutoff: _by_library(cutoff)))
            body = service.job(**_options(cutoff))
            served.append(_seconds(lambda body=body: service.ask("POST", "/v1/jobs", body, Prefer="wait=60")))
        queued = _seconds(lambda: _all_at_once(service, repeats)) / repeats
    library = statistics.median(computed)
    added = statistics.median(one - other for one, other in zip(served, computed, strict=True))
    return [
        Figure(
            "added to a job, ms",
            f"{1e3 * added:.0f}",
            "" if quick else "<= 50",
            f"library {1e3 * library:.0f}",
        ),
        Figure("a job over the library's call", f"{statistics.median(served) / library:.2f}", ratio=True),
        Figure("a job among many over the library's call", f"{queued / library:.2f}", ratio=True),
    ]


def _all_at_once(service: Running, count: int) -> None:
    jobs = [service.job(**_options(20.0 + 0.01 * number)) for number in range(count)]
    for job in [service.ask("POST", "/v1/jobs", job)["id"] for job in jobs]:
        while service.ask("GET", f"/v1/jobs/{job}")["state"] != "successful":
            time.sleep(0.01)


def _options(cutoff_hz: float) -> dict[str, object]:
    return OPTIONS | {"filter": {"cutoff_hz": cutoff_hz}}


def _by_library(cutoff_hz: float) -> None:
    with tempfile.TemporaryDirectory() as folder:
        traces = Path(folder) / "traces.parquet"
        identify(IdentifyRequest(demo_robot(), (read_log(LOG),), _options(cutoff_hz), traces=traces))


def _seconds(work: Callable[[], object]) -> float:
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun
