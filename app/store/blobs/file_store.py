"""Keep blobs as files in a directory: written beside, synced, then renamed."""

import fcntl
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BufferedIOBase
from pathlib import Path

from .blob_store import BlobStore, Mark
from .incoming import Incoming


class FileBlobStore(BlobStore):
    """Keep blobs in a directory; a mark is a file's number and the time it was written.

    Parameters
    ----------
    root
        The directory.
    """

    def __init__(self, root: Path) -> None:
        self._kept = root / "kept"
        self._incoming = root / "incoming"
        for directory in (self._kept, self._incoming):
            directory.mkdir(parents=True, exist_ok=True)

    def receive(self) -> Incoming:
        """Begin to receive bytes; use as a context manager."""
        return Incoming(self._incoming / secrets.token_hex(16))

    def keep(self, incoming: Incoming) -> str:
        """Keep what was received, and give its digest."""
        incoming.finish()
        target = self.path(incoming.sha256)
        target.parent.mkdir(exist_ok=True)
        incoming.path.replace(target)  # a new file each time, even for known bytes: see `Mark`
        directory = os.open(target.parent, os.O_RDONLY)
        try:
            os.fsync(directory)  # the new name is on the disk too
        finally:
            os.close(directory)
        return incoming.sha256

    def open(self, sha256: str) -> BufferedIOBase:
        """Open a blob for reading."""
        return self.path(sha256).open("rb")

    @contextmanager
    def local_copy(self, sha256: str) -> Iterator[Path]:
        """Give the file that holds a blob."""
        yield self.path(sha256)

    @contextmanager
    def scratch_file(self) -> Iterator[Path]:
        """Name a file beside those that are received, so that leftovers of a killed process are removed."""
        folder = self._incoming / secrets.token_hex(16)
        folder.mkdir()
        held = os.open(folder, os.O_RDONLY)
        fcntl.flock(held, fcntl.LOCK_EX)
        try:
            yield folder / "written"
        finally:
            shutil.rmtree(folder, ignore_errors=True)
            os.close(held)

    def path(self, sha256: str) -> Path:
        """Give the path at which a blob is kept."""
        return self._kept / sha256[:2] / sha256

    def marks(self) -> dict[str, Mark]:
        """List all blobs with their marks."""
        return {path.name: mark for path in self._kept.glob("??/*") for mark in [_mark(path)] if mark}

    def remove(self, sha256: str, mark: Mark) -> None:
        """Remove a blob, unless it was kept again since it had this mark."""
        removed = self._incoming / secrets.token_hex(16)
        with suppress(FileNotFoundError):
            self.path(sha256).rename(removed)
            if _mark(removed) == mark:
                removed.unlink()
            else:
                removed.replace(self.path(sha256))

    def remove_leftovers(self) -> None:
        """Remove what was left half received; what a living process receives is locked, and stays."""
        for leftover in self._incoming.iterdir():
            if _is_in_use(leftover):
                continue
            if leftover.is_dir():
                shutil.rmtree(leftover, ignore_errors=True)
            else:
                leftover.unlink(missing_ok=True)


def _is_in_use(path: Path) -> bool:
    """Return whether a living process holds a file or folder that is being received."""
    try:
        opened = os.open(path, os.O_RDONLY)
    except FileNotFoundError:  # it was kept or removed meanwhile
        return True
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(opened)
    return False


def _mark(path: Path) -> Mark | None:
    try:
        found = path.stat()
    except FileNotFoundError:
        return None
    return found.st_ino, found.st_mtime_ns
