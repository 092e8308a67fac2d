"""Keep robots by their content: the same description is the same robot under the same id."""

import hashlib
import json

from sqlalchemy import Engine, Row, delete, func, insert, select

from app.documents import canonical_json
from app.store.records import Document, RobotRecord
from app.store.tables import ROBOTS, now


class RobotStore:
    """Keep robots in the database."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

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
            "id": identity,
            "sequence": select(func.coalesce(func.max(ROBOTS.c.sequence), 0) + 1).scalar_subquery(),
            "document": json.dumps(document),
            "created_at": now(),
        }
        with self._engine.begin() as connection:
            connection.execute(insert(ROBOTS).prefix_with("OR IGNORE").values(values))
            return _record(connection.execute(select(ROBOTS).where(ROBOTS.c.id == identity)).one())

    def get(self, identity: str) -> RobotRecord | None:
        """Find a robot."""
        with self._engine.connect() as connection:
            row = connection.execute(select(ROBOTS).where(ROBOTS.c.id == identity)).one_or_none()
        return None if row is None else _record(row)

    def page(self, *, limit: int, offset: int) -> tuple[list[RobotRecord], int]:
        """List robots, the newest first, and count all of them."""
        newest = select(ROBOTS).order_by(ROBOTS.c.sequence.desc()).limit(limit).offset(offset)
        with self._engine.connect() as connection:
            total = connection.execute(select(func.count()).select_from(ROBOTS)).scalar_one()
            return [_record(row) for row in connection.execute(newest)], total

    def remove(self, identity: str) -> bool:
        """Forget a robot, and say whether it was there."""
        with self._engine.begin() as connection:
            return connection.execute(delete(ROBOTS).where(ROBOTS.c.id == identity)).rowcount > 0


def _record(row: Row[tuple[object, ...]]) -> RobotRecord:
    document = json.loads(row.document)
    return RobotRecord(
        id=row.id,
        name=document["name"],
        joints=document["joints"],
        built_in=False,
        description=document["description"],
        suspicions=tuple(document["suspicions"]),
        created_at=row.created_at,
    )
