"""Bind records and bytes together: bytes are kept as long as a record needs them, and no longer.

One lock orders the few moments in which both change, so that nobody removes bytes that somebody is about to
need.
"""

import threading
from pathlib import Path

from app.store.blobs import BlobStore, Incoming
from app.store.jobs import JobStore
from app.store.logs import LogStore, log_id
from app.store.records import Document, LogRecord
from app.store.robots import RobotStore
from app.store.tables import open_database


class Store:
    """Open everything that is kept under one directory.

    Parameters
    ----------
    directory
        Created where it does not exist.
    """

    def __init__(self, directory: Path) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        self._engine = open_database(directory / "veritorque.sqlite")
        self._lock = threading.Lock()
        self.blobs = BlobStore(directory / "blobs")
        self.robots = RobotStore(self._engine)
        self.logs = LogStore(self._engine)
        self.jobs = JobStore(self._engine)

    def close(self) -> None:
        """Let go of the database."""
        self._engine.dispose()

    def keep_log(self, incoming: Incoming, *, mapping: Document | None, summary: Document) -> LogRecord:
        """Keep an uploaded log: its bytes and its summary."""
        identity = log_id(sha256=incoming.sha256, name=str(summary["name"]), mapping=mapping)
        with self._lock:
            sha256 = self.blobs.keep(incoming)
            return self.logs.add(identity, sha256=sha256, summary=summary)

    def remove_log(self, log: LogRecord) -> None:
        """Forget a log, and its bytes where no other log has the same."""
        with self._lock:
            self.logs.remove(log.id)
            self._release(log.sha256)

    def keep_result(self, job_id: str, result: bytes) -> bool:
        """Keep a job's result document, and say whether the job still wanted it."""
        with self._lock:
            sha256 = self.blobs.put(result)
            wanted = self.jobs.succeed(job_id, result_sha256=sha256)
            if not wanted:
                self._release(sha256)
            return wanted

    def remove_job(self, job_id: str) -> bool:
        """Forget a finished job and its result, and say whether there was one."""
        with self._lock:
            job = self.jobs.get(job_id)
            if job is None or not self.jobs.remove(job_id):
                return False
            if job.result_sha256 is not None:
                self._release(job.result_sha256)
            return True

    def _release(self, sha256: str) -> None:
        if not (self.logs.uses(sha256) or self.jobs.uses(sha256)):
            self.blobs.remove(sha256)
