"""Copy a whole store into an empty one, consistently, while the first is in use.

Bytes never change once they are kept, so most are copied first; then the rows as one instant saw them; then
the bytes that had come in between. Bytes that a row of that instant needs outlive the copying, because a
sweep needs two passes, a while apart, before it removes anything.
"""

from collections.abc import Set as AbstractSet

from sqlalchemy import Connection, insert, select, text

from ..store.blobs.blob_store import BlobStore
from ..store.blobs.incoming import CHUNK_BYTES
from ..store.errors import DamagedError
from ..store.store import Store
from ..store.tables import METADATA

ROWS_TOGETHER = 500


def copy_store(source: Store, target: Store) -> dict[str, int]:
    """Copy everything, and count it: rows by table, and ``blobs``.

    Raises
    ------
    DamagedError
        If bytes that a row needs are missing or not what they were; the copy is then not complete.
    """
    copied = _copy_blobs(source.blobs, target.blobs, source.needed(), patient=True)
    counts = source.database.snapshot(
        lambda rows: target.database.write(lambda empty: copy_rows(rows, empty))
    )
    copied |= _copy_blobs(source.blobs, target.blobs, target.needed() - copied, patient=False)
    return counts | {"blobs": len(copied)}


def copy_rows(source: Connection, target: Connection) -> dict[str, int]:
    """Copy all rows of all tables with their numbers, and count them by table."""
    counts = {}
    for table in METADATA.sorted_tables:
        counts[table.name] = 0
        for part in source.execute(select(table)).mappings().partitions(ROWS_TOGETHER):
            target.execute(insert(table), [dict(row) for row in part])
            counts[table.name] += len(part)
        if target.dialect.name == "postgresql" and "sequence" in table.columns:
            last = f"(SELECT coalesce(max(sequence), 0) + 1 FROM {table.name})"  # noqa: S608 - our own table
            target.execute(
                text(f"SELECT setval(pg_get_serial_sequence('{table.name}', 'sequence'), {last}, false)")
            )
    return counts


def is_empty(store: Store) -> bool:
    """Return whether a store holds nothing."""
    return store.database.read(
        lambda connection: all(
            connection.execute(select(table).limit(1)).first() is None for table in METADATA.sorted_tables
        )
    )


def _copy_blobs(source: BlobStore, target: BlobStore, wanted: AbstractSet[str], *, patient: bool) -> set[str]:
    """Copy bytes by their hashes; those that are missing are an error unless there is a second time."""
    copied = set()
    for sha256 in wanted:
        try:
            _copy_blob(source, target, sha256)
        except FileNotFoundError:
            if patient:
                continue
            raise DamagedError(sha256, "it is missing") from None
        copied.add(sha256)
    return copied


def _copy_blob(source: BlobStore, target: BlobStore, sha256: str) -> None:
    with source.open(sha256) as file, target.receive() as incoming:
        while chunk := file.read(CHUNK_BYTES):
            incoming.write(chunk)
        if incoming.sha256 != sha256:
            raise DamagedError(sha256, f"its hash is {incoming.sha256}")
        target.keep(incoming)
