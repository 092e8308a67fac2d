"""Receive bytes into a local file, and hash them on the way."""

import errno
import fcntl
import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Self

from ..errors import UnavailableError

CHUNK_BYTES = 1 << 20


class Incoming:
    """Receive bytes in chunks and hash them; what is not kept is removed at the end.

    Attributes
    ----------
    path
        Local file that holds the bytes so far.
    size
        Bytes so far.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.size = 0
        self._hash = hashlib.sha256()
        self._file = path.open("xb")
        fcntl.flock(self._file, fcntl.LOCK_EX)  # marks the file as in use as long as this process lives

    @property
    def sha256(self) -> str:
        """Give the hash of the bytes so far, in hexadecimal."""
        return self._hash.hexdigest()

    def write(self, chunk: bytes) -> None:
        """Add bytes.

        Raises
        ------
        UnavailableError
            If the disk is full.
        """
        with _room():
            self._file.write(chunk)
        self._hash.update(chunk)
        self.size += len(chunk)

    def flush(self) -> None:
        """Make all bytes so far readable for others; they need not be on the disk yet.

        Raises
        ------
        UnavailableError
            If the disk is full.
        """
        with _room():
            self._file.flush()

    def finish(self) -> None:
        """Write everything to the disk.

        Raises
        ------
        UnavailableError
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


@contextmanager
def _room() -> Iterator[None]:
    """Turn the system's errors for a full disk into the store's own."""
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
            raise UnavailableError("the disk is full") from error
        raise
