"""Hold what all file formats have in common: named columns of numbers, given in batches of rows.

A format knows nothing of joints or units; it only says which columns there are and reads those it is asked
for. The limits stop a small file from asking for a large machine. Damaged files make a format's library raise
nearly anything; one gate per format says which format it was and what was seen.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import prod
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np

from ...arrays import Series
from ...errors import LogError, VeritorqueError

MAX_COLUMNS = 512
LONGEST_NAME = 256
MAX_ROWS = 50_000_000
MAX_VALUES_IN_MEMORY = 40_000_000
"""Numbers which a format that cannot be streamed may hold: 320 MB as float64."""
MAX_UNPACKING = 64
FREE_BYTES = 1 << 24
"""Real logs unpack to five times their bytes, coarse ones to twenty; short ones are not limited."""
BATCH_ROWS = 32_768
BY_NUMBER = "column_"
"""Begins the name of a column that has none; its number from 1 follows."""


@runtime_checkable
class Table(Protocol):
    """Give named columns of one length, batch by batch."""

    @property
    def names(self) -> tuple[str, ...]:
        """List the columns in the file's order."""

    @property
    def texts(self) -> tuple[str, ...]:
        """Name the columns of text that can be read."""

    @property
    def units(self) -> Mapping[str, str]:
        """Give what the file itself says of its columns' units, outside their names."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Say what was done to get columns out of a file that is no plain table."""

    def words(self, name: str) -> list[str]:
        """Read a column of text."""

    def batches(self, names: Sequence[str]) -> Iterator[Series]:
        """Read the named columns from the first row on; one array of columns by rows per batch."""


@dataclass(frozen=True, eq=False)
class MemoryTable:
    """Give columns that are already in memory, as NPZ and MAT files leave them."""

    columns: Mapping[str, np.ndarray | None]
    """One-dimensional arrays by name; None where a column is not made of numbers."""
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """List the columns in the file's order."""
        return tuple(self.columns)

    @property
    def texts(self) -> tuple[str, ...]:
        """Name the columns of text that can be read: none."""
        return ()

    def words(self, name: str) -> list[str]:
        """Refuse: text is not kept."""
        raise not_numeric(name, "text")

    def batches(self, names: Sequence[str]) -> Iterator[Series]:
        """Give all rows in one batch."""
        found = []
        for name in names:
            column = self.columns[name]
            if column is None:
                raise not_numeric(name, "text, a structure or complex numbers")
            found.append(column)
        lengths = {name: len(column) for name, column in zip(names, found, strict=True)}
        if len(set(lengths.values())) > 1:
            raise LogError(
                "the columns are of different lengths",
                evidence={"lengths": lengths},
                remedy="give every channel one value per sample",
            )
        check_values(len(names) * max(lengths.values(), default=0))
        yield np.array(found, dtype=np.float64).reshape(len(names), -1)


def expand(variables: Mapping[str, np.ndarray | None]) -> MemoryTable:
    """Turn named arrays into columns: a matrix `q` of samples by n becomes `q_1` to `q_n`.

    The longer side of a matrix is taken as its samples, whichever way it was stored: a log has at least a
    hundred samples and an arm has fewer joints. A vector keeps its name. What is no vector or matrix of
    numbers is kept as a name without values.

    Examples
    --------
    >>> table = expand({"time": np.arange(3.0), "q": np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])})
    >>> table.names
    ('time', 'q_1', 'q_2')
    """
    shapes = {name: values.shape for name, values in variables.items() if values is not None}
    check_columns([f"{name}_{index}" for name, shape in shapes.items() for index in range(_width(shape))])
    columns: dict[str, np.ndarray | None] = {}
    for name, values in variables.items():
        for column, series in _split(name, values):
            if column in columns:
                raise duplicate_columns([column])
            columns[column] = series
    return MemoryTable(columns)


def _width(shape: tuple[int, ...]) -> int:
    """Count the columns that an array of this shape expands to."""
    return min(shape) if len(shape) == 2 else 1


def _split(name: str, values: np.ndarray | None) -> Iterator[tuple[str, np.ndarray | None]]:
    if values is None or values.ndim not in (1, 2) or values.dtype.kind not in "iuf":
        yield name, None
    elif values.ndim == 1 or 1 in values.shape:
        yield name, values.reshape(-1)
    else:
        tall = values if values.shape[0] >= values.shape[1] else values.T
        for index in range(tall.shape[1]):
            yield f"{name}_{index + 1}", tall[:, index]


def check_columns(names: Sequence[str]) -> None:
    """Refuse too many columns, columns of the same name, and names that no table would print.

    Raises
    ------
    LogError
        If there are none, more than `MAX_COLUMNS`, two of one name, or one longer than `LONGEST_NAME`.
    """
    if not names:
        raise LogError(
            "the file holds no columns", evidence={"columns": 0}, remedy="upload a table with a header"
        )
    if len(names) > MAX_COLUMNS:
        raise LogError(
            "the file has more columns than a log can have",
            evidence={"columns": len(names), "at_most": MAX_COLUMNS},
            remedy="keep the columns of time, position, torque or current and drop the others",
        )
    longest = max(names, key=len)
    if len(longest) > LONGEST_NAME:
        raise LogError(
            "a column's name is longer than any name is",
            evidence={"begins": longest[:50], "characters": len(longest), "at_most": LONGEST_NAME},
            remedy="put the names of the columns on the first line, each a few words long",
        )
    repeated = [name for name, count in Counter(names).items() if count > 1]
    if repeated:
        raise duplicate_columns(repeated)


def check_rows(rows: int) -> None:
    """Refuse more rows than `MAX_ROWS`."""
    if rows > MAX_ROWS:
        raise LogError(
            "the log has more rows than can be studied at once",
            evidence={"rows": rows, "at_most": MAX_ROWS},
            remedy="upload a part of it, or several logs",
        )


def check_values(values: int) -> None:
    """Refuse more numbers than a format without streaming may hold in memory."""
    if values > MAX_VALUES_IN_MEMORY:
        raise LogError(
            "the log is too large for a format that must be held in memory",
            evidence={"values": values, "at_most": MAX_VALUES_IN_MEMORY},
            remedy="save it as Parquet, which is read piece by piece",
        )


def check_shapes(shapes: Sequence[tuple[int, ...]]) -> None:
    """Refuse arrays by their declared shapes, before any of them is read."""
    check_values(sum(prod(shape) for shape in shapes))


def check_density(unpacked: int, packed: int) -> None:
    """Refuse bytes that unpack to far more than any measured motion does: noise cannot be packed so well."""
    if unpacked > FREE_BYTES + MAX_UNPACKING * packed:
        raise LogError(
            "the file unpacks to far more numbers than its bytes can hold of a measured motion",
            evidence={"bytes": packed, "unpacked_bytes": unpacked, "at_most_times": MAX_UNPACKING},
            remedy="upload the log as it was measured",
        )


def duplicate_columns(names: Sequence[str]) -> LogError:
    """Report which column names occur more than once."""
    return LogError(
        "two columns carry the same name, so that neither can be meant",
        evidence={"duplicates": list(names)[:20]},
        remedy="give every column a name of its own; channels with clocks of their own go to files of their "
        "own: veritorque logs join A B -o run.parquet",
    )


def not_numeric(name: str, found: str, advice: str = "") -> LogError:
    """Report that a column which is needed holds something else than numbers."""
    return LogError(
        f"the column {name!r} is not made of numbers",
        evidence={"column": name, "found": found},
        remedy=advice or "store plain numbers, or map another column",
    )


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
