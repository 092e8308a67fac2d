"""Know the keys without asking the database at every request: the list is read again every few seconds.

A key that is revoked elsewhere stops working within that time. Hashes are compared in constant time.
"""

import hmac
import threading
import time

from ..store.database import Database
from ..store.keys import KeyRecord, KeyStore, digest

FRESH_S = 2.0


class KeyRing:
    """Find keys by their secrets among those that were read last."""

    def __init__(self, database: Database) -> None:
        self._store = KeyStore(database)
        self._lock = threading.Lock()
        self._known: dict[str, KeyRecord] = {}
        self._until = 0.0
        self.read()

    def find(self, secret: str) -> KeyRecord | None:
        """Give the valid key of a secret; None where there is none."""
        asked = digest(secret)
        found = self._known.get(asked)
        return found if found is not None and hmac.compare_digest(found.sha256, asked) else None

    def any(self) -> bool:
        """Return whether there is a valid key."""
        return bool(self._known)

    @property
    def fresh(self) -> bool:
        """Return whether the keys were read recently."""
        return time.monotonic() < self._until

    def read(self) -> None:
        """Read the keys again, unless another thread just did."""
        with self._lock:
            if not self.fresh:
                self._known = {key.sha256: key for key in self._store.all() if key.revoked_at is None}
                self._until = time.monotonic() + FRESH_S
