"""Show that a worker is alive by a file lock, which the system releases however the worker dies.

A worker locks a file of its name. A process that gets the lock of another worker knows that it is gone.
Workers on other machines and frozen ones cannot be judged this way: their heartbeats in the database have to
stop for a while first.
"""

import fcntl
import os
import secrets
import socket
from pathlib import Path


class Presence:
    """Hold the lock of a new worker.

    Parameters
    ----------
    directory
        Where the workers of this machine keep their files.

    Attributes
    ----------
    name
        The worker's name, which no other worker ever has.
    """

    def __init__(self, directory: Path) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        self.name = f"{socket.gethostname()}-{secrets.token_hex(6)}"
        self._directory = directory
        self._file = os.open(directory / self.name, os.O_CREAT | os.O_RDWR, 0o600)
        fcntl.flock(self._file, fcntl.LOCK_EX)

    def is_gone(self, other: str) -> bool:
        """Return whether another worker is known to be dead."""
        path = self._directory / other
        try:
            file = os.open(path, os.O_RDWR)
        except OSError:
            return False
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return False
        finally:
            os.close(file)
        return True

    def tidy(self) -> None:
        """Remove the files of ended workers that no job names any more; call it when their jobs are taken."""
        for path in self._directory.iterdir():
            if path.name != self.name and self.is_gone(path.name):
                path.unlink(missing_ok=True)

    def leave(self) -> None:
        """Release the lock, and remove the file."""
        (self._directory / self.name).unlink(missing_ok=True)
        os.close(self._file)
