"""Keep the first batch of a table's columns: guesses at names and units ask for the same rows many times."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ...arrays import Samples, Series
from ...errors import LogError
from .table import MemoryTable, Table


def first_rows(table: Table) -> Table:
    """Give the first batch of a table and no more; what lies in memory needs no copy.

    Examples
    --------
    >>> table = MemoryTable({"t": np.arange(3.0)})
    >>> first_rows(table) is table
    True
    """
    return table if isinstance(table, MemoryTable) else FirstRows(table)


class FirstRows:
    """Read the first batch once, for all columns where that is possible."""

    def __init__(self, table: Table) -> None:
        self.table = table
        self._read: dict[str, Samples] | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """List the columns in the file's order."""
        return self.table.names

    @property
    def texts(self) -> tuple[str, ...]:
        """Name the columns of text that can be read."""
        return self.table.texts

    @property
    def units(self) -> Mapping[str, str]:
        """Give what the file itself says of its columns' units, outside their names."""
        return self.table.units

    @property
    def notes(self) -> tuple[str, ...]:
        """Say what was done to get columns out of a file that is no plain table."""
        return self.table.notes

    def words(self, name: str) -> list[str]:
        """Read a column of text."""
        return self.table.words(name)

    def batches(self, names: Sequence[str]) -> Iterator[Series]:
        """Give the first rows of the named columns."""
        if self._read is None:
            self._read = self._all_at_once()
        absent = [name for name in names if name not in self._read]
        if absent:  # another column holds no numbers, so that each is read by itself
            self._read.update(self._first(absent))
        yield np.array([self._read[name] for name in names])

    def _all_at_once(self) -> dict[str, Samples]:
        names = [name for name in self.names if name not in self.texts]
        try:
            return self._first(names) if names else {}  # a parser that is asked for none gives all
        except LogError:
            return {}

    def _first(self, names: Sequence[str]) -> dict[str, Samples]:
        block = next(iter(self.table.batches(names)), np.empty((len(names), 0)))
        return dict(zip(names, block, strict=True))
