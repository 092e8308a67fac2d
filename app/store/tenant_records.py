"""Find, list and remove what one tenant has in a table: robots, logs and jobs alike."""

from functools import cache
from typing import Any, ClassVar, Generic, TypeVar

from sqlalchemy import ColumnElement, Connection, Row, Select, Table, and_, bindparam, delete, select

from .database import Database
from .records import UNBOUNDED, Quota

Record = TypeVar("Record")


@cache
def _find(table: Table) -> Select[Any]:
    return select(table).where(table.c.tenant == bindparam("tenant"), table.c.id == bindparam("id"))


class TenantRecords(Generic[Record]):
    """Keep one tenant's records in a table; a subclass names the table and reads its rows."""

    table: ClassVar[Table]

    def __init__(self, database: Database, tenant: str, quota: Quota = UNBOUNDED) -> None:
        self._database, self._tenant, self._quota = database, tenant, quota

    def _record(self, row: Row[Any]) -> Record:
        raise NotImplementedError

    def get(self, identity: str) -> Record | None:
        """Find a record by its id."""
        return self._database.read(lambda connection: self._find(connection, identity))

    def page(self, *, limit: int, before: int | None = None) -> list[Record]:
        """List records, the newest first, from before a sequence number on."""
        table = self.table.c
        query = select(self.table).where(table.tenant == self._tenant).order_by(table.sequence.desc())
        if before is not None:
            query = query.where(table.sequence < before)
        return self._database.read(
            lambda connection: [self._record(row) for row in connection.execute(query.limit(limit))]
        )

    def remove(self, identity: str) -> bool:
        """Delete a record, and say whether it was there."""
        return self._removed(self._own(identity))

    def _removed(self, which: ColumnElement[bool]) -> bool:
        gone = delete(self.table).where(which)
        return self._database.write(lambda connection: connection.execute(gone).rowcount > 0)

    def _own(self, identity: str) -> ColumnElement[bool]:
        return and_(self.table.c.tenant == self._tenant, self.table.c.id == identity)

    def _find(self, connection: Connection, identity: str) -> Record | None:
        found = connection.execute(_find(self.table), {"tenant": self._tenant, "id": identity})
        row = found.one_or_none()
        return None if row is None else self._record(row)
