"""Turn whatever a file format's library raises into a `LogError`: no foreign exception leaves the package.

Damaged files make these libraries raise nearly anything; one gate per format says which format it was and
what was seen.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import LogError, VeritorqueError


@contextmanager
def reading(form: str, path: Path) -> Iterator[None]:
    """Guard the reading of a file: our own errors and want of memory pass, every other is "cannot be read".

    Parameters
    ----------
    form
        The format's name, for the message.
    path
        The file; only its size is reported, never its path.

    Raises
    ------
    LogError
        In place of any exception of a foreign library.
    """
    try:
        yield
    except (VeritorqueError, MemoryError):
        raise
    except Exception as error:
        size = path.stat().st_size if path.exists() else 0
        text = " ".join(str(error).replace(str(path), "the file").split())
        raise LogError(
            f"the {form} file cannot be read: it is damaged, cut short or not written as the format demands",
            evidence={"format": form, "bytes": size, "detail": f"{type(error).__name__}: {text[:300]}"},
            remedy="write the file again and upload it whole",
        ) from error
