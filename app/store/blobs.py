"""Keep bytes under the hash of their content: a file is whole or not there.

Bytes are written aside, synced, then renamed; equal bytes are kept once. A name is a SHA-256 computed
here, never anything that a client sent.
"""

import errno
import fcntl
import hashlib
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Self

from .errors import Damaged, Unavailable

PIECE = 1 << 20
Mark = tuple[int, int]
"""Number of a file and when it was written: both differ where the same bytes were kept again."""


class Incoming:
    """Take bytes that arrive piece by piece, hashing them on the way; what is not kept is removed at the end.

    Attributes
    ----------
    path
        Where the bytes are meanwhile.
    size
        Bytes so far.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.size = 0
        self._hash = hashlib.sha256()
        self._file = path.open("xb")
        fcntl.flock(self._file, fcntl.LOCK_EX)  # says, as long as this process lives, that it is in use

    @property
    def sha256(self) -> str:
        """Give the hash of the bytes so far, in hexadecimal."""
        return self._hash.hexdigest()

    def write(self, piece: bytes) -> None:
        """Add bytes.

        Raises
        ------
        Unavailable
            If the disk is full.
        """
        with _room():
            self._file.write(piece)
        self._hash.update(piece)
        self.size += len(piece)

    def flush(self) -> None:
        """Let others read all bytes so far; they need not be on the disk yet.

        Raises
        ------
        Unavailable
            If the disk is full.
        """
        with _room():
            self._file.flush()

    def finish(self) -> None:
        """Put everything on the disk.

        Raises
        ------
        Unavailable
            If the disk is full.
        """
        if not self._file.closed:
            with _room():
                self._file.flush()
                os.fsync(self._file.fileno())
            self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with suppress(OSError):  # what could not be written is not wanted any more
            self._file.close()
        self.path.unlink(missing_ok=True)


class BlobStore:
    """Keep files by content.

    Parameters
    ----------
    root
        Directory to keep them in.
    """

    def __init__(self, root: Path) -> None:
        self._kept = root / "kept"
        self._aside = root / "incoming"
        for directory in (self._kept, self._aside):
            directory.mkdir(parents=True, exist_ok=True)

    def receive(self) -> Incoming:
        """Start to take bytes; use as a context manager."""
        return Incoming(self._aside / secrets.token_hex(16))

    def keep(self, incoming: Incoming) -> str:
        """Keep what was received and give its hash."""
        incoming.finish()
        target = self.path(incoming.sha256)
        target.parent.mkdir(exist_ok=True)
        incoming.path.replace(target)  # a new file each time, even of bytes that are known: see `Mark`
        directory = os.open(target.parent, os.O_RDONLY)
        try:
            os.fsync(directory)  # the new name is on the disk too
        finally:
            os.close(directory)
        return incoming.sha256

    def put(self, content: bytes) -> str:
        """Keep bytes that are all there and give their hash."""
        with self.receive() as incoming:
            incoming.write(content)
            return self.keep(incoming)

    def put_file(self, path: Path) -> str:
        """Keep a copy of a file and give its hash."""
        with path.open("rb") as file, self.receive() as incoming:
            while piece := file.read(PIECE):
                incoming.write(piece)
            return self.keep(incoming)

    @contextmanager
    def aside(self) -> Iterator[Path]:
        """Name a file for others to write, which is not there yet and is removed at the end."""
        folder = self._aside / secrets.token_hex(16)
        folder.mkdir()
        held = os.open(folder, os.O_RDONLY)
        fcntl.flock(held, fcntl.LOCK_EX)
        try:
            yield folder / "written"
        finally:
            shutil.rmtree(folder, ignore_errors=True)
            os.close(held)

    def path(self, sha256: str) -> Path:
        """Say where the bytes of a hash are kept."""
        return self._kept / sha256[:2] / sha256

    def read(self, sha256: str) -> bytes:
        """Give the bytes of a hash.

        Raises
        ------
        Damaged
            If they are missing or not what they were.
        """
        self.check(sha256)
        return self.path(sha256).read_bytes()

    def check(self, sha256: str) -> None:
        """Return where the bytes of a hash are what they were.

        Raises
        ------
        Damaged
            If they are missing or not what they were.
        """
        check_file(self.path(sha256), sha256)

    def marks(self) -> dict[str, Mark]:
        """List all bytes that are kept, with what tells whether they were kept again meanwhile."""
        return {path.name: mark for path in self._kept.glob("??/*") for mark in [_mark(path)] if mark}

    def remove(self, sha256: str, mark: Mark) -> None:
        """Forget bytes, unless they were kept again since they were marked."""
        aside = self._aside / secrets.token_hex(16)
        with suppress(FileNotFoundError):
            self.path(sha256).rename(aside)
            if _mark(aside) == mark:
                aside.unlink()
            else:
                aside.replace(self.path(sha256))

    def remove_leftovers(self) -> None:
        """Remove what was left half received; what another process is about to keep is locked, and stays."""
        for leftover in self._aside.iterdir():
            if _in_use(leftover):
                continue
            if leftover.is_dir():
                shutil.rmtree(leftover, ignore_errors=True)
            else:
                leftover.unlink(missing_ok=True)


def _in_use(path: Path) -> bool:
    """Tell whether a process that lives holds a file or folder that was set aside."""
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


@contextmanager
def _room() -> Iterator[None]:
    """Say in the store's own words that there is no room."""
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
            raise Unavailable("the disk is full") from error
        raise


def check_file(path: Path, sha256: str) -> None:
    """Return where the bytes of a file have a hash.

    Raises
    ------
    Damaged
        If they have another one, or cannot be read.
    """
    try:
        with path.open("rb") as file:
            found = hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise Damaged(sha256, f"it cannot be read: {error.strerror}") from None
    if found != sha256:
        raise Damaged(sha256, f"its hash is {found}")


def _mark(path: Path) -> Mark | None:
    try:
        found = path.stat()
    except FileNotFoundError:
        return None
    return found.st_ino, found.st_mtime_ns
