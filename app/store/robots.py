"""Keep robots by their content: the same description is the same robot under the same id."""

import hashlib
import json
from typing import Any

from sqlalchemy import Connection, Row, select

from ..json_text import canonical_json
from .database import insert_if_new
from .records import Document, RobotRecord
from .tables import ROBOTS, now, robot_record
from .tenant_records import TenantRecords


class RobotStore(TenantRecords[RobotRecord]):
    """Keep one tenant's robots in the database."""

    table = ROBOTS

    def _record(self, row: Row[Any]) -> RobotRecord:
        return robot_record(row)

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
