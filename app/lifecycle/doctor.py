"""Examine what is kept, and say of each thing that is wrong what to do about it.

It changes nothing but for a probe that it takes back, and may run while the service does.
"""

import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import func, select, text
from sqlalchemy.exc import SQLAlchemyError

from ..settings import Settings
from ..store.errors import DamagedError, UnavailableError
from ..store.store import Store
from ..store.tables import METADATA

OTHERS_MAY = 0o077
SHOWN = 5


@dataclass(frozen=True)
class Finding:
    """Hold what was checked and what was found."""

    subject: str
    """What was checked."""
    seen: str
    """What is the case."""
    remedy: str = ""
    """What to do; empty where all is well."""
    harm: bool = False
    """Whether something is lost, wrong or will stop; otherwise a remedy is advice."""


def examine(settings: Settings) -> Iterator[Finding]:
    """Check everything, and give the findings one by one."""
    directory = settings.data_dir
    if not directory.is_dir():
        remedy = "set VERITORQUE_DATA_DIR, or start the service once"
        yield _fault("directory", f"{directory} does not exist", remedy)
        return
    yield from _directory(directory)
    yield _disk(settings)
    try:
        store = Store(directory, settings.database_url)
    except (SQLAlchemyError, UnavailableError, OSError) as error:
        yield _unreachable(settings, error)
        return
    try:
        yield from _database(store)
        yield from _blobs(store)
    except (SQLAlchemyError, UnavailableError) as error:
        yield _unreachable(settings, error)
    finally:
        store.close()


def _directory(directory: Path) -> Iterator[Finding]:
    foreign = [path for path in _all(directory) if path.stat().st_uid != os.getuid()]
    closed = [path for path in _all(directory) if not os.access(path, os.R_OK | os.W_OK)]
    if closed:
        remedy = f"as the owner: chmod --recursive u+rwX {directory}"
        yield _fault("permissions", f"may not be read and written: {_sample(closed)}", remedy)
    elif foreign:
        remedy = f"chown --recursive {os.getuid()} {directory}, and run this as the service's user"
        yield Finding("permissions", f"belong to another user: {_sample(foreign)}", remedy)
    elif directory.stat().st_mode & OTHERS_MAY:
        yield Finding("permissions", "other users may look into the directory", f"chmod 700 {directory}")
    else:
        yield Finding("permissions", "everything belongs to this user and nobody else may look")


def _disk(settings: Settings) -> Finding:
    free, reserve = shutil.disk_usage(settings.data_dir).free, settings.disk_reserve_bytes
    if free < reserve:
        remedy = "make room, delete logs and jobs, run: veritorque gc, or lower VERITORQUE_DISK_RESERVE_BYTES"
        return _fault("disk", f"{free} bytes are free, the reserve is {reserve}", remedy)
    return Finding("disk", f"{free} bytes are free, the reserve is {reserve}")


def _unreachable(settings: Settings, error: Exception) -> Finding:
    reason = str(getattr(error, "orig", None) or error).strip().splitlines()[0]
    if settings.database_url is None:
        remedy = "stop the service, move the data directory aside, and restore a backup into a new one"
    else:
        remedy = "see that PostgreSQL runs, and that VERITORQUE_DATABASE_URL names it with user and password"
    return _fault("database", reason, remedy)


def _database(store: Store) -> Iterator[Finding]:
    if store.database.embedded:
        found = store.database.read(lambda c: c.execute(text("PRAGMA integrity_check")).scalars().all())
        if list(found) != ["ok"]:
            remedy = "stop the service, move the data directory aside, and restore a backup into a new one"
            yield _fault("database", f"SQLite finds: {'; '.join(found[:SHOWN])}", remedy)
            return
    store.prove_writable()
    counts = store.database.read(
        lambda c: {
            table.name: c.execute(select(func.count()).select_from(table)).scalar_one()
            for table in METADATA.sorted_tables
        }
    )
    yield Finding("database", "whole and writable: " + ", ".join(f"{n} {name}" for name, n in counts.items()))


def _damaged(store: Store, kept: list[str]) -> Iterator[str]:
    """Name the blobs whose bytes do not have their digest."""
    for sha256 in kept:
        try:
            store.blobs.check(sha256)
        except DamagedError as error:
            yield f"{sha256} ({error.evidence})"


def _missing(store: Store, needed: list[str]) -> Iterator[str]:
    """Name the blobs that are not there: some may have been kept since they were listed."""
    for sha256 in needed:
        if not _exists(store, sha256):
            yield sha256


def _blobs(store: Store) -> Iterator[Finding]:
    kept = store.blobs.marks().keys()
    needed = store.needed()  # after the files are listed: a blob is written before its record
    damaged = list(_damaged(store, sorted(kept & needed)))
    missing = list(_missing(store, sorted(needed - kept)))
    lost = "restore them from a backup, or delete the logs and jobs that need them: "
    for subject, found in (("damaged bytes", damaged), ("missing bytes", missing)):
        if found:
            users = store.users([blob.split()[0] for blob in found[:SHOWN]])
            yield _fault(subject, f"{len(found)}: {_sample(found)}", lost + _sample(users))
    if not damaged and not missing:
        yield Finding("bytes", f"{len(needed)} files that logs and jobs need are there and have their hashes")
    orphans = kept - needed
    if orphans:
        yield Finding("bytes", f"{len(orphans)} files are not needed by anything", "run: veritorque gc")


def _exists(store: Store, sha256: str) -> bool:
    try:
        store.blobs.open(sha256).close()
    except OSError as error:
        return not isinstance(error, FileNotFoundError)
    return True


def _all(directory: Path) -> Iterator[Path]:
    yield directory
    yield from directory.rglob("*")


def _fault(subject: str, seen: str, remedy: str) -> Finding:
    return Finding(subject, seen, remedy, harm=True)


def _sample(items: list[str] | list[Path]) -> str:
    shown = ", ".join(str(item) for item in items[:SHOWN])
    return shown + (" ..." if len(items) > SHOWN else "")
