"""Let one service at a time use a data directory: two would each remove what the other is receiving.

The system releases the lock however the service dies.
"""

import fcntl
import os
from pathlib import Path


class DirectoryInUseError(Exception):
    """Say that another service uses a data directory."""


class DirectoryLock:
    """Hold a directory until it is released.

    Raises
    ------
    DirectoryInUseError
        If another service holds it.
    """

    def __init__(self, directory: Path) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        self._file = os.open(directory / "service.lock", os.O_CREAT | os.O_RDWR, 0o600)
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(self._file)
            raise DirectoryInUseError(str(directory)) from None

    def release(self) -> None:
        """Release it."""
        os.close(self._file)
