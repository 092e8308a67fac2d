"""Read Parquet piece by piece, so that an hour of motion needs no more memory than a minute.

A writer may put all rows into one row group, hence columns are decoded in batches by a cursor that moves
forward and only starts again when rows before its window are asked for.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ...arrays import Series
from ...errors import LogError
from ..layout import Layout
from ..model import LogRows
from .arrow import numbers
from .table import BATCH_ROWS, check_columns, check_density, check_rows, not_numeric, reading

FORM = "Parquet"
BUFFER_BYTES = 1 << 18
MAX_FOOTER_TEXT = 1 << 24
MAX_FOOTER_ITEMS = 1 << 20


@dataclass(frozen=True)
class ParquetTable:
    """Give the columns of a Parquet file."""

    path: Path
    names: tuple[str, ...]
    numeric: tuple[bool, ...]
    """Whether each column is made of real numbers."""
    samples: int
    group_starts: tuple[int, ...]
    """First row of each row group."""

    def batches(self, names: Sequence[str], *, first_group: int = 0) -> Iterator[Series]:
        """Decode the named columns from the given row group on."""
        for name in names:
            if not self.numeric[self.names.index(name)]:
                raise not_numeric(name, "a Parquet type other than integer or floating point")
        groups = range(first_group, len(self.group_starts))
        with reading(FORM, self.path), _open(self.path) as file:
            stream = file.iter_batches(BATCH_ROWS, row_groups=groups, columns=list(names), use_threads=False)
            for batch in stream:
                yield _decode(batch, names)


def open_parquet(path: Path) -> ParquetTable:
    """Read the footer only.

    Raises
    ------
    LogError
        If the footer is damaged, or the columns or rows break the limits.
    """
    with reading(FORM, path), _open(path) as file:
        metadata = file.metadata
        check_rows(metadata.num_rows)
        check_density(8 * metadata.num_rows, path.stat().st_size)
        fields = list(file.schema_arrow)
        check_columns([field.name for field in fields])
        lengths = [metadata.row_group(group).num_rows for group in range(metadata.num_row_groups)]
    if sum(lengths) != metadata.num_rows:
        raise LogError(
            "the Parquet file contradicts itself about its number of rows",
            evidence={"footer": metadata.num_rows, "row_groups": sum(lengths)},
            remedy="write the file again",
        )
    return ParquetTable(
        path=path,
        names=tuple(field.name for field in fields),
        numeric=tuple(
            pa.types.is_integer(field.type) or pa.types.is_floating(field.type) for field in fields
        ),
        samples=metadata.num_rows,
        group_starts=tuple(int(start) for start in np.cumsum([0, *lengths])[:-1]),
    )


def _open(path: Path) -> pq.ParquetFile:
    """Open without prefetching: it would hold a whole row group in memory."""
    return pq.ParquetFile(
        path,
        pre_buffer=False,
        buffer_size=BUFFER_BYTES,
        memory_map=False,
        thrift_string_size_limit=MAX_FOOTER_TEXT,
        thrift_container_size_limit=MAX_FOOTER_ITEMS,
    )


def _decode(batch: pa.RecordBatch, names: Sequence[str]) -> Series:
    block = np.empty((len(names), batch.num_rows))
    for row, name in zip(block, names, strict=True):
        row[:] = numbers(batch.column(name))
    return block


class ParquetSource:
    """Give the samples of a Parquet file in SI by row number, with memory for one request and one batch.

    Requests that move forward, overlapping or not, decode every row once; a request that starts before the
    last one did starts again at its row group.
    """

    def __init__(self, table: ParquetTable, layout: Layout) -> None:
        self._table = table
        self._layout = layout
        self._blocks: list[Series] = []
        self._first = 0
        self._last = 0
        self._stream = table.batches(layout.columns)

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self._table.samples

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop.

        Raises
        ------
        LogError
            If the file is damaged at these rows.
        """
        start, stop, _ = slice(start, stop).indices(self.samples)
        stop = max(start, stop)
        if start < self._first:
            self._rewind(start)
        self._forget(start)
        while self._last < stop or not self._blocks:
            self._advance()
            self._forget(start)
        whole = self._blocks[0] if len(self._blocks) == 1 else np.hstack(self._blocks)
        return self._layout.convert(whole[:, start - self._first : stop - self._first], start)

    def _rewind(self, start: int) -> None:
        group = max(bisect_right(self._table.group_starts, start) - 1, 0)
        self._stream = self._table.batches(self._layout.columns, first_group=group)
        self._blocks = []
        self._first = self._last = self._table.group_starts[group]

    def _advance(self) -> None:
        block = next(self._stream, None)
        if block is None:
            raise LogError(
                "the Parquet file holds fewer rows than its footer says",
                evidence={"footer": self.samples, "found": self._last},
                remedy="write the file again and upload it whole",
            )
        self._blocks.append(block)
        self._last += block.shape[1]

    def _forget(self, start: int) -> None:
        """Drop the batches that end before start, but keep one, so that there is something to slice."""
        while len(self._blocks) > 1 and self._first + self._blocks[0].shape[1] <= start:
            self._first += self._blocks.pop(0).shape[1]
