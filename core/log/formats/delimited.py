"""Read text whose cells are separated by commas, semicolons, tabs or blanks.

Comments start with `#`, between rows also with `%`; with semicolons, tabs and blanks a decimal comma is
understood. A header which is itself the last comment line, as numpy.savetxt writes it, is accepted, and a
table without one.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BufferedReader
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from ...arrays import Series
from ...errors import LogError
from ..defects.stretch import count_text
from .arrow import numbers, words_for_nothing
from .copies import check_copies, copy_notes, told_apart
from .odd_rows import OddRows, find_odd_rows
from .stamps import Clock
from .table import BY_NUMBER, MAX_COLUMNS, check_columns, check_rows, check_values, not_numeric, reading
from .text_bytes import UTF_8, UTF_16, WESTERN, check_text, encoding_of, open_utf8, opening_lines
from .text_cells import BLANKS, DELIMITERS, TextHeader, is_comment, is_number, split_cells
from .text_header import STAMP, find_header
from .tidy_lines import TidyLines

FORM = "CSV"
BLOCK_BYTES = 1 << 22
ENCODING_NOTES = {
    UTF_8: (),
    UTF_16: ("the text read as UTF-16",),
    WESTERN: ("the text is not UTF-8, and read as Windows-1252",),
}
_BAD_CELL = re.compile(r"column #(?P<column>\d+).*?invalid value '(?P<found>[^']*)'", re.DOTALL)


@dataclass(frozen=True)
class DelimitedTable:
    """Give the columns of a text table; only those that are asked for are converted."""

    path: Path
    names: tuple[str, ...]
    delimiter: str
    decimal: str
    skip: int
    """Physical lines before the first row of data."""
    stamps: tuple[str, ...] = ()
    """Columns of dates or times of day, which are read as seconds from their first one on."""
    texts: tuple[str, ...] = ()
    """Columns of other text."""
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    odd: OddRows = field(default_factory=OddRows)
    """Lines that hold no whole row."""
    repeated: bytes = b""
    """The header, where it occurs again between the rows."""
    encoding: str = UTF_8

    def batches(self, names: Sequence[str]) -> Iterator[Series]:
        """Read the named columns in blocks of a few megabytes."""
        wanted = list(names)
        clock = {name: Clock() for name in wanted if name in self.stamps}
        kinds = {name: pa.string() if name in clock else pa.float64() for name in wanted}
        rows = 0
        for batch in self._batches(kinds):
            rows += batch.num_rows
            check_rows(rows)
            check_values(rows * len(wanted))
            columns = zip(wanted, batch.columns, strict=True)
            yield np.array(
                [
                    clock[name].seconds(column) if name in clock else numbers(column)
                    for name, column in columns
                ],
                dtype=np.float64,
            )

    def words(self, name: str) -> list[str]:
        """Read a column of text."""
        found: list[str] = []
        for batch in self._batches({name: pa.string()}):
            found += batch.column(0).to_pylist()
            check_values(len(found))
        return found

    def _batches(self, kinds: Mapping[str, pa.DataType]) -> Iterator[pa.RecordBatch]:
        convert = arrow_csv.ConvertOptions(
            include_columns=list(kinds),
            column_types=dict(kinds),
            decimal_point=self.decimal,
            null_values=words_for_nothing(),
        )
        read = arrow_csv.ReadOptions(
            column_names=list(self.names), skip_rows=self.skip, block_size=BLOCK_BYTES, use_threads=False
        )
        delimiter = "\t" if self.delimiter == BLANKS else self.delimiter
        parse = arrow_csv.ParseOptions(delimiter=delimiter)
        with reading(FORM, self.path), self._naming_columns(), self._rows(delimiter) as rows:
            yield from arrow_csv.open_csv(rows, read, parse, convert)

    def _rows(self, delimiter: str) -> BufferedReader | TidyLines:
        """Open the text as the parser wants it."""
        file = open_utf8(self.path, self.encoding)
        if self.delimiter != BLANKS and not self.repeated and self.odd == OddRows():
            return file
        nothing = delimiter.encode() * (len(self.names) - 1) + b"\n"
        left_out = dict.fromkeys((self.odd.cut, *self.odd.below, *self.odd.comments), b"")
        return TidyLines(
            file,
            blanks=self.delimiter == BLANKS,
            without=self.repeated,
            instead=dict.fromkeys(self.odd.blank, nothing) | left_out,
            skip=self.skip,
        )

    @contextmanager
    def _naming_columns(self) -> Iterator[None]:
        """Name the column of a cell that is no number, which the parser only counts."""
        try:
            yield
        except pa.ArrowInvalid as error:
            if (cell := _BAD_CELL.search(str(error))) is not None:
                found = cell["found"][:80]
                raise not_numeric(self.names[int(cell["column"])], found, _advice(found)) from error
            raise


def open_delimited(path: Path) -> DelimitedTable:
    """Find the header line, the delimiter and the decimal sign.

    Raises
    ------
    LogError
        If there is no table, or the text is not UTF-8, or the columns break the limits.
    """
    encoding = encoding_of(path)
    lines = opening_lines(path, encoding)
    found = find_header(lines) or _first_line(lines)
    check_columns([f"column_{index}" for index in range(found.width)])
    names, copies = told_apart(_names(found))
    check_columns(names)
    _check_separated(found, lines)
    row = found.first_row
    header = lines[found.header_at].strip().encode() if found.cells else b""
    repeated = check_text(path, header, encoding)
    repeated = max(repeated - (found.header_at > 0), 0)
    cells = dict(zip(names, split_cells(row, found.delimiter), strict=False))
    stamps = tuple(name for name, cell in cells.items() if STAMP.fullmatch(cell))
    odd = find_odd_rows(path, encoding, found, header)
    table = DelimitedTable(
        path=path,
        names=names,
        delimiter=found.delimiter,
        decimal=_decimal_sign(lines[found.skip :], found.delimiter),
        skip=found.skip,
        stamps=stamps,
        texts=_texts(cells, stamps),
        units=_units(names, found),
        notes=(
            *ENCODING_NOTES[encoding],
            *_notes(found, stamps, repeated),
            *copy_notes(copies),
            *odd.notes(),
        ),
        odd=odd,
        repeated=header if repeated else b"",
        encoding=encoding,
    )
    check_copies(table, copies)
    return table


def _check_separated(found: TextHeader, lines: Sequence[str]) -> None:
    """Refuse one column: no separator is in the header, or another number of blanks than in the rows."""
    if found.width > 1:
        return
    seen = {"header": (found.cells or ("",))[0][:120], "first_row": found.first_row[:120]}
    if _is_spaced(lines):
        raise LogError(
            "the columns are separated by blanks, and their number differs from that of the names",
            evidence=seen,
            remedy="write names without blanks, or separate the columns by commas, semicolons or tabs",
        )
    raise LogError(
        "the text has one column only: no numbers between commas, semicolons, tabs or blanks follow its name",
        evidence=seen,
        remedy="separate names and numbers by commas, semicolons or tabs, one row per sample",
    )


def _texts(cells: Mapping[str, str], stamps: Collection[str]) -> tuple[str, ...]:
    """Name the columns whose first cell is neither a number nor a stamp."""
    filled = (name for name, cell in cells.items() if cell and not is_number(cell))
    return tuple(name for name in filled if name not in stamps)


def _units(names: Sequence[str], found: TextHeader) -> dict[str, str]:
    """Give the units that a line of units or the names themselves state."""
    cells = zip(names, found.cells, strict=False)
    return {name: found.units[cell] for name, cell in cells if cell in found.units}


def _first_line(lines: Sequence[str]) -> TextHeader:
    """Take the first line that is no comment for the header, whatever follows."""
    content = [index for index, line in enumerate(lines) if not is_comment(line)][:2]
    if not content:
        raise LogError(
            "the log holds no rows",
            evidence={"lines": len(lines)},
            remedy="upload at least one second of motion",
        )
    header = lines[content[0]]
    if is_number(header.strip()):
        raise LogError(
            "the file starts with numbers instead of a header line that names its columns",
            evidence={"first_line": header[:120]},
            remedy="put the column names on the first line, such as time,q_1,tau_1",
        )
    delimiter = max(DELIMITERS, key=header.count)
    with_text = (i for i in range(content[0] + 1, len(lines)) if not is_comment(lines[i]))
    if header.count(delimiter) >= MAX_COLUMNS:
        check_columns([f"column_{index}" for index in range(header.count(delimiter) + 1)])
    cells = tuple(split_cells(header, delimiter))
    return TextHeader(
        cells=cells,
        width=len(cells),
        delimiter=delimiter,
        first_row=lines[content[1]] if len(content) > 1 else "",
        skip=next(with_text, content[0] + 1),
        header_at=content[0],
    )


def _decimal_sign(rows: Sequence[str], delimiter: str) -> str:
    """Read the decimal sign off the first row that has one: recorders begin with rows of whole zeros."""
    if delimiter == ",":
        return "."
    first = next((row for row in rows if not is_comment(row) and ("," in row or "." in row)), ".")
    return "." if "." in first else ","


def _names(found: TextHeader) -> tuple[str, ...]:
    """Name the columns; those without a name by their number, from 1."""
    cells = found.cells or ("",) * found.width
    return tuple(cell or f"{BY_NUMBER}{index + 1}" for index, cell in enumerate(cells))


def _notes(found: TextHeader, stamps: Sequence[str], repeated: int) -> Iterator[str]:
    """Say what was done to read the text."""
    if found.titles:
        yield f"{found.titles} title line{'s' if found.titles > 1 else ''} above the table passed over"
    if not found.cells:
        yield f"no header: the columns are called {BY_NUMBER}1 to {BY_NUMBER}{found.width}"
    if found.units:
        yield "the line below the header read as units"
    if found.delimiter == BLANKS:
        yield "cells separated by blanks"
    if stamps:
        yield f"dates or times of day in {', '.join(map(repr, stamps))} read as seconds from the first on"
    if repeated:
        yield f"the header, repeated {count_text(repeated, 'time')} between the rows, passed over"


def _is_spaced(lines: Sequence[str]) -> bool:
    """Recognise rows of numbers that blanks separate."""
    rows = [line.split() for line in lines if not is_comment(line)][1:3]
    return bool(rows) and all(len(cells) > 1 and all(map(is_number, cells)) for cells in rows)


def _advice(found: str) -> str:
    """Describe the remedy for a cell that is no number."""
    if re.fullmatch(r"[-+]?\d+,\d*(e[-+]?\d+)?", found, re.IGNORECASE):
        return "write decimal points in every row, or decimal commas in every row between semicolons or tabs"
    if re.fullmatch(r"[-+]?\d{1,3}([.,' ]\d{3})+([.,]\d*)?", found):
        return "write numbers without a sign between thousands"
    if re.search(r"\d:\d\d|\d[./-]\d\d?[./-]\d", found):
        return "write dates and times of day as 2024-03-01 10:00:00.004, or seconds as plain numbers"
    return "store plain numbers, or map another column; a line of units below the header starts with #"
