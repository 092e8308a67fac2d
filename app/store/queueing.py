"""Queue many jobs of one tenant in one transaction, or find those that asked for the same.

What the database is asked does not grow with their number: what is known of all of them is read first, then
each is decided, then all that is new is written.
"""

import hashlib
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

from sqlalchemy import Connection, and_, bindparam, delete, insert, select

from ..json_text import canonical_json
from ..version import VERSION
from .database import lock_in_turn
from .errors import KeyReusedError, OverQuotaError
from .quota import room_for_jobs
from .records import UNFINISHED, JobRecord, JobRequestRecord, Quota
from .tables import JOBS, REPEATS, job_record, now, one_of

ANSWERED = (*UNFINISHED, "successful")
"""States of a job that answers a later request for the same."""
ALIKE = (
    select(JOBS)
    .where(
        JOBS.c.tenant == bindparam("tenant"),
        JOBS.c.fingerprint.in_(bindparam("fingerprints", expanding=True)),
        one_of(JOBS.c.state.concat(""), ANSWERED),
    )
    .order_by(JOBS.c.sequence.desc())
)
"""The empty text keeps SQLite from looking for the states first, which most jobs of a full queue have."""
THESE_KEYS = and_(
    REPEATS.c.tenant == bindparam("tenant"), REPEATS.c.key.in_(bindparam("keys", expanding=True))
)
THEIR_JOB = and_(JOBS.c.tenant == REPEATS.c.tenant, JOBS.c.id == REPEATS.c.job_id)
REPEATED = (
    select(REPEATS.c.key, REPEATS.c.digest, JOBS)
    .join_from(REPEATS, JOBS, THEIR_JOB, isouter=True)
    .where(THESE_KEYS)
)
FORGET = delete(REPEATS).where(THESE_KEYS)
NEW = insert(JOBS).returning(JOBS)


@dataclass(frozen=True)
class NewJob:
    """Describe a job to be queued."""

    request: JobRequestRecord
    key: str | None = None
    """The client's Idempotency-Key, which makes a repeated request the same job."""
    trace: str | None = None
    """Id of the trace that the request belongs to; a job keeps that of the first one."""

    @cached_property
    def document(self) -> bytes:
        """Write what is asked for, the same for the same."""
        return canonical_json(self.request.document())

    @cached_property
    def digest(self) -> str:
        """Give the hash that distinguishes requests."""
        return hashlib.sha256(self.document).hexdigest()

    @cached_property
    def fingerprint(self) -> str:
        """Give the hash that distinguishes results."""
        return hashlib.sha256(b"[%b,%b]" % (canonical_json(VERSION), self.document)).hexdigest()


Outcome = JobRecord | Exception
Decided = TypeVar("Decided", JobRecord, Outcome)


def queue_all(connection: Connection, tenant: str, quota: Quota, jobs: Sequence[NewJob]) -> list[Outcome]:
    """Queue jobs; give for each the job, or why there is none: `KeyReusedError` or `OverQuotaError`."""
    keys = [job.key for job in jobs if job.key is not None]
    for about in sorted({*(job.fingerprint for job in jobs), *(f"{tenant} {key}" for key in keys)}):
        lock_in_turn(connection, about)  # in the same order as everybody, so that no two wait for each other
    decisions = _Decisions(connection, tenant, quota, jobs)
    decided = [decisions.decide(job) for job in jobs]
    decisions.write()
    return [decisions.outcome(decision) for decision in decided]


class _Decisions:
    """Decide request by request; a job that is about to be queued is named by its fingerprint."""

    def __init__(self, connection: Connection, tenant: str, quota: Quota, jobs: Sequence[NewJob]) -> None:
        self._connection, self._tenant, self._quota = connection, tenant, quota
        mine = {"tenant": tenant}
        alike = mine | {"fingerprints": [job.fingerprint for job in jobs]}
        rows = connection.execute(ALIKE, alike)
        self._alike: dict[str, JobRecord | str] = {row.fingerprint: job_record(row) for row in rows}
        keys = [job.key for job in jobs if job.key is not None]
        repeated = connection.execute(REPEATED, mine | {"keys": keys}).all() if keys else []
        self._repeated: dict[str, tuple[str, JobRecord | str | None]] = {
            row.key: (row.digest, None if row.id is None else job_record(row)) for row in repeated
        }
        self._room = room_for_jobs(connection, tenant, quota)
        self._new: list[NewJob] = []
        self._queued: dict[str, JobRecord] = {}
        self._noted: dict[str, tuple[NewJob, JobRecord | str]] = {}

    def decide(self, job: NewJob) -> Outcome | str:
        """Give the job that answers a request, why there is none, or the name of a new one."""
        digest, found = self._repeated.get(job.key or "", (job.digest, None))
        if digest != job.digest:
            return KeyReusedError(str(job.key))
        if found is not None:
            return found
        known = self._alike.get(job.fingerprint)
        if known is None:
            if self._room <= 0:
                return self._quota_problem()
            known = self._add(job)
        if job.key is not None:
            self._repeated[job.key] = (job.digest, known)
            self._noted[job.key] = (job, known)
        return known

    def write(self) -> None:
        """Write what is new."""
        if self._new:
            rows = self._connection.execute(NEW, [_row(self._tenant, job) for job in self._new])
            self._queued = {row.fingerprint: job_record(row) for row in rows}
        if self._noted:
            self._connection.execute(FORGET, {"tenant": self._tenant, "keys": list(self._noted)})
            notes = [self._note(new, self.outcome(found)) for new, found in self._noted.values()]
            self._connection.execute(insert(REPEATS), notes)

    def outcome(self, decision: Decided | str) -> Decided | JobRecord:
        """Give what a decision led to: the new job for its fingerprint, else the decision itself."""
        return self._queued[decision] if isinstance(decision, str) else decision

    def _add(self, job: NewJob) -> str:
        self._room -= 1
        self._new.append(job)
        self._alike[job.fingerprint] = job.fingerprint
        return job.fingerprint

    def _quota_problem(self) -> OverQuotaError:
        most = self._quota.queued or 0
        return OverQuotaError("unfinished jobs", most=most, setting="VERITORQUE_QUEUED_PER_TENANT")

    def _note(self, new: NewJob, job: JobRecord) -> dict[str, str | None]:
        mine = {"tenant": self._tenant, "key": new.key, "digest": new.digest}
        return mine | {"job_id": job.id, "created_at": now()}


def _row(tenant: str, job: NewJob) -> dict[str, object]:
    return {
        "tenant": tenant,
        "id": "job-" + secrets.token_hex(10),
        "fingerprint": job.fingerprint,
        "request": job.document.decode(),
        "trace": job.trace,
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
