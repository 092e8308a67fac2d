"""Read comma, semicolon or tab separated text with a header line.

The delimiter is taken from the header; comment lines start with `#`; with semicolons and tabs a decimal comma
is understood. A header which is itself the last comment line, as numpy.savetxt writes it, is accepted.
"""

import codecs
import csv
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from ...arrays import Series
from ...errors import LogError
from .arrow import numbers
from .table import MAX_COLUMNS, check_columns, check_rows, check_values, not_numeric, reading

FORM = "CSV"
HEAD_BYTES = 1 << 20
MOST_HEAD_BYTES = 64 << 20
"""Where the header has to have come, whatever stands before it."""
BLOCK_BYTES = 1 << 22
DELIMITERS = ",;\t"
MAX_COMMENTS = 100_000
_BAD_ROW = re.compile(
    r"Row #(?P<line>\d+): Expected (?P<columns>\d+) columns, got (?P<cells>\d+): (?P<text>.*)", re.DOTALL
)
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

    def batches(self, names: Sequence[str]) -> Iterator[Series]:
        """Read the named columns in blocks of a few megabytes."""
        wanted = list(names)
        convert = arrow_csv.ConvertOptions(
            include_columns=wanted,
            column_types=dict.fromkeys(wanted, pa.float64()),
            decimal_point=self.decimal,
        )
        read = arrow_csv.ReadOptions(
            column_names=list(self.names), skip_rows=self.skip, block_size=BLOCK_BYTES, use_threads=False
        )
        parse = arrow_csv.ParseOptions(delimiter=self.delimiter, invalid_row_handler=_skip_comments)
        rows = 0
        with reading(FORM, self.path), self._naming_columns():
            for batch in arrow_csv.open_csv(self.path, read, parse, convert):
                rows += batch.num_rows
                check_rows(rows)
                check_values(rows * len(wanted))
                yield np.array([numbers(column) for column in batch.columns], dtype=np.float64)

    @contextmanager
    def _naming_columns(self) -> Iterator[None]:
        """Name the column of a cell that is no number, which the parser only counts."""
        try:
            yield
        except pa.ArrowInvalid as error:
            if (cell := _BAD_CELL.search(str(error))) is not None:
                found = cell["found"][:80]
                raise not_numeric(self.names[int(cell["column"])], found, _advice(found)) from error
            if (row := _BAD_ROW.search(str(error))) is not None:
                raise _row_length_error(row, self.delimiter) from error
            raise


def open_delimited(path: Path) -> DelimitedTable:
    """Find the header line, the delimiter and the decimal sign.

    Raises
    ------
    LogError
        If there is no header line, or the text is not UTF-8, or the columns break the limits.
    """
    lines = _opening_lines(path)
    header_index, header, first_row = _header(lines)
    delimiter = max(DELIMITERS, key=header.count)
    names = _names(path, header, delimiter)
    skip = next(
        (i for i in range(header_index + 1, len(lines)) if not _is_comment(lines[i])), header_index + 1
    )
    if len(names) == 1 and _is_spaced(header, first_row):
        raise LogError(
            "the columns are separated by spaces",
            evidence={"header": header[:120]},
            remedy="separate them by commas, semicolons or tabs",
        )
    decimal = "," if delimiter != "," and "," in first_row and "." not in first_row else "."
    _check_text(path)
    return DelimitedTable(path, names, delimiter, decimal, skip)


def _opening_lines(path: Path) -> list[str]:
    """Read the first megabyte, and on where it holds nothing but comments and perhaps one line more."""
    with path.open("rb") as stream:
        head = stream.read(HEAD_BYTES)
        lines = _lines(head)
        while len(_content(lines)) < 2 and len(lines) <= MAX_COMMENTS and len(head) < MOST_HEAD_BYTES:
            more = stream.read(len(head))
            if not more:
                break
            head += more
            lines = _lines(head)
    return lines


def _lines(head: bytes) -> list[str]:
    return re.split("\r\n|\r|\n", _decode(head))


def _content(lines: Sequence[str]) -> list[int]:
    """Give the indices of the first two lines that are no comment."""
    indices = (index for index, line in enumerate(lines) if not _is_comment(line))
    return list(islice(indices, 2))


