"""Five hundred connections that stop in the middle of a request, and the others meanwhile."""

import asyncio
import itertools
import threading
import time

from benchmarks.figures import Figure
from benchmarks.load import Load, head, send
from benchmarks.running import running_service

STUCK = 500


def run(*, quick: bool) -> list[Figure]:
    """Open them, poll beside them until the last is dropped, and poll again."""
    stuck = 20 if quick else STUCK
    with running_service(workers=0) as service:
        request = head("GET", "/v1/jobs?limit=1", key=service.key)

        def others(seconds: float) -> Load:
            requests = itertools.repeat(request)
            return send(service.port, requests, connections=4, seconds=seconds, pause_s=0.01)

        dropped: list[float] = []
        holding = threading.Thread(target=lambda: dropped.extend(asyncio.run(_hold(service.port, stuck))))
        holding.start()
        during = others(0.2 if quick else 8.0)
        holding.join()
        alone = others(0.2 if quick else 8.0)
    return [
        Figure(
            f"99 % of the others' requests beside {stuck}, ms", f"{during.milliseconds(0.99):.1f}", "<= 50"
        ),
        Figure("dropped", f"{len(dropped)}", f"{stuck}"),
        Figure("the last of them after, s", f"{max(dropped):.1f}", "<= 10"),
        Figure(
            "99 % beside them over 99 % alone",
            f"{during.milliseconds(0.99) / alone.milliseconds(0.99):.2f}",
            ratio=True,
        ),
    ]


async def _hold(port: int, count: int) -> list[float]:
    return list(await asyncio.gather(*(_stop_in_the_middle(port, number) for number in range(count))))


async def _stop_in_the_middle(port: int, number: int) -> float:
    """Send part of a request in one of three ways, and give how long the service bears it, s."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    begun = time.monotonic()
    beginnings = (
        b"",
        b"GET /v1/jobs HTTP/1.1\r\nHost: local",
        b"POST /v1/robots HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9999\r\n\r\n{",
    )
    writer.write(beginnings[number % 3])
    await reader.read()
    writer.close()
    return time.monotonic() - begun
