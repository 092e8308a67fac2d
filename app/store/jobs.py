r"""Keep jobs and their states; every change is one statement that only succeeds from the state it belongs to.

    accepted -> running -> successful | failed
        |          |  \-> accepted (the service stopped meanwhile)
        `----------`----> dismissed

So two workers never take the same job, and a job that was dismissed does not come back as successful.
"""

import json
import secrets

from sqlalchemy import Engine, Row, and_, delete, func, insert, select, update

from app.store.records import UNFINISHED, Document, JobRecord, JobRequestRecord, State
from app.store.tables import JOBS, now

MOST_ATTEMPTS = 3


class JobStore:
    """Keep jobs in the database."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def add(self, request: JobRequestRecord) -> JobRecord:
        """Queue a job."""
        asked = {
            "kind": request.kind,
            "robot": request.robot,
            "logs": request.logs,
            "options": request.options,
        }
        values = {
            "id": "job-" + secrets.token_hex(10),
            "request": json.dumps(asked),
            "state": "accepted",
            "created_at": now(),
        }
        with self._engine.begin() as connection:
            return _record(connection.execute(insert(JOBS).values(values).returning(JOBS)).one())

    def get(self, identity: str) -> JobRecord | None:
        """Find a job."""
        with self._engine.connect() as connection:
            row = connection.execute(select(JOBS).where(JOBS.c.id == identity)).one_or_none()
        return None if row is None else _record(row)

    def page(self, *, limit: int, offset: int) -> tuple[list[JobRecord], int]:
        """List jobs, the newest first, and count all of them."""
        newest = select(JOBS).order_by(JOBS.c.sequence.desc()).limit(limit).offset(offset)
        with self._engine.connect() as connection:
            total = connection.execute(select(func.count()).select_from(JOBS)).scalar_one()
            return [_record(row) for row in connection.execute(newest)], total

    def claim(self) -> JobRecord | None:
        """Take the oldest waiting job and mark it running; None where none waits."""
        oldest = select(func.min(JOBS.c.sequence)).where(JOBS.c.state == "accepted").scalar_subquery()
        values = {
            "state": "running",
            "stage": "starting",
            "fraction": 0.0,
            "started_at": now(),
            "attempts": JOBS.c.attempts + 1,
            "version": JOBS.c.version + 1,
        }
        taken = and_(JOBS.c.sequence == oldest, JOBS.c.state == "accepted")
        with self._engine.begin() as connection:
            row = connection.execute(update(JOBS).where(taken).values(values).returning(JOBS)).one_or_none()
        return None if row is None else _record(row)

    def report(self, identity: str, *, stage: str, fraction: float) -> None:
        """Say how far a running job is."""
        self._change(identity, ("running",), {"stage": stage, "fraction": fraction})

    def succeed(self, identity: str, *, result_sha256: str) -> bool:
        """Mark a running job successful, and say whether it still ran."""
        done = {"state": "successful", "stage": "done", "fraction": 1.0, "result_sha256": result_sha256}
        return self._change(identity, ("running",), done | {"finished_at": now()})

    def fail(self, identity: str, problem: Document) -> bool:
        """Mark a running job failed, and say whether it still ran."""
        values: dict[str, object] = {
            "state": "failed",
            "problem": json.dumps(problem),
            "finished_at": now(),
        }
        return self._change(identity, ("running",), values)

    def dismiss(self, identity: str) -> bool:
        """Mark an unfinished job dismissed, and say whether it was unfinished."""
        return self._change(identity, UNFINISHED, {"state": "dismissed", "finished_at": now()})

    def put_back(self, identity: str) -> bool:
        """Queue a running job again, as if it had never been taken."""
        values = {"state": "accepted", "stage": "", "fraction": 0.0, "started_at": None}
        return self._change(identity, ("running",), values | {"attempts": JOBS.c.attempts - 1})

    def recover(self, problem: Document) -> None:
        """Queue again what an earlier run left running; what was tried too often fails."""
        left = JOBS.c.state == "running"
        failed = {"state": "failed", "problem": json.dumps(problem), "finished_at": now()}
        queued = {"state": "accepted", "stage": "", "fraction": 0.0, "started_at": None}
        later = {"version": JOBS.c.version + 1}
        with self._engine.begin() as connection:
            too_often = and_(left, JOBS.c.attempts >= MOST_ATTEMPTS)
            connection.execute(update(JOBS).where(too_often).values(failed | later))
            connection.execute(update(JOBS).where(left).values(queued | later))

    def remove(self, identity: str) -> bool:
        """Forget a finished job, and say whether there was one."""
        finished = and_(JOBS.c.id == identity, JOBS.c.state.not_in(UNFINISHED))
        with self._engine.begin() as connection:
            return connection.execute(delete(JOBS).where(finished)).rowcount > 0

    def unfinished_requests(self) -> list[JobRequestRecord]:
        """List what unfinished jobs need."""
        with self._engine.connect() as connection:
            rows = connection.execute(select(JOBS.c.request).where(JOBS.c.state.in_(UNFINISHED)))
            return [_request(row.request) for row in rows]

    def uses(self, sha256: str) -> bool:
        """Tell whether any job's result is the bytes of a hash."""
        with self._engine.connect() as connection:
            query = select(func.count()).select_from(JOBS).where(JOBS.c.result_sha256 == sha256)
            return connection.execute(query).scalar_one() > 0

    def _change(self, identity: str, states: tuple[State, ...], values: dict[str, object]) -> bool:
        there = and_(JOBS.c.id == identity, JOBS.c.state.in_(states))
        later: dict[str, object] = {"version": JOBS.c.version + 1}
        with self._engine.begin() as connection:
            return connection.execute(update(JOBS).where(there).values(values | later)).rowcount > 0


def _request(text: str) -> JobRequestRecord:
    asked = json.loads(text)
    return JobRequestRecord(asked["kind"], asked["robot"], tuple(asked["logs"]), asked["options"])


def _record(row: Row[tuple[object, ...]]) -> JobRecord:
    return JobRecord(
        id=row.id,
        request=_request(row.request),
        state=row.state,
        stage=row.stage,
        fraction=row.fraction,
        attempts=row.attempts,
        version=row.version,
        problem=None if row.problem is None else json.loads(row.problem),
        result_sha256=row.result_sha256,
        created_at=row.created_at,
        started_at=row.started_at,
        finished_at=row.finished_at,
    )
