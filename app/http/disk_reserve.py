"""Keep some of the disk free: a full one would stop the database, and with it what is under way."""

import shutil
from pathlib import Path

from ..problems import Problem


class DiskReserve:
    """Know how much may still be taken.

    Parameters
    ----------
    directory
        On the disk that is meant.
    reserve_bytes
        What has to stay free.
    """

    def __init__(self, directory: Path, reserve_bytes: int) -> None:
        self._directory, self._reserve_bytes = directory, reserve_bytes

    @property
    def left(self) -> int:
        """Give the bytes that may still be taken, less than none where the reserve is touched."""
        return shutil.disk_usage(self._directory).free - self._reserve_bytes

    def require(self, more: int = 0) -> None:
        """Ask for room.

        Raises
        ------
        Problem
            If there is none (507).
        """
        left = self.left
        if left < more:
            raise Problem(
                "disk-full",
                "the disk is nearly full",
                evidence={
                    "left_bytes": max(left, 0),
                    "asked_bytes": more,
                    "reserve_bytes": self._reserve_bytes,
                },
                remedy="delete logs and jobs, or let the operator make room or lower "
                "VERITORQUE_DISK_RESERVE_BYTES",
            )
