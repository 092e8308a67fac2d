"""Write the files that a command was asked for, and say so."""

import os
from pathlib import Path

from ....core.errors import OptionError
from .streams import note


def means_a_file(given: str) -> bool:
    """Tell a file, there or not, from the id of something that a service keeps."""
    return "/" in given or not given.strip(".") or Path(given).is_file()


def save(path: Path, content: bytes) -> None:
    """Write a file and say so.

    Raises
    ------
    OptionError
        If that cannot be.
    """
    try:
        path.write_bytes(content)
    except OSError as error:
        raise _unwritable(path, error.strerror or "") from error
    note(f"saved {path}")


def require_folder(path: Path) -> None:
    """Return where a file could be written, before an hour is spent on what goes into it.

    Raises
    ------
    OptionError
        If its folder is not there, or the file is a folder.
    """
    if path.is_dir():
        raise _unwritable(path, "it is a folder")
    if not path.parent.is_dir():
        raise _unwritable(path, "its folder does not exist")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise _unwritable(path, "permission denied")


def _unwritable(path: Path, reason: str) -> OptionError:
    return OptionError(
        f"{path} cannot be written",
        evidence={"reason": reason},
        remedy="name a file in an existing, writable folder with free space",
    )
