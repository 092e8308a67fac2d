"""Read Parquet piece by piece, so that an hour of motion needs no more memory than a minute.

A writer may put all rows into one row group, hence columns are decoded in batches by a cursor that moves
forward and only starts again when rows before its window are asked for.
"""

from bisect import bisect_right
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ...arrays import Indices, Matrix, Samples, Series
from ...errors import LogError
from ..columns.layout import Layout
from ..model import LogRows
from .arrow import numbers
from .table import BATCH_ROWS, check_columns, check_density, check_rows, not_numeric, reading

FORM = "Parquet"
BUFFER_BYTES = 1 << 18
MICROSECONDS = 1e6
WHOLE = -1
"""Place of a column that holds no lists."""
FIRST_LISTS = 256
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
    lists: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    """Column of the file and place in its lists, by the name that each place is given."""
    texts: tuple[str, ...] = ()
    """Columns of text."""
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def batches(self, names: Sequence[str], *, first_group: int = 0) -> Iterator[Series]:
        """Decode the named columns from the given row group on."""
        for name in names:
            if not self.numeric[self.names.index(name)]:
                raise not_numeric(name, "a Parquet type other than integer or floating point")
        groups = range(first_group, len(self.group_starts))
        with reading(FORM, self.path), _open(self.path) as file:
            places = [self.lists.get(name, (name, WHOLE)) for name in names]
            stream = file.iter_batches(
                BATCH_ROWS, row_groups=groups, columns=list(dict(places)), use_threads=False
            )
            widths = Counter(column for column, _ in self.lists.values())
            for batch in stream:
                yield _decode(batch, places, widths)

    def words(self, name: str) -> list[str]:
        """Read a column of text."""
        with reading(FORM, self.path), _open(self.path) as file:
            stream = file.iter_batches(BATCH_ROWS, columns=[name], use_threads=False)
            return [str(word) for batch in stream for word in batch.column(0).to_pylist()]


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
        columns = list(chain.from_iterable(_parts(file, column) for column in fields))
    _check_counts(metadata.num_rows, sum(lengths))
    names = tuple(name for name, _, _ in columns)
    check_columns(names)
    lists = {name: (column.name, place) for name, column, place in columns if place != WHOLE}
    return ParquetTable(
        path=path,
        names=names,
        numeric=tuple(place != WHOLE or _is_number(column.type) for _, column, place in columns),
        samples=metadata.num_rows,
        group_starts=tuple(np.cumsum([0, *lengths])[:-1].tolist()),
        lists=lists,
        texts=tuple(column.name for column in fields if pa.types.is_string(column.type)),
        notes=_notes(column for column, _ in lists.values()),
    )


def _check_counts(rows: int, in_groups: int) -> None:
    if in_groups != rows:
        raise LogError(
            "the Parquet file contradicts itself about its number of rows",
            evidence={"footer": rows, "row_groups": in_groups},
            remedy="write the file again",
        )


def _notes(split: Iterable[str]) -> tuple[str, ...]:
    listed = ", ".join(map(repr, dict.fromkeys(split)))
    return (f"lists in {listed} split into columns, from _1 on",) if listed else ()


def _parts(file: pq.ParquetFile, column: pa.Field) -> list[tuple[str, pa.Field, int]]:
    """Give the column itself, or one for each place of its lists of numbers."""
    width = _list_width(file, column)
    if not width:
        return [(column.name, column, WHOLE)]
    return [(f"{column.name}_{place + 1}", column, place) for place in range(width)]


def _list_width(file: pq.ParquetFile, column: pa.Field) -> int:
    """Count the numbers of a column's lists, by the first that are there; 0 where there are none."""
    kind = column.type
    if pa.types.is_fixed_size_list(kind):
        return int(kind.list_size) if _is_number(kind.value_type) else 0
    if not (pa.types.is_list(kind) or pa.types.is_large_list(kind)) or not _is_number(kind.value_type):
        return 0
    first = next(file.iter_batches(FIRST_LISTS, columns=[column.name], use_threads=False), None)
    lengths = _lengths(first.column(0)) if first is not None else np.zeros(0, dtype=int)
    return int(lengths[np.argmax(lengths > 0)]) if np.any(lengths > 0) else 0


def _is_number(kind: pa.DataType) -> bool:
    return bool(pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_timestamp(kind))


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


def _decode(batch: pa.RecordBatch, places: Sequence[tuple[str, int]], widths: Mapping[str, int]) -> Series:
    block = np.empty((len(places), batch.num_rows))
    lists: dict[str, Matrix] = {}
    for row, (name, place) in zip(block, places, strict=True):
        if place == WHOLE:
            row[:] = _scalars(batch.column(name))
            continue
        if name not in lists:
            lists[name] = _matrix(name, batch.column(name), widths[name])
        row[:] = lists[name][:, place]
    return block


def _scalars(column: pa.Array) -> Samples:
    """Give numbers as they are, and stamps in seconds."""
    if not pa.types.is_timestamp(column.type):
        return numbers(column)
    return (
        numbers(column.cast(pa.timestamp("us", column.type.tz), safe=False).cast(pa.int64())) / MICROSECONDS
    )


def _matrix(name: str, column: pa.Array, width: int) -> Matrix:
    """Give lists as rows; one that is missing, or of another length than the first ones have, holds NaN."""
    if pa.types.is_fixed_size_list(column.type) and not column.null_count:
        return numbers(column.flatten()).reshape(len(column), width)
    lengths = _lengths(column)
    whole = np.flatnonzero(lengths == width)
    given = np.count_nonzero(lengths > 0)
    if 2 * len(whole) < given:
        raise LogError(
            f"the lists of the column {name!r} differ in length",
            evidence={"column": name, "first": width, "others": int(given - len(whole)), "rows": len(column)},
            remedy="give every row a number for every joint",
        )
    rows = np.full((len(column), width), np.nan)
    rows[whole] = numbers(column.take(pa.array(whole)).flatten()).reshape(len(whole), width)
    return rows


def _lengths(column: pa.Array) -> Indices:
    """Give the lengths of lists, -1 where one is missing."""
    if pa.types.is_fixed_size_list(column.type):
        present = np.array(column.is_valid().to_pylist(), dtype=bool)
        return np.where(present, column.type.list_size, -1)
    return np.asarray(np.from_dlpack(column.value_lengths().cast(pa.int64()).fill_null(-1)))


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
