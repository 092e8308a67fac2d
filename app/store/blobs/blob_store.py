"""Define what a blob store does, whatever it keeps its bytes in.

A blob is whole or not there, and is named by its SHA-256, which is computed here and never taken from a
client. Equal bytes are kept once. Readers of logs need a file, and ask for a local copy.
"""

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import AbstractContextManager
from io import BufferedIOBase
from pathlib import Path

from ..errors import DamagedError
from .incoming import CHUNK_BYTES, Incoming

Mark = tuple[int, int]
"""Identifies one keeping of a blob: it differs where the same bytes were kept again."""


class BlobStore(ABC):
    """Keep bytes by their digests."""

    @abstractmethod
    def receive(self) -> Incoming:
        """Begin to receive bytes; use as a context manager."""

    @abstractmethod
    def keep(self, incoming: Incoming) -> str:
        """Keep what was received, and give its digest."""

    @abstractmethod
    def open(self, sha256: str) -> BufferedIOBase:
        """Open a blob for reading.

        Raises
        ------
        FileNotFoundError
            If it is missing.
        """

    @abstractmethod
    def local_copy(self, sha256: str) -> AbstractContextManager[Path]:
        """Give a local file that holds a blob, to be read only, until the context ends.

        A missing blob gives a path without a file, which `check_file` reports as damage.
        """

    @abstractmethod
    def scratch_file(self) -> AbstractContextManager[Path]:
        """Name a local file to be written, which does not exist yet and is removed at the end."""

    @abstractmethod
    def marks(self) -> dict[str, Mark]:
        """List all blobs with their marks."""

    @abstractmethod
    def remove(self, sha256: str, mark: Mark) -> None:
        """Remove a blob, unless it was kept again since it had this mark."""

    @abstractmethod
    def remove_leftovers(self) -> None:
        """Remove what was left half received by processes that have ended."""

    def put(self, content: bytes) -> str:
        """Keep bytes, and give their digest."""
        with self.receive() as incoming:
            incoming.write(content)
            return self.keep(incoming)

    def put_file(self, path: Path) -> str:
        """Keep a copy of a file, and give its digest."""
        with path.open("rb") as file, self.receive() as incoming:
            while chunk := file.read(CHUNK_BYTES):
                incoming.write(chunk)
            return self.keep(incoming)

    def read(self, sha256: str) -> bytes:
        """Read a blob.

        Raises
        ------
        DamagedError
            If it is missing, or its bytes do not have its digest.
        """
        try:
            with self.open(sha256) as stream:
                content = stream.read()
        except OSError as error:
            raise _unreadable(sha256, error) from None
        _require(sha256, hashlib.sha256(content).hexdigest())
        return content

    def check(self, sha256: str) -> None:
        """Return where a blob is there and whole.

        Raises
        ------
        DamagedError
            If it is missing, or its bytes do not have its digest.
        """
        _check(lambda: self.open(sha256), sha256)


def check_file(path: Path, sha256: str) -> None:
    """Return where the bytes of a file have a digest.

    Raises
    ------
    DamagedError
        If they have another one, or cannot be read.
    """
    _check(lambda: path.open("rb"), sha256)


def _check(opened: Callable[[], BufferedIOBase], sha256: str) -> None:
    try:
        with opened() as stream:
            found = hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise _unreadable(sha256, error) from None
    _require(sha256, found)


def _require(sha256: str, found: str) -> None:
    if found != sha256:
        raise DamagedError(sha256, f"its hash is {found}")


def _unreadable(sha256: str, error: OSError) -> DamagedError:
    return DamagedError(sha256, f"it cannot be read: {error.strerror}")
