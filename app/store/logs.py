"""Keep logs by their content: the same bytes under the same name and mapping are the same log."""

import hashlib
import json
from typing import Any

from sqlalchemy import Connection, Row, select

from ..json_text import canonical_json
from .database import insert_if_new
from .quota import refuse_beyond, refuse_more
from .records import Document, LogRecord
from .tables import LOGS, log_record, now
from .tenant_records import TenantRecords


def log_id(*, sha256: str, name: str, mapping: Document | None) -> str:
    """Give the id of a log."""
    return "log-" + hashlib.sha256(canonical_json([sha256, name, mapping])).hexdigest()[:20]


class LogStore(TenantRecords[LogRecord]):
    """Keep the summaries of one tenant's logs in the database."""

    table = LOGS

    def _record(self, row: Row[Any]) -> LogRecord:
        return log_record(row)

    def require_room(self, identity: str, *, size: int) -> None:
        """Refuse a log before its bytes are kept; one that is known takes no more room.

        Raises
        ------
        OverQuotaError
            If the tenant would have more bytes than it may.
        """
        if self._quota.stored_bytes is not None and self.get(identity) is None:
            self._database.read(lambda connection: refuse_more(connection, self._tenant, self._quota, size))

    def add(self, identity: str, *, sha256: str, size: int, summary: Document) -> LogRecord:
        """Keep a log, or find it where it is known already; its bytes are there before it is.

        Raises
        ------
        OverQuotaError
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
