"""Start the processes of a service as users do, and find those that they start themselves."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

from examples.yumi.service import free_port

ROOT = Path(__file__).parents[2]
PATIENCE_S = 120.0
"""How long a process may take to end in order."""
PORTS = 5
"""How many ports are tried."""
PARTING_S = 30.0
"""How long what a killed process had started may take to notice."""


def children(process_id):
    """List the processes that a process started and that still live, as {id: command}."""
    found = {}
    with contextlib.suppress(OSError):
        for thread in Path(f"/proc/{process_id}/task").iterdir():
            for child in (thread / "children").read_text().split():
                found[int(child)] = Path(f"/proc/{child}/cmdline").read_bytes().replace(b"\0", b" ").decode()
    return {child: command for child, command in found.items() if command}  # a zombie has none


def send(process_id, number):
    """Send a signal, and tell whether there was a process to take it."""
    with contextlib.suppress(ProcessLookupError):
        os.kill(process_id, number)
        return True
    return False


class Fleet:
    """One service with the worker beside it, and workers of their own, on one data directory."""

    def __init__(self, directory, url, workers):
        self.directory = directory
        told = {"DATA_DIR": str(directory), "DISK_RESERVE_BYTES": "0", "QUEUED_PER_TENANT": "100000"}
        told |= {"DATABASE_URL": url} if url else {}
        self.environment = {**os.environ, **{f"VERITORQUE_{name}": value for name, value in told.items()}}
        self._journal = (directory.parent / "journal").open("ab")
        self.workers = [self._start("work") for _ in range(workers)]
        self._listen()

    @property
    def address(self):
        return f"http://127.0.0.1:{self.port}"

    def _listen(self):
        """Start the service; somebody may take the port that was free before it can."""
        for _ in range(PORTS):
            self.port = free_port()
            self.service = self._start("serve", "--port", str(self.port))
            while self.service.poll() is None:
                if self.answers():
                    return
                time.sleep(0.1)
        raise RuntimeError(f"the service ended {PORTS} times before it listened")

    def answers(self):
        """Tell whether the service takes requests."""
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", self.port), timeout=1.0):
            return True
        return False

    def revive(self):
        """Start again what has died."""
        if self.service.poll() is not None:
            self.service = self._start("serve", "--port", str(self.port))
        self.workers = [one if one.poll() is None else self._start("work") for one in self.workers]

    def all_workers(self):
        """List the ids of all worker processes, that beside the service first."""
        beside = [number for number, command in children(self.service.pid).items() if " work " in command]
        return beside + [one.pid for one in self.workers if one.poll() is None]

    def computing(self, worker):
        """List the ids of the processes that compute for a worker: children of its fork server."""
        servers = [number for number, command in children(worker).items() if "forkserver" in command]
        return [number for server in servers for number in children(server)]

    def close(self):
        """End all in order, and tell with which codes they ended."""
        everybody = [self.service, *self.workers]
        for one in everybody:
            one.send_signal(signal.SIGCONT)
            one.terminate()
        try:
            return [one.wait(PATIENCE_S) for one in everybody]
        finally:
            for one in everybody:
                one.kill()
                one.wait()
            self._journal.close()

    def left(self):
        """List the processes that outlive all that was started, those of killed services among them."""
        deadline = time.monotonic() + PARTING_S
        while (left := self._processes()) and time.monotonic() < deadline:
            time.sleep(0.2)
        return left

    def _processes(self):
        mark = f"VERITORQUE_DATA_DIR={self.directory}\0".encode()
        found = []
        for place in Path("/proc").glob("[0-9]*/environ"):
            with contextlib.suppress(OSError):
                if mark in place.read_bytes():
                    found.append(int(place.parent.name))
        return found

    def command(self, *arguments):
        """Run a command of the service to its end, and give its code and what it said."""
        done = subprocess.run(
            [sys.executable, "-m", "tests.chaos.service", *arguments],
            env=self.environment,
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )
        return done.returncode, done.stdout + done.stderr

    def _start(self, *arguments):
        return subprocess.Popen(
            [sys.executable, "-m", "tests.chaos.service", *arguments],
            env=self.environment,
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=self._journal,
            stderr=self._journal,
        )
