"""Keep the hashes of API keys, from which no key can be read back.

A key is 32 random bytes, so that a plain hash of it is as safe as a slow one: there is nothing to guess.
"""

import hashlib
import secrets
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Row, and_, insert, select, update

from .database import Database
from .tables import KEYS, now

PREFIX = "vt_"


@dataclass(frozen=True)
class KeyRecord:
    """Keep a key: whose it is, and what it permits."""

    id: str
    tenant: str
    name: str
    scopes: tuple[str, ...]
    sha256: str
    created_at: str
    revoked_at: str | None


class KeyStore:
    """Keep the keys of all tenants."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def create(self, *, tenant: str, name: str, scopes: tuple[str, ...]) -> tuple[KeyRecord, str]:
        """Make a key; its secret is given here and never again."""
        secret = PREFIX + secrets.token_urlsafe(32)
        values = {
            "id": "key-" + secrets.token_hex(6),
            "tenant": tenant,
            "name": name,
            "scopes": " ".join(scopes),
            "sha256": digest(secret),
            "created_at": now(),
        }
        row = self._database.write(lambda c: c.execute(insert(KEYS).values(values).returning(KEYS)).one())
        return _record(row), secret

    def all(self) -> list[KeyRecord]:
        """List all keys, the oldest first."""
        query = select(KEYS).order_by(KEYS.c.created_at, KEYS.c.id)
        return self._database.read(lambda c: [_record(row) for row in c.execute(query)])

    def revoke(self, identity: str) -> bool:
        """Revoke a key, and say whether it was valid."""
        valid = and_(KEYS.c.id == identity, KEYS.c.revoked_at.is_(None))
        change = update(KEYS).where(valid).values(revoked_at=now())
        return self._database.write(lambda c: c.execute(change).rowcount > 0)


def digest(secret: str) -> str:
    """Give the hash by which a key is known."""
    return hashlib.sha256(secret.encode()).hexdigest()


def _record(row: Row[Any]) -> KeyRecord:
    return KeyRecord(
        row.id, row.tenant, row.name, tuple(row.scopes.split()), row.sha256, row.created_at, row.revoked_at
    )
