"""An upload of 20 MB against bare streaming endpoints in the same run, and the memory of eight at once.

The bytes are refused as no log once all are there, by the first of them, so that receiving is measured:
streaming, hashing and writing. What a client waits for a sound log until it is kept depends on the log, which
is read by a process of its own and then synced to the disk, and stands below.
"""

import http.client
import io
import re
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.figures import Figure

SIZE = 20 * 1024**2
AT_ONCE = 8
START_S = 30.0


def run(*, quick: bool) -> list[Figure]:
    """Send the same bytes to each endpoint in turn, several times."""
    rounds, rushes = (2, 1) if quick else (25, 3)
    noise = bytes(64) + np.random.default_rng(1).bytes(SIZE - 64)
    with tempfile.TemporaryDirectory() as folder:
        service = ["veritorque", "serve", "--workers", "0", "--data-dir", folder, "--port"]
        with _server(service) as (port, process), _server(["benchmarks.bare_upload"]) as (bare, _):
            ways = {"upload": (port, "/v1/logs"), "count": (bare, "/count"), "write": (bare, "/write")}
            seconds: dict[str, list[float]] = {name: [] for name in ways}
            for _ in range(rounds):
                for name, (at, path) in ways.items():
                    seconds[name].append(_post(at, path, noise))
            before = _peak_mb(process.pid)
            with ThreadPoolExecutor(AT_ONCE) as senders:
                for sent in [senders.submit(_post, port, "/v1/logs", noise) for _ in range(rushes * AT_ONCE)]:
                    sent.result()
            growth = _peak_mb(process.pid) - before
            log = _parquet()
            whole = [_post(port, f"/v1/logs?name={number}", log) for number in range(rounds)]
            bare_whole = [_post(bare, "/write", log) for _ in range(rounds)]
    best = {name: min(times) for name, times in seconds.items()}
    typical = {name: statistics.median(times) for name, times in seconds.items()}
    return [
        Figure(
            "upload, MB/s",
            f"{SIZE / best['upload'] / 1e6:.0f}",
            "",
            f"median {SIZE / typical['upload'] / 1e6:.0f}",
        ),
        Figure("bare endpoint that counts, MB/s", f"{SIZE / best['count'] / 1e6:.0f}"),
        Figure("bare endpoint that writes, MB/s", f"{SIZE / best['write'] / 1e6:.0f}"),
        Figure(
            "rate over the one that counts, %",
            _share(seconds, "count"),
            ">= 70",
            f"of the best {_share_of_best(best, 'count')}",
            ratio=True,
        ),
        Figure(
            "rate over the one that writes, %",
            _share(seconds, "write"),
            "",
            f"of the best {_share_of_best(best, 'write')}",
            ratio=True,
        ),
        Figure(f"memory that {AT_ONCE} at once add, MB", f"{growth:.1f}", "<= 32"),
        Figure(
            f"a sound log of {len(log) / 1e6:.0f} MB (Parquet): received, read and kept, ms",
            f"{1e3 * statistics.median(whole):.0f}",
            "",
            f"written barely {1e3 * statistics.median(bare_whole):.0f}",
        ),
    ]


def _share(seconds: dict[str, list[float]], bare: str) -> str:
    """Compare round by round, and take the median: what else the machine does meets both alike."""
    shares = [other / ours for other, ours in zip(seconds[bare], seconds["upload"], strict=True)]
    return f"{100.0 * statistics.median(shares):.0f}"


def _share_of_best(best: dict[str, float], bare: str) -> str:
    return f"{100.0 * best[bare] / best['upload']:.0f}"


@contextmanager
def _server(module: list[str]) -> Iterator[tuple[int, "subprocess.Popen[bytes]"]]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = int(free.getsockname()[1])
    process = subprocess.Popen(
        [sys.executable, "-m", *module, str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        _await(port)
        yield port, process
    finally:
        process.terminate()
        process.wait()


def _await(port: int) -> None:
    deadline = time.monotonic() + START_S
    while time.monotonic() < deadline:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.05)
    raise TimeoutError(f"no server at port {port} within {START_S:g} s")


def _post(port: int, path: str, content: bytes) -> float:
    """Send bytes and give the time until the answer is there, s."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120.0)
    begin = time.perf_counter()
    connection.request("POST", path, content, {"Content-Type": "application/octet-stream"})
    answer = connection.getresponse()
    answer.read()
    seconds = time.perf_counter() - begin
    connection.close()
    if answer.status not in (200, 201, 422):
        raise RuntimeError(f"{path} answers {answer.status}")
    return seconds


def _peak_mb(process: int) -> float:
    (kilobytes,) = re.findall(r"VmHWM:\s+(\d+) kB", Path(f"/proc/{process}/status").read_text())
    return int(kilobytes) / 1024.0


def _parquet() -> bytes:
    """Write a log of seven joints that takes some 20 MB."""
    random, samples = np.random.default_rng(1), 170_000
    moment = np.arange(samples) / 250.0
    table = {"time": moment}
    for joint in range(1, 8):
        table[f"q_{joint}"] = np.sin((0.5 + 0.1 * joint) * moment) + 1e-5 * random.standard_normal(samples)
        table[f"tau_{joint}"] = 5.0 * np.cos(moment + joint) + 0.05 * random.standard_normal(samples)
    stream = io.BytesIO()
    pq.write_table(pa.table(table), stream)
    return stream.getvalue()
