"""Keep logs by their content: the same bytes under the same name and mapping are the same log."""

import hashlib
import json

from sqlalchemy import ColumnElement, Connection, and_, bindparam, delete, select

from ..json_text import canonical_json
from .database import Database, insert_if_new
from .quota import refuse_beyond, refuse_more
from .records import UNBOUNDED, Document, LogRecord, Quota
from .tables import LOGS, log_record, now

FIND = select(LOGS).where(LOGS.c.tenant == bindparam("tenant"), LOGS.c.id == bindparam("id"))


def log_id(*, sha256: str, name: str, mapping: Document | None) -> str:
    """Give the id of a log."""
    return "log-" + hashlib.sha256(canonical_json([sha256, name, mapping])).hexdigest()[:20]


class LogStore:
    """Keep the summaries of one tenant's logs in the database."""

    def __init__(self, database: Database, tenant: str, quota: Quota = UNBOUNDED) -> None:
        self._database, self._tenant, self._quota = database, tenant, quota

    def require_room(self, identity: str, *, size: int) -> None:
        """Refuse a log before its bytes are kept; one that is known takes no more room.

        Raises
        ------
        OverQuota
            If the tenant would have more bytes than it may.
        """
        if self._quota.stored_bytes is not None and self.get(identity) is None:
            self._database.read(lambda connection: refuse_more(connection, self._tenant, self._quota, size))

    def add(self, identity: str, *, sha256: str, size: int, summary: Document) -> LogRecord:
        """Keep a log, or find it where it is known already; its bytes are there before it is.

        Raises
        ------
        OverQuota
            If the tenant would have more bytes than it may.
        """
        values = {
            "tenant": self._tenant,
            "id": identity,
            "sha256": sha256,
            "bytes": size,
            "document": json.dumps(summary),
            "created_at": now(),
        }

        def work(connection: Connection) -> LogRecord:
            insert_if_new(connection, LOGS, values)
            refuse_beyond(connection, self._tenant, self._quota)
            return log_record(connection.execute(select(LOGS).where(self._own(identity))).one())

        return self._database.write(work)

    def get(self, identity: str) -> LogRecord | None:
        """Find a log."""
        mine = {"tenant": self._tenant, "id": identity}
        row = self._database.read(lambda connection: connection.execute(FIND, mine).one_or_none())
        return None if row is None else log_record(row)

    def page(self, *, limit: int, before: int | None = None) -> list[LogRecord]:
        """List logs, the newest first, from before a sequence number on."""
        query = select(LOGS).where(LOGS.c.tenant == self._tenant).order_by(LOGS.c.sequence.desc())
        if before is not None:
            query = query.where(LOGS.c.sequence < before)
        return self._database.read(
            lambda connection: [log_record(row) for row in connection.execute(query.limit(limit))]
        )

    def remove(self, identity: str) -> bool:
        """Forget a log, and say whether it was there."""
        gone = delete(LOGS).where(self._own(identity))
        return self._database.write(lambda connection: connection.execute(gone).rowcount > 0)

    def _own(self, identity: str) -> ColumnElement[bool]:
        return and_(LOGS.c.tenant == self._tenant, LOGS.c.id == identity)
