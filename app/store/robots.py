"""Keep robots by their content: the same description is the same robot under the same id."""

import hashlib
import json

from sqlalchemy import ColumnElement, Connection, and_, delete, select

from ..json_text import canonical_json
from .database import Database, insert_if_new
from .records import Document, RobotRecord
from .tables import ROBOTS, now, robot_record


class RobotStore:
    """Keep one tenant's robots in the database."""

    def __init__(self, database: Database, tenant: str) -> None:
        self._database, self._tenant = database, tenant

    def add(
        self, *, name: str, joints: int, description: Document, suspicions: tuple[str, ...]
    ) -> RobotRecord:
        """Keep a robot, or find it where it is known already."""
        identity = "robot-" + hashlib.sha256(canonical_json(description)).hexdigest()[:20]
        document = {
            "name": name,
            "joints": joints,
            "description": description,
            "suspicions": list(suspicions),
        }
        values = {
            "tenant": self._tenant,
            "id": identity,
            "document": json.dumps(document),
            "created_at": now(),
        }

        def work(connection: Connection) -> RobotRecord:
            insert_if_new(connection, ROBOTS, values)
            return robot_record(connection.execute(select(ROBOTS).where(self._own(identity))).one())

        return self._database.write(work)

    def get(self, identity: str) -> RobotRecord | None:
        """Find a robot."""
        query = select(ROBOTS).where(self._own(identity))
        row = self._database.read(lambda connection: connection.execute(query).one_or_none())
        return None if row is None else robot_record(row)

    def page(self, *, limit: int, before: int | None = None) -> list[RobotRecord]:
        """List robots, the newest first, from before a sequence number on."""
        query = select(ROBOTS).where(ROBOTS.c.tenant == self._tenant).order_by(ROBOTS.c.sequence.desc())
        if before is not None:
            query = query.where(ROBOTS.c.sequence < before)
        return self._database.read(
            lambda connection: [robot_record(row) for row in connection.execute(query.limit(limit))]
        )

    def remove(self, identity: str) -> bool:
        """Forget a robot, and say whether it was there."""
        gone = delete(ROBOTS).where(self._own(identity))
        return self._database.write(lambda connection: connection.execute(gone).rowcount > 0)

    def _own(self, identity: str) -> ColumnElement[bool]:
        return and_(ROBOTS.c.tenant == self._tenant, ROBOTS.c.id == identity)
