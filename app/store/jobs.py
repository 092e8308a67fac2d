r"""Keep the jobs of a tenant: queued, read, dismissed, removed.

    accepted -> running -> successful | failed
        |          |  \-> accepted (whoever computed it stopped or died)
        `----------`----> dismissed

Every change is one statement that only succeeds from the state it belongs to: a job that was dismissed does
not come back as successful. How many are queued at once
stands in `app.store.queueing`, what workers do to them in `app.store.work`.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

from sqlalchemy import Connection, Row, and_, select, update

from .queueing import NewJob, Outcome, queue_all
from .records import UNFINISHED, JobRecord, JobRequestRecord
from .tables import JOBS, job_record, now, request_record
from .tenant_records import TenantRecords


class JobStore(TenantRecords[JobRecord]):
    """Keep one tenant's jobs in the database."""

    table = JOBS

    def _record(self, row: Row[Any]) -> JobRecord:
        return job_record(row)

    def begin_to_add(self, jobs: list[NewJob]) -> Callable[[], list[Outcome]]:
        """Queue jobs together, and give a function that waits until they are.

        For each it gives the job, an equal earlier one, or the reason: `KeyReusedError`, if its key
        came with another request before, or `OverQuotaError`, if the tenant has its quota of unfinished jobs.
        """
        if not jobs:
            return list
        coming = self._database.begin(partial(queue_all, tenant=self._tenant, quota=self._quota, jobs=jobs))

        def wait() -> list[Outcome]:
            try:
                return coming.result()
            except Exception as error:  # noqa: BLE001 - it is the answer to this one request
                if len(jobs) == 1:
                    return [error]
            return [outcome for job in jobs for outcome in self.begin_to_add([job])()]

        return wait

    def dismiss(self, identity: str) -> JobRecord | None:
        """Mark an unfinished job dismissed; give the job as it is then, None where there is none."""
        values = {"state": "dismissed", "finished_at": now(), "version": JOBS.c.version + 1}
        unfinished = and_(self._own(identity), JOBS.c.state.in_(UNFINISHED))

        def work(connection: Connection) -> JobRecord | None:
            connection.execute(update(JOBS).where(unfinished).values(values))
            return self._find(connection, identity)

        return self._database.write(work)

    def remove(self, identity: str) -> bool:
        """Delete a finished job, and say whether there was one."""
        return self._removed(and_(self._own(identity), JOBS.c.state.not_in(UNFINISHED)))

    def unfinished_requests(self) -> list[JobRequestRecord]:
        """List what unfinished jobs need."""
        query = select(JOBS.c.request).where(JOBS.c.tenant == self._tenant, JOBS.c.state.in_(UNFINISHED))
        return self._database.read(
            lambda connection: [request_record(text) for text in connection.execute(query).scalars()]
        )
