"""Following a job by polling it with a key on 16 connections, at rest and while every core solves.

Beside it stands /healthz, which asks for nothing, in the same run.
"""

import itertools
import os

from benchmarks.figures import Figure
from benchmarks.load import Load, head, send
from benchmarks.running import Running, running_service

CONNECTIONS = 16


def run(*, quick: bool) -> list[Figure]:
    """Poll for some seconds each."""
    seconds = 0.2 if quick else 10.0
    with running_service(workers=0) as idle:
        job = idle.ask("POST", "/v1/jobs", idle.job())["id"]
        alive = send(
            idle.port, itertools.repeat(head("GET", "/healthz")), connections=CONNECTIONS, seconds=seconds
        )
        rest = _poll(idle, job, seconds)
    cores = 1 if quick else os.cpu_count() or 1
    with running_service(workers=cores) as busy:
        draws, count = (20, cores) if quick else (1000, 10 * cores)
        jobs = [
            busy.ask("POST", "/v1/jobs", busy.job(bootstrap={"draws": draws - n}))["id"] for n in range(count)
        ]
        solving = _poll(busy, jobs[0], seconds)
        for one in jobs:
            busy.ask("DELETE", f"/v1/jobs/{one}")
    return [
        *_figures("at rest", rest, "" if quick else ">= 2500", "<= 25", alive),
        *_figures(f"while {cores} jobs compute", solving, "" if quick else ">= 300", "<= 150", None),
        Figure(
            "requests a second over those of /healthz",
            f"{rest.per_second / alive.per_second:.2f}",
            ratio=True,
        ),
    ]


def _poll(service: Running, job: str, seconds: float) -> Load:
    request = head("GET", f"/v1/jobs/{job}", key=service.key)
    load = send(service.port, itertools.repeat(request), connections=CONNECTIONS, seconds=seconds)
    if set(load.statuses) != {200}:
        raise RuntimeError(f"not every answer was good: {dict(load.statuses)}")
    return load


def _figures(when: str, load: Load, rate: str, latency: str, beside: Load | None) -> list[Figure]:
    peer = f"/healthz {beside.per_second:.0f}" if beside else ""
    return [
        Figure(f"requests a second {when}", f"{load.per_second:.0f}", rate, peer),
        Figure(f"99 % of them {when}, ms", f"{load.milliseconds(0.99):.1f}", latency),
    ]
