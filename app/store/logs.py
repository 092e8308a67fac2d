"""Keep logs by their content: the same bytes under the same name and mapping are the same log."""

import hashlib
import json

from sqlalchemy import Engine, Row, delete, func, insert, select

from app.documents import canonical_json
from app.store.records import Document, LogRecord
from app.store.tables import LOGS, now


def log_id(*, sha256: str, name: str, mapping: Document | None) -> str:
    """Give the id of a log."""
    return "log-" + hashlib.sha256(canonical_json([sha256, name, mapping])).hexdigest()[:20]


class LogStore:
    """Keep the summaries of logs in the database."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def add(self, identity: str, *, sha256: str, summary: Document) -> LogRecord:
        """Keep a log, or find it where it is known already."""
        values = {
            "id": identity,
            "sequence": select(func.coalesce(func.max(LOGS.c.sequence), 0) + 1).scalar_subquery(),
            "sha256": sha256,
            "document": json.dumps(summary),
            "created_at": now(),
        }
        with self._engine.begin() as connection:
            connection.execute(insert(LOGS).prefix_with("OR IGNORE").values(values))
            return _record(connection.execute(select(LOGS).where(LOGS.c.id == identity)).one())

    def get(self, identity: str) -> LogRecord | None:
        """Find a log."""
        with self._engine.connect() as connection:
            row = connection.execute(select(LOGS).where(LOGS.c.id == identity)).one_or_none()
        return None if row is None else _record(row)

    def page(self, *, limit: int, offset: int) -> tuple[list[LogRecord], int]:
        """List logs, the newest first, and count all of them."""
        newest = select(LOGS).order_by(LOGS.c.sequence.desc()).limit(limit).offset(offset)
        with self._engine.connect() as connection:
            total = connection.execute(select(func.count()).select_from(LOGS)).scalar_one()
            return [_record(row) for row in connection.execute(newest)], total

    def remove(self, identity: str) -> bool:
        """Forget a log, and say whether it was there."""
        with self._engine.begin() as connection:
            return connection.execute(delete(LOGS).where(LOGS.c.id == identity)).rowcount > 0

    def uses(self, sha256: str) -> bool:
        """Tell whether any log needs the bytes of a hash."""
        with self._engine.connect() as connection:
            query = select(func.count()).select_from(LOGS).where(LOGS.c.sha256 == sha256)
            return connection.execute(query).scalar_one() > 0


def _record(row: Row[tuple[object, ...]]) -> LogRecord:
    return LogRecord(row.id, row.sha256, json.loads(row.document), row.created_at)
