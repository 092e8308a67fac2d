"""Bind records and bytes together: bytes are written before the record that needs them, and removed after it.

What is in between when the power fails is bytes that no record needs; `app.store.sweep` removes them.
"""

from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Connection, exists, select, union_all

from app.store.blobs import BlobStore, Incoming
from app.store.database import Database
from app.store.jobs import JobStore
from app.store.logs import LogStore, log_id
from app.store.many import ManyJobs
from app.store.migrations.upgrade import touch
from app.store.records import UNBOUNDED, Document, LogRecord, Quota
from app.store.robots import RobotStore
from app.store.tables import JOBS, LOGS
from app.store.work import Held, WorkStore


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
        self.blobs = BlobStore(directory / "blobs")
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
        """Let go of the database."""
        self.database.close()

    def keep_result(self, held: Held, result: bytes) -> bool:
        """Keep a job's result document, and say whether whoever computed it still held the job."""
        sha256 = self.blobs.put(result)
        return self.work.succeed(held, result_sha256=sha256, result_bytes=len(result))

    def prove_writable(self) -> None:
        """Write to the database what it holds already.

        Raises
        ------
        Unavailable
            If it cannot be written.
        """
        self.database.write(touch)

    def needed(self) -> set[str]:
        """List the hashes of all bytes that a record needs."""
        query = union_all(
            select(LOGS.c.sha256), select(JOBS.c.result_sha256).where(JOBS.c.result_sha256.is_not(None))
        )
        return self.database.read(lambda connection: set(connection.execute(query).scalars()))

    def users(self, hashes: list[str]) -> list[str]:
        """List the ids of the logs and jobs of all tenants that need bytes."""
        query = union_all(
            select(LOGS.c.id).where(LOGS.c.sha256.in_(hashes)),
            select(JOBS.c.id).where(JOBS.c.result_sha256.in_(hashes)),
        )
        return self.database.read(lambda connection: list(connection.execute(query).scalars()))

    def needs(self, sha256: str) -> bool:
        """Tell whether a record needs the bytes of a hash."""

        def work(connection: Connection) -> bool:
            either = exists().where(LOGS.c.sha256 == sha256) | exists().where(JOBS.c.result_sha256 == sha256)
            return bool(connection.execute(select(either)).scalar_one())

        return self.database.read(work)


@dataclass(frozen=True)
class TenantStore:
    """Keep what belongs to one tenant."""

    blobs: BlobStore
    robots: RobotStore
    logs: LogStore
    jobs: JobStore

    def keep_log(self, incoming: Incoming, *, mapping: Document | None, summary: Document) -> LogRecord:
        """Keep an uploaded log: its bytes, then its summary."""
        sha256, size = self.blobs.keep(incoming), incoming.size
        identity = log_id(sha256=sha256, name=str(summary["name"]), mapping=mapping)
        return self.logs.add(identity, sha256=sha256, size=size, summary=summary)