def _check_text(path: Path) -> None:
    """Refuse NUL bytes, other encodings, lines of a megabyte and endless comments before rows are parsed."""
    begin = comments = 0
    decoder = codecs.getincrementaldecoder("utf-8")()
    with path.open("rb") as stream:
        while piece := stream.read(HEAD_BYTES):
            try:
                decoder.decode(piece)
            except UnicodeDecodeError as error:
                raise _not_utf8(begin, error) from error
            if b"\x00" in piece:
                raise LogError(
                    "the text holds NUL bytes",
                    evidence={"first_at_byte": begin + piece.index(b"\x00")},
                    remedy="save the table again as plain UTF-8 text",
                )
            begin += len(piece)
            if len(piece) == HEAD_BYTES and b"\n" not in piece and b"\r" not in piece:
                raise LogError(
                    "a line is longer than 1 MB, which no row of a log is",
                    evidence={"before_byte": begin},
                    remedy="write one row per line",
                )
            comments += piece.count(b"\n#")
            if comments > MAX_COMMENTS:
                raise LogError(
                    "the text holds more comments than a log has",
                    evidence={"comment_lines": comments, "at_most": MAX_COMMENTS},
                    remedy="save the rows without them",
                )


def _decode(head: bytes) -> str:
    if b"\n" not in head and b"\r" not in head and len(head) == HEAD_BYTES:
        raise LogError(
            "the first line is longer than 1 MB, which no header of a log is",
            evidence={"delimiters": max(head.count(mark.encode()) for mark in DELIMITERS)},
            remedy="put the column names on the first line and keep the columns of the log only",
        )
    try:
        return head[: head.rfind(b"\n") + 1 or None].decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _not_utf8(0, error) from error


def _not_utf8(begin: int, error: UnicodeDecodeError) -> LogError:
    return LogError(
        "the text is not UTF-8",
        evidence={"byte": begin + error.start, "value": error.object[error.start]},
        remedy="save the file as UTF-8",
    )


def _is_comment(line: str) -> bool:
    return not line.strip() or line.lstrip().startswith("#")


def _header(lines: Sequence[str]) -> tuple[int, str, str]:
    """Find the header: the first line that is no comment, or the comment right before the numbers."""
    content = _content(lines)
    if not content:
        raise LogError(
            "the log holds no rows",
            evidence={"lines": len(lines)},
            remedy="upload at least one second of motion",
        )
    first = lines[content[0]]
    if not _is_numbers(first):
        return content[0], first, lines[content[1]] if len(content) > 1 else ""
    commented = next(filter(str.strip, reversed(lines[: content[0]])), "").lstrip("# ")
    delimiter = max(DELIMITERS, key=first.count)
    if commented and commented.count(delimiter) == first.count(delimiter) and not _is_numbers(commented):
        return content[0] - 1, commented, first
    raise LogError(
        "the file starts with numbers instead of a header line that names its columns",
        evidence={"first_line": first[:120]},
        remedy="put the column names on the first line, such as time,q_1,tau_1",
    )


def _is_numbers(line: str) -> bool:
    delimiter = max(DELIMITERS, key=line.count)
    try:
        [float(cell.replace(",", ".")) for cell in line.split(delimiter)]
    except ValueError:
        return False
    return True


def _is_spaced(header: str, first_row: str) -> bool:
    """Recognise a table whose cells blanks separate: as many words in the header as numbers below it."""
    cells = first_row.split()
    return len(header.split()) == len(cells) > 1 and all(map(_is_numbers, cells))


def _advice(found: str) -> str:
    """Describe the remedy for a cell that is no number."""
    if re.fullmatch(r"[-+]?\d+,\d*(e[-+]?\d+)?", found, re.IGNORECASE):
        return "write decimal points in every row, or decimal commas in every row between semicolons or tabs"
    return "store plain numbers, or map another column; a line of units below the header starts with #"


def _row_length_error(row: re.Match[str], delimiter: str) -> LogError:
    """Report that a row has more or fewer cells than there are columns."""
    more = int(row["cells"]) > int(row["columns"])
    commas = more and delimiter == "," and "." not in row["text"]
    remedy = "write one cell per column in every row"
    if commas:
        remedy = "write decimal points, or keep the decimal commas and separate the columns by semicolons"
    elif not more:
        remedy += "; where it is the last row the file was cut short: copy it whole"
    return LogError(
        f"line {row['line']} holds {row['cells']} cells, and the header names {row['columns']} columns"
        + (": the numbers seem to have decimal commas" if commas else ""),
        evidence={"line": int(row["line"]), "text": row["text"][:120]},
        remedy=remedy,
    )


def _names(path: Path, header: str, delimiter: str) -> tuple[str, ...]:
    if header.count(delimiter) >= MAX_COLUMNS:
        check_columns([f"column_{index}" for index in range(header.count(delimiter) + 1)])
    with reading(FORM, path):
        cells = next(csv.reader([header], delimiter=delimiter))
    names = tuple(cell.strip() or f"column_{index + 1}" for index, cell in enumerate(cells))
    check_columns(names)
    return names


def _skip_comments(row: arrow_csv.InvalidRow) -> str:
    return "skip" if row.text.lstrip().startswith("#") else "error"
