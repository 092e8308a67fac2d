"""Asking for jobs that differ, each on the disk before it is answered, on 32 connections.

Beside it stands how often this disk can be made to keep one write: more requests than that share writes.
"""

import itertools
import json
import os
import tempfile
import time
from collections.abc import Iterator

from benchmarks.figures import Figure
from benchmarks.load import head, send
from benchmarks.running import Running, running_service

CONNECTIONS = 32


def run(*, quick: bool) -> list[Figure]:
    """Ask for some seconds."""
    seconds = 0.2 if quick else 5.0
    syncs = syncs_per_second(seconds / 5.0)
    with running_service(workers=0) as service:
        service.ask("POST", "/v1/jobs", service.job())  # what is loaded at the first request is loaded
        before = len(service.ask("GET", "/v1/jobs?limit=1000")["jobs"])
        load = send(service.port, _requests(service), connections=CONNECTIONS, seconds=seconds)
        kept = service.ask("GET", "/v1/jobs?limit=1000")["jobs"]
    if set(load.statuses) != {202} or len(kept) != min(len(load.latencies) + before, 1000):
        raise RuntimeError(f"not every job was accepted: {dict(load.statuses)}")
    return [
        Figure(
            "jobs accepted a second",
            f"{load.per_second:.0f}",
            "" if quick else ">= 1000",
            f"syncs of the disk {syncs:.0f}",
        ),
        Figure("99 % of them, ms", f"{load.milliseconds(0.99):.1f}", "<= 50"),
        Figure("jobs over syncs of the disk", f"{load.per_second / syncs:.2f}", ratio=True),
    ]


def syncs_per_second(seconds: float) -> float:
    """Count how often a small write reaches the disk."""
    with tempfile.TemporaryFile() as file:
        begun, count = time.perf_counter(), 0
        while (spent := time.perf_counter() - begun) < seconds:
            file.write(bytes(4096))
            file.flush()
            os.fsync(file.fileno())
            count += 1
    return count / spent


def _requests(service: Running) -> Iterator[bytes]:
    for number in itertools.count():
        body = json.dumps(service.job(filter={"cutoff_hz": 5.0 + 1e-4 * number})).encode()
        yield head("POST", "/v1/jobs", key=service.key, body=body)
