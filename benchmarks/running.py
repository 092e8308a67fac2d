"""Run the service beside a benchmark, with a key, a robot and a log in it."""

import json
import os
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

LOG = Path(__file__).parents[1] / "examples" / "yumi" / "log.csv"
KERNELS = Path(__file__).parents[1] / "data" / "kernels"  # where `make serve` keeps them, too, and the tests
ROBOT = "yumi-left"
START_S = 180.0


@dataclass(frozen=True)
class Running:
    """Know where a service listens, a key for it, and a log that it has."""

    port: int
    key: str
    log: str
    process: int

    def ask(self, method: str, path: str, body: object = None, **headers: str) -> dict[str, Any]:
        """Send one request with the key, and give the document that comes back."""
        content = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        return _ask(self.port, method, path, content, {"Authorization": f"Bearer {self.key}"} | named)

    def job(self, **options: object) -> dict[str, object]:
        """Write the request of a job."""
        return {"kind": "identify", "robot": ROBOT, "logs": [self.log], "options": options}


_shared: tuple[ExitStack, dict[str, Running]] | None = None


@contextmanager
def shared_services() -> Iterator[None]:
    """Let benchmarks with equal settings use one service, where it is not their figures that are wanted."""
    global _shared  # noqa: PLW0603  # benchmarks start their services themselves
    with ExitStack() as running:
        _shared = (running, {})
        try:
            yield
        finally:
            _shared = None


@contextmanager
def running_service(**settings: object) -> Iterator[Running]:
    """Start the service in a directory of its own, and stop it afterwards."""
    if _shared is None:
        with _started(settings) as service:
            yield service
        return
    running, known = _shared
    name = repr(sorted(settings.items()))
    if name not in known:
        known[name] = running.enter_context(_started(settings))
    yield known[name]


@contextmanager
def _started(settings: dict[str, object]) -> Iterator[Running]:
    with tempfile.TemporaryDirectory() as directory, socket.create_server(("127.0.0.1", 0)) as listener:
        port = int(listener.getsockname()[1])
        listener.close()
        chosen = {"port": port, "data_dir": directory, "requests_per_second": 1e6, "queued_per_tenant": 10**6}
        environment = {
            f"VERITORQUE_{name.upper()}": str(value) for name, value in (chosen | settings).items()
        }
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(KERNELS), **environment}
        command = [sys.executable, "-m", "veritorque"]
        made = subprocess.run(
            [*command, "keys", "create", "bench"], env=environment, check=True, capture_output=True, text=True
        )
        process = subprocess.Popen(
            [*command, "serve"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        try:
            _await(port, process)
            yield _filled(port, made.stdout.strip(), process.pid)
        finally:
            process.terminate()
            process.wait(30.0)


def _filled(port: int, key: str, process: int) -> Running:
    content, headers = LOG.read_bytes(), {"Content-Type": "text/csv", "Authorization": f"Bearer {key}"}
    log = _ask(port, "POST", "/v1/logs?name=log.csv", content, headers)
    return Running(port, key, str(log["id"]), process)


def _await(port: int, process: "subprocess.Popen[bytes]") -> None:
    deadline = time.monotonic() + START_S
    while time.monotonic() < deadline and process.poll() is None:
        try:
            _ask(port, "GET", "/readyz", None, {})
        except OSError:
            time.sleep(0.1)
        else:
            return
    raise RuntimeError("the service did not start")


def _ask(port: int, method: str, path: str, body: bytes | None, headers: dict[str, str]) -> dict[str, Any]:
    if body is not None:
        headers = {"Content-Type": "application/json"} | headers
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}{path}", data=body, method=method, headers=headers
    )
    with urllib.request.urlopen(request, timeout=120.0) as answer:  # noqa: S310  # our own server
        return dict(json.loads(answer.read() or b"{}"))
