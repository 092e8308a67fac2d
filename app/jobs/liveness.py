"""Show that a worker lives, in a way that the system itself takes back when it dies, however it dies.

A worker holds a lock on a file of its name; the system lets go of it even after kill -9. Whoever gets the
lock of another worker knows that it is gone. On other machines, and of a worker that is frozen, nothing can
be known this way: there its beats in the database have to stop for a while first.
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
        """Tell whether another worker is known to be dead."""
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
        """Remove the files of the dead of whom no job speaks any more; call it when their jobs are taken."""
        for path in self._directory.iterdir():
            if path.name != self.name and self.is_gone(path.name):
                path.unlink(missing_ok=True)

    def leave(self) -> None:
        """Let go of the lock, and remove the file."""
        (self._directory / self.name).unlink(missing_ok=True)
        os.close(self._file)
