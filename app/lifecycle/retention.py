"""Remove records that are older than the operator keeps them; the sweep then removes their blobs.

Times of day decide here, in days; a clock that is an hour wrong moves a deadline by an hour and nothing else.
"""

from collections.abc import Mapping
from datetime import UTC, datetime, timedelta

from sqlalchemy import Connection, Delete, delete, exists

from ..settings import Kept
from ..store.database import Database
from ..store.tables import JOBS, LOGS, REPEATS, time_text


def expire(database: Database, days: Mapping[Kept, float]) -> dict[str, int]:
    """Remove what is older than its kind is kept, and count it by kind.

    Parameters
    ----------
    days
        How long each kind is kept: ``successful``, ``failed`` and ``dismissed`` jobs since they ended,
        ``logs`` that no job names since they came, ``repeats`` of requests with an Idempotency-Key.
    """
    today = datetime.now(UTC)
    statements = {kind: _statement(kind, today - timedelta(days=keep)) for kind, keep in days.items()}

    def work(connection: Connection) -> dict[str, int]:
        return {kind: connection.execute(statement).rowcount for kind, statement in statements.items()}

    return database.write(work) if statements else {}


def _statement(kind: Kept, until: datetime) -> Delete:
    before = time_text(until)
    if kind == "repeats":
        return delete(REPEATS).where(REPEATS.c.created_at < before)
    if kind == "logs":
        named = exists().where(JOBS.c.tenant == LOGS.c.tenant, JOBS.c.request.contains(LOGS.c.id))
        return delete(LOGS).where(LOGS.c.created_at < before, ~named)
    return delete(JOBS).where(JOBS.c.state == kind, JOBS.c.finished_at < before)
