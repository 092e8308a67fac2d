"""Run the service for as long as a demonstration needs it, on loopback and a free port, and always stop it.

It runs in a process group of its own, so that Ctrl-C ends the demonstration first, which then ends the
service in order.
"""

import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from veritorque.app.client.client import Client
from veritorque.app.client.errors import ServiceError

ROOT: Final = Path(__file__).parents[2]
START_SECONDS: Final = 180.0
STOP_SECONDS: Final = 15.0


def free_port() -> int:
    """Find a port that nobody listens on at the moment."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


@contextmanager
def running_service(data_dir: Path) -> Iterator[Client]:
    """Start the service with its data in a directory, give a client for it, and stop it afterwards."""
    data_dir.mkdir(parents=True, exist_ok=True)
    journal = data_dir / "service.log"
    port = free_port()
    command = [
        sys.executable,
        "-m",
        "veritorque",
        "serve",
        "--port",
        str(port),
        "--data-dir",
        str(data_dir.resolve()),
    ]
    with journal.open("w", encoding="utf-8") as output:
        process = subprocess.Popen(
            command, cwd=ROOT, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
        )
    try:
        with Client(f"http://127.0.0.1:{port}") as client:
            _await(client, process, journal)
            yield client
    finally:
        _stop(process)


def _await(client: Client, process: "subprocess.Popen[bytes]", journal: Path) -> None:
    deadline = time.monotonic() + START_SECONDS
    while not client.is_alive():
        if process.poll() is not None or time.monotonic() > deadline:
            last = journal.read_text(encoding="utf-8", errors="replace").strip().splitlines()[-3:]
            raise ServiceError(
                "the service did not start",
                evidence={"exit_status": process.poll(), "last_words": " / ".join(last)},
                remedy=f"read {journal}",
            )
        time.sleep(0.1)


def _stop(process: "subprocess.Popen[bytes]") -> None:
    process.terminate()
    try:
        process.wait(STOP_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
