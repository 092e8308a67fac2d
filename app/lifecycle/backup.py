"""Make a backup while the service runs, and restore one into an empty data directory.

A backup is a data directory of its own with an embedded database, whatever the database of the service is, so
that a restore may also move from SQLite to PostgreSQL or back. Its note is written last: without it the
backup is not complete.
"""

import json
from pathlib import Path

from ..store.store import Store
from ..store.tables import now
from ..version import VERSION
from .copying import copy_store, is_empty

NOTE = "backup.json"


class NoBackupError(Exception):
    """Say why a backup cannot be made or restored, and what to do about it."""


def back_up(store: Store, directory: Path) -> dict[str, int]:
    """Copy a store into a new directory, and count what was copied.

    Raises
    ------
    NoBackupError
        If there is something in the directory already.
    DamagedError
        If bytes are missing or damaged.
    """
    if directory.exists() and any(directory.iterdir()):
        raise NoBackupError(f"there is something in {directory} already; name a new directory")
    copy = Store(directory)
    try:
        counts = copy_store(store, copy)
    finally:
        copy.close()
    note = {"version": VERSION, "finished_at": now(), "counts": counts}
    (directory / NOTE).write_text(json.dumps(note, indent=2) + "\n", encoding="utf-8")
    return counts


def restore(directory: Path, store: Store) -> dict[str, int]:
    """Copy a backup into an empty store, and count what was copied.

    Raises
    ------
    NoBackupError
        If the directory holds no complete backup, or the store is not empty.
    DamagedError
        If bytes are missing or damaged.
    """
    if not (directory / NOTE).is_file():
        raise NoBackupError(f"{directory} holds no complete backup: it has no {NOTE}; name another directory")
    if not is_empty(store):
        raise NoBackupError("there is data already where the backup would go; choose an empty data directory")
    backup = Store(directory)
    try:
        return copy_store(backup, store)
    finally:
        backup.close()
