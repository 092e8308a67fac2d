"""Let workers take jobs of all tenants and report on them, each under the token it was given.

A job that is taken again gets a new token, so that the worker that held it before can change nothing any
more. Source: Kleppmann, Designing Data-Intensive Applications (2017), ch. 8, on fencing.
"""

import json
from collections.abc import Mapping

from sqlalchemy import ColumnElement, Connection, and_, func, or_, select, update

from .database import Database
from .records import Document, JobRecord
from .tables import JOBS, job_record, now

MOST_ATTEMPTS = 3
"""A job whose computation died this often is not tried again."""
Held = tuple[str, int]
"""Id and token of a job that is computed."""
RUNNING = JOBS.c.state == "running"
LATER = {"version": JOBS.c.version + 1}
WAITING = {"state": "accepted", "stage": "", "fraction": 0.0, "started_at": None, "owner": None}


class WorkStore:
    """Hand jobs out to workers, and take them back."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def claim(self, owner: str, *, most_per_tenant: int) -> JobRecord | None:
        """Take the oldest waiting job and mark it running; None where none may be taken.

        Parameters
        ----------
        owner
            Who takes it.
        most_per_tenant
            Jobs of one tenant that may run at the same time.
        """
        others = JOBS.alias()
        running = select(func.count()).where(others.c.state == "running", others.c.tenant == JOBS.c.tenant)
        free = running.scalar_subquery() < most_per_tenant
        oldest = select(JOBS.c.sequence).where(JOBS.c.state == "accepted", free)
        oldest = oldest.order_by(JOBS.c.sequence).limit(1).with_for_update(skip_locked=True)
        values = {
            "state": "running",
            "stage": "starting",
            "fraction": 0.0,
            "started_at": now(),
            "owner": owner,
            "attempts": JOBS.c.attempts + 1,
            "token": JOBS.c.token + 1,
        }
        taken = and_(JOBS.c.sequence == oldest.scalar_subquery(), JOBS.c.state == "accepted")

        def work(connection: Connection) -> JobRecord | None:
            row = connection.execute(update(JOBS).where(taken).values(values | LATER).returning(JOBS))
            found = row.one_or_none()
            return None if found is None else job_record(found)

        return self._database.write(work) if self._any_waits() else None

    def held(self, owner: str) -> set[Held]:
        """List what an owner still holds: not what was dismissed, or given to another."""
        query = select(JOBS.c.id, JOBS.c.token).where(RUNNING, JOBS.c.owner == owner)
        return self._database.read(lambda c: {(row.id, row.token) for row in c.execute(query)})

    def beat(self, owner: str) -> None:
        """Say that an owner lives."""
        alive = update(JOBS).where(RUNNING, JOBS.c.owner == owner).values(beat=JOBS.c.beat + 1)
        self._database.write(lambda connection: connection.execute(alive))

    def running_elsewhere(self, owner: str) -> dict[Held, tuple[str, int]]:
        """List the jobs that others hold, each with its owner and how often that has shown life."""
        query = select(JOBS.c.id, JOBS.c.token, JOBS.c.owner, JOBS.c.beat).where(
            RUNNING, or_(JOBS.c.owner != owner, JOBS.c.owner.is_(None))
        )
        return self._database.read(
            lambda c: {(row.id, row.token): (str(row.owner), row.beat) for row in c.execute(query)}
        )

    def report(self, held: Held, *, stage: str, fraction: float) -> None:
        """Say how far a running job is."""
        self._change(held, {"stage": stage, "fraction": fraction})

    def succeed(
        self, held: Held, *, result_sha256: str, result_bytes: int, traces_sha256: str | None = None
    ) -> bool:
        """Mark a running job successful, and say whether it was still held."""
        done = {"state": "successful", "stage": "done", "fraction": 1.0, "finished_at": now()}
        kept = {"result_sha256": result_sha256, "traces_sha256": traces_sha256, "result_bytes": result_bytes}
        return self._change(held, done | kept)

    def fail(self, held: Held, problem: Document) -> bool:
        """Mark a running job failed, and say whether it was still held."""
        return self._change(held, {"state": "failed", "problem": json.dumps(problem), "finished_at": now()})

    def hand_back(self, held: Held) -> bool:
        """Let a running job wait again, as if it had never been taken."""
        return self._change(held, WAITING | {"attempts": JOBS.c.attempts - 1})

    def retry_or_fail(self, held: Held, problem: Document, *, beat: int | None = None) -> bool:
        """Let a job whose computation died wait again; it fails if that has happened too often.

        Parameters
        ----------
        problem
            Why it fails, where it does.
        beat
            The heartbeats that its owner has sent; None to ignore them.
        """
        there = _held(held) if beat is None else and_(_held(held), JOBS.c.beat == beat)
        failed = {"state": "failed", "problem": json.dumps(problem), "finished_at": now()}

        def work(connection: Connection) -> bool:
            too_often = and_(there, JOBS.c.attempts >= MOST_ATTEMPTS)
            ended = connection.execute(update(JOBS).where(too_often).values(failed | LATER)).rowcount
            again = update(JOBS).where(there).values(WAITING | LATER)
            return ended > 0 or connection.execute(again).rowcount > 0

        return self._database.write(work)

    def count(self) -> dict[str, int]:
        """Count the jobs of all tenants by state."""
        query = select(JOBS.c.state, func.count().label("jobs")).group_by(JOBS.c.state)
        return self._database.read(lambda c: {row.state: row.jobs for row in c.execute(query)})

    def _any_waits(self) -> bool:
        query = select(JOBS.c.sequence).where(JOBS.c.state == "accepted").limit(1)
        return self._database.read(lambda connection: connection.execute(query).first() is not None)

    def _change(self, held: Held, values: Mapping[str, object]) -> bool:
        change = update(JOBS).where(_held(held)).values({**values, **LATER})
        return self._database.write(lambda connection: connection.execute(change).rowcount > 0)


def _held(held: Held) -> ColumnElement[bool]:
    identity, token = held
    return and_(RUNNING, JOBS.c.id == identity, JOBS.c.token == token)
