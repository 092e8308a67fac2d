"""Bind records and bytes together: bytes are written before the record that needs them, and removed after it.

What is in between when the power fails is bytes that no record needs; `app.store.blobs.sweep` removes them.
"""

from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Connection, exists, or_, select, union_all

from .blobs.blob_store import BlobStore
from .blobs.file_store import FileBlobStore
from .blobs.incoming import Incoming
from .database import Database
from .jobs import JobStore
from .logs import LogStore, log_id
from .many import ManyJobs
from .migrations.upgrade import touch
from .records import UNBOUNDED, Document, LogRecord, Quota
from .robots import RobotStore
from .tables import JOBS, LOGS
from .work import Held, WorkStore

BYTES_OF_JOBS = (JOBS.c.result_sha256, JOBS.c.traces_sha256)


class Store:
    """Open everything that is kept.

    Parameters
    ----------
    directory
        Created where it does not exist; bytes are kept here, and the database where no other is named.
    database_url
        Where the database is; None for the embedded one.
    quota
        What each tenant may have.
    """

    def __init__(self, directory: Path, database_url: str | None = None, *, quota: Quota = UNBOUNDED) -> None:
        self._quota = quota
        directory.mkdir(parents=True, exist_ok=True)
        self.directory = directory
        self.database = Database(database_url) if database_url else Database.in_directory(directory)
        self.blobs: BlobStore = FileBlobStore(directory / "blobs")
        self.work = WorkStore(self.database)
        self.many_jobs = ManyJobs(self.database)

    def of(self, tenant: str) -> "TenantStore":
        """Open what belongs to one tenant; nothing of another's can be reached through it."""
        return TenantStore(
            blobs=self.blobs,
            robots=RobotStore(self.database, tenant),
            logs=LogStore(self.database, tenant, self._quota),
            jobs=JobStore(self.database, tenant, self._quota),
        )

    def close(self) -> None:
        """Close the database."""
        self.database.close()

    def keep_result(self, held: Held, result: bytes, traces: Path | None = None) -> bool:
        """Keep a job's result document, and say whether its worker still held the job.

        Parameters
        ----------
        traces
            File of the torques and residuals of every sample; the result is kept alone where there is none.
        """
        sha256, size = self.blobs.put(result), len(result)
        if traces is None or not traces.exists():
            return self.work.succeed(held, result_sha256=sha256, result_bytes=size)
        size += traces.stat().st_size
        with_it = self.blobs.put_file(traces)
        return self.work.succeed(held, result_sha256=sha256, result_bytes=size, traces_sha256=with_it)

    def prove_writable(self) -> None:
        """Write to the database what it holds already.

        Raises
        ------
        UnavailableError
            If it cannot be written.
        """
        self.database.write(touch)

    def needed(self) -> set[str]:
        """List the hashes of all bytes that a record needs."""
        query = union_all(
            select(LOGS.c.sha256), *(select(column).where(column.is_not(None)) for column in BYTES_OF_JOBS)
        )
        return self.database.read(lambda connection: set(connection.execute(query).scalars()))

    def users(self, hashes: list[str]) -> list[str]:
        """List the ids of the logs and jobs of all tenants that need bytes."""
        query = union_all(
            select(LOGS.c.id).where(LOGS.c.sha256.in_(hashes)),
            *(select(JOBS.c.id).where(column.in_(hashes)) for column in BYTES_OF_JOBS),
        )
        return self.database.read(lambda connection: list(connection.execute(query).scalars()))

    def needs(self, sha256: str) -> bool:
        """Return whether a record needs the bytes of a hash."""

        def work(connection: Connection) -> bool:
            users = (exists().where(column == sha256) for column in (LOGS.c.sha256, *BYTES_OF_JOBS))
            return bool(connection.execute(select(or_(*users))).scalar_one())

        return self.database.read(work)


@dataclass(frozen=True)
class TenantStore:
    """Keep what belongs to one tenant."""

    blobs: BlobStore
    robots: RobotStore
    logs: LogStore
    jobs: JobStore

    def keep_log(self, incoming: Incoming, *, mapping: Document | None, summary: Document) -> LogRecord:
        """Keep an uploaded log: its bytes, then its summary.

        Raises
        ------
        OverQuotaError
            If the tenant would have more bytes than it may; as a rule none of them are kept then.
        """
        identity = log_id(sha256=incoming.sha256, name=str(summary["name"]), mapping=mapping)
        self.logs.require_room(identity, size=incoming.size)
        sha256 = self.blobs.keep(incoming)
        return self.logs.add(identity, sha256=sha256, size=incoming.size, summary=summary)
