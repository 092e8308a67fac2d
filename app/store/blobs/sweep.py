"""Remove blobs that no record needs any more, without comparing times.

A blob is written before the record that needs it, so a new one may be without a record for a moment. A blob
is removed if it was without a record in two passes in a row, a while apart, and was not kept again between
them, which `BlobStore.marks` shows.
"""

from ..store import Store
from .blob_store import Mark


class Sweep:
    """Search for blobs without a record, repeatedly."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._unneeded: dict[str, Mark] = {}

    def run(self) -> int:
        """Remove what was without a record in the last pass already, and count it."""
        marks = self._store.blobs.marks()
        needed = self._store.needed()
        unneeded = {sha256: mark for sha256, mark in marks.items() if sha256 not in needed}
        removed = 0
        for sha256, mark in unneeded.items():
            if self._unneeded.get(sha256) == mark and not self._store.needs(sha256):
                self._store.blobs.remove(sha256, mark)
                removed += 1
        self._unneeded = unneeded
        return removed
