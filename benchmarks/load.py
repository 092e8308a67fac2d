"""Send requests over plain sockets, as many as a service takes: an HTTP library would be slower than it is.

Each connection sends its next request when the last one is answered.
"""

import asyncio
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

import uvloop


@dataclass(frozen=True)
class Load:
    """Hold what came out: answers by their status, the time it took (s), and each answer's latency (s)."""

    statuses: Counter[int]
    seconds: float
    latencies: list[float]

    @property
    def per_second(self) -> float:
        """Give the answers per second."""
        return len(self.latencies) / self.seconds

    def milliseconds(self, share: float) -> float:
        """Give the latency that a share of the answers stayed below, ms."""
        ordered = sorted(self.latencies)
        return 1e3 * ordered[min(int(share * len(ordered)), len(ordered) - 1)]


def send(
    port: int, requests: Iterator[bytes], *, connections: int, seconds: float, pause_s: float = 0.0
) -> Load:
    """Send requests for some time.

    Parameters
    ----------
    requests
        Bytes of the requests, without end.
    pause_s
        Between an answer and the next request of a connection.
    """
    return uvloop.run(_send(port, requests, connections, seconds, pause_s))


def head(method: str, path: str, *, key: str | None = None, body: bytes = b"") -> bytes:
    """Write a request."""
    lines = [f"{method} {path} HTTP/1.1", "Host: localhost"]
    if key:
        lines.append(f"Authorization: Bearer {key}")
    if body:
        lines += ["Content-Type: application/json", f"Content-Length: {len(body)}"]
    return "\r\n".join([*lines, "", ""]).encode() + body


@dataclass
class _Shared:
    requests: Iterator[bytes]
    until: float
    pause_s: float
    statuses: Counter[int] = field(default_factory=Counter)
    latencies: list[float] = field(default_factory=list)


class _Client(asyncio.Protocol):
    def __init__(self, shared: _Shared) -> None:
        self._shared = shared
        self._transport: asyncio.Transport
        self._loop = asyncio.get_running_loop()
        self._received = b""
        self._begun = 0.0
        self.done = self._loop.create_future()

    def connection_made(self, transport: asyncio.Transport) -> None:
        self._transport = transport
        self._next()

    def data_received(self, data: bytes) -> None:
        self._received += data
        length = _length(self._received)
        if length is None or len(self._received) < length:
            return
        now = time.perf_counter()
        self._shared.statuses[int(self._received[9:12])] += 1
        self._shared.latencies.append(now - self._begun)
        self._received = b""
        if now >= self._shared.until:
            self._transport.close()
        elif self._shared.pause_s:
            self._loop.call_later(self._shared.pause_s, self._next)
        else:
            self._next()

    def connection_lost(self, _: Exception | None) -> None:
        if not self.done.done():
            self.done.set_result(None)

    def _next(self) -> None:
        self._begun = time.perf_counter()
        self._transport.write(next(self._shared.requests))


def _length(answer: bytes) -> int | None:
    """Give the length of a whole answer with its head; None where the head is not there yet."""
    end = answer.find(b"\r\n\r\n")
    if end < 0:
        return None
    start = answer.lower().find(b"content-length:", 0, end)
    return end + 4 + (int(answer[start + 15 : answer.find(b"\r\n", start)]) if start >= 0 else 0)


async def _send(
    port: int, requests: Iterator[bytes], connections: int, seconds: float, pause_s: float
) -> Load:
    begun = time.perf_counter()
    shared = _Shared(requests, begun + seconds, pause_s)
    loop = asyncio.get_running_loop()
    clients = [
        (await loop.create_connection(lambda: _Client(shared), "127.0.0.1", port))[1]
        for _ in range(connections)
    ]
    await asyncio.gather(*(client.done for client in clients))
    return Load(shared.statuses, time.perf_counter() - begun, shared.latencies)
