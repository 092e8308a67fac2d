"""Read many jobs of many tenants in one question; each is named by tenant and id, and found by both."""

from collections.abc import Sequence
from typing import Any

from sqlalchemy import Connection, Row, Select, bindparam, select

from .database import Database
from .records import JobRecord
from .tables import JOBS, job_record

Place = tuple[str, str]
"""Tenant and id of a job."""
MOST_AT_ONCE = 500
"""Values that one statement takes with room to spare on every database."""
AMONG = JOBS.c.id.in_(bindparam("ids", expanding=True))
RECORDS = select(JOBS).where(AMONG)
VERSIONS = select(JOBS.c.tenant, JOBS.c.id, JOBS.c.version).where(AMONG)


class ManyJobs:
    """Read jobs of all tenants."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def records(self, places: Sequence[Place]) -> dict[Place, JobRecord]:
        """Read those jobs that there are."""
        return {place: job_record(row) for place, row in self._rows(places, RECORDS)}

    def versions(self, places: Sequence[Place]) -> dict[Place, int]:
        """Read the versions of those jobs that there are."""
        return {place: row.version for place, row in self._rows(places, VERSIONS)}

    def _rows(self, places: Sequence[Place], query: Select[Any]) -> list[tuple[Place, Row[Any]]]:
        wanted = set(places)

        def work(connection: Connection) -> list[Row[Any]]:
            found: list[Row[Any]] = []
            for begin in range(0, len(places), MOST_AT_ONCE):
                ids = [identity for _, identity in places[begin : begin + MOST_AT_ONCE]]
                found += connection.execute(query, {"ids": ids})
            return found

        found = [((row.tenant, row.id), row) for row in self._database.read(work)]
        return [(place, row) for place, row in found if place in wanted]
