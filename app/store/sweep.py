"""Remove bytes that no record needs any more, without ever asking a clock how old they are.

Bytes are written before the record that needs them, so young ones may look needless for a moment. What was
needless at one look and has not been touched until the next, a while later, is removed; `BlobStore.keep`
touches what it is given again.
"""

from .blobs import Mark
from .store import Store


class Sweep:
    """Look for needless bytes again and again."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._needless: dict[str, Mark] = {}

    def look(self) -> int:
        """Remove what was needless at the last look already, and count it."""
        marks = self._store.blobs.marks()
        needed = self._store.needed()
        needless = {sha256: mark for sha256, mark in marks.items() if sha256 not in needed}
        removed = 0
        for sha256, mark in needless.items():
            if self._needless.get(sha256) == mark and not self._store.needs(sha256):
                self._store.blobs.remove(sha256, mark)
                removed += 1
        self._needless = needless
        return removed
