r"""Keep the jobs of a tenant: asked for, looked at, dismissed, removed.

    accepted -> running -> successful | failed
        |          |  \-> accepted (whoever computed it stopped or died)
        `----------`----> dismissed

Every change is one statement that only succeeds from the state it belongs to: a job that was dismissed does
not come back as successful. What workers do to jobs stands in `app.store.work`.
"""

import hashlib
import secrets
from concurrent.futures import Future

from sqlalchemy import ColumnElement, Connection, and_, bindparam, delete, insert, select, update

from app.documents import canonical_json
from app.store.database import Database, take_turns
from app.store.errors import KeyReused
from app.store.quota import refuse_another_job
from app.store.records import UNBOUNDED, UNFINISHED, JobRecord, JobRequestRecord, Quota
from app.store.rows import job_record, request_record
from app.store.tables import JOBS, REPEATS, now, one_of
from app.version import VERSION

ANSWERED = (*UNFINISHED, "successful")
"""States of a job that answers a later request for the same."""
OURS = JOBS.c.tenant == bindparam("tenant")
FIND = select(JOBS).where(OURS, JOBS.c.id == bindparam("id"))
ALIKE = (
    select(JOBS)
    .where(OURS, JOBS.c.fingerprint == bindparam("fingerprint"), one_of(JOBS.c.state, ANSWERED))
    .order_by(JOBS.c.sequence)
    .limit(1)
)
NEW = insert(JOBS).returning(JOBS)


class JobStore:
    """Keep one tenant's jobs in the database."""

    def __init__(self, database: Database, tenant: str, quota: Quota = UNBOUNDED) -> None:
        self._database, self._tenant, self._quota = database, tenant, quota

    def add(
        self, request: JobRequestRecord, *, key: str | None = None, trace: str | None = None
    ) -> JobRecord:
        """Queue a job and wait until it is; see `begin_to_add`."""
        return self.begin_to_add(request, key=key, trace=trace).result()

    def begin_to_add(
        self, request: JobRequestRecord, *, key: str | None = None, trace: str | None = None
    ) -> "Future[JobRecord]":
        """Queue a job, or find the one that asked for the same.

        Parameters
        ----------
        key
            What a client calls its request, so that it can send it twice and mean it once.
        trace
            Id of the trace that the request belongs to; a job keeps that of the first one.

        Raises
        ------
        KeyReused
            If the key came with another request before.
        OverQuota
            If the tenant has as many unfinished jobs as it may have.
        """
        asked = canonical_json(request.document())
        fingerprint = hashlib.sha256(canonical_json([VERSION, request.document()])).hexdigest()
        digest = hashlib.sha256(asked).hexdigest()

        def work(connection: Connection) -> JobRecord:
            if key is not None:
                take_turns(connection, f"{self._tenant} {key}")
            take_turns(connection, fingerprint)
            known = None if key is None else self._repeated(connection, key, digest)
            found = known or self._alike(connection, fingerprint)
            found = found or self._new(connection, asked, fingerprint, trace)
            if key is not None and known is None:
                values = {"tenant": self._tenant, "key": key, "digest": digest, "job_id": found.id}
                connection.execute(insert(REPEATS).values(values | {"created_at": now()}))
            return found

        return self._database.begin(work)

    def get(self, identity: str) -> JobRecord | None:
        """Find a job."""
        return self._database.read(lambda connection: self._find(connection, identity))

    def page(self, *, limit: int, before: int | None = None) -> list[JobRecord]:
        """List jobs, the newest first, from before a sequence number on."""
        query = select(JOBS).where(JOBS.c.tenant == self._tenant).order_by(JOBS.c.sequence.desc())
        if before is not None:
            query = query.where(JOBS.c.sequence < before)
        return self._database.read(
            lambda connection: [job_record(row) for row in connection.execute(query.limit(limit))]
        )

    def dismiss(self, identity: str) -> JobRecord | None:
        """Mark an unfinished job dismissed; give the job as it is then, None where there is none."""
        values = {"state": "dismissed", "finished_at": now(), "version": JOBS.c.version + 1}
        unfinished = and_(self._own(identity), JOBS.c.state.in_(UNFINISHED))

        def work(connection: Connection) -> JobRecord | None:
            connection.execute(update(JOBS).where(unfinished).values(values))
            return self._find(connection, identity)

        return self._database.write(work)

    def remove(self, identity: str) -> bool:
        """Forget a finished job, and say whether there was one."""
        finished = and_(self._own(identity), JOBS.c.state.not_in(UNFINISHED))
        return self._database.write(
            lambda connection: connection.execute(delete(JOBS).where(finished)).rowcount > 0
        )

    def unfinished_requests(self) -> list[JobRequestRecord]:
        """List what unfinished jobs need."""
        query = select(JOBS.c.request).where(JOBS.c.tenant == self._tenant, JOBS.c.state.in_(UNFINISHED))
        return self._database.read(
            lambda connection: [request_record(text) for text in connection.execute(query).scalars()]
        )

    def _own(self, identity: str) -> ColumnElement[bool]:
        return and_(JOBS.c.tenant == self._tenant, JOBS.c.id == identity)

    def _find(self, connection: Connection, identity: str) -> JobRecord | None:
        row = connection.execute(FIND, {"tenant": self._tenant, "id": identity}).one_or_none()
        return None if row is None else job_record(row)

    def _repeated(self, connection: Connection, key: str, digest: str) -> JobRecord | None:
        """Find what an earlier request with this key led to; None where there was none, or it is deleted."""
        mine = and_(REPEATS.c.tenant == self._tenant, REPEATS.c.key == key)
        earlier = connection.execute(select(REPEATS).where(mine)).one_or_none()
        if earlier is None:
            return None
        if earlier.digest != digest:
            raise KeyReused(key)
        found = self._find(connection, earlier.job_id)
        if found is None:
            connection.execute(delete(REPEATS).where(mine))
        return found

    def _alike(self, connection: Connection, fingerprint: str) -> JobRecord | None:
        row = connection.execute(ALIKE, {"tenant": self._tenant, "fingerprint": fingerprint}).one_or_none()
        return None if row is None else job_record(row)

    def _new(self, connection: Connection, asked: bytes, fingerprint: str, trace: str | None) -> JobRecord:
        refuse_another_job(connection, self._tenant, self._quota)
        values = {
            "tenant": self._tenant,
            "id": "job-" + secrets.token_hex(10),
            "fingerprint": fingerprint,
            "request": asked.decode(),
            "trace": trace,
            "state": "accepted",
            "stage": "",
            "fraction": 0.0,
            "version": 1,
            "attempts": 0,
            "token": 0,
            "beat": 0,
            "result_bytes": 0,
            "created_at": now(),
        }
        return job_record(connection.execute(NEW, values).one())
