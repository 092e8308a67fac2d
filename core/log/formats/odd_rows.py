"""Find the rows of a text table that have more or fewer cells than it has columns.

A recorder that is killed leaves half a row, and a serial line loses bytes. The cells of such a row may be
those of other columns, so that none is used. It is read as a row of blanks: a log without a clock keeps its
time, and rows without values are found and left out later. One at the very end is left out here, and so are
comments between the rows, whatever separators they hold, and lines of text below the table.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice, takewhile
from pathlib import Path

import numpy as np

from ...arrays import Indices
from ...errors import LogError
from ..defects.stretch import count_text
from .arrow import words_for_nothing
from .text_bytes import open_utf8
from .text_cells import BLANKS, TextHeader, is_number, split_cells

BLOCK_BYTES = 1 << 20
MOST_ODD = 0.01
"""Up to this share of the rows may be of another length, as of those that are out of order; a cut last row
always may. Damage is rare. Where rows differ often, they have decimal commas or other columns for a time, and
those of the right length cannot be trusted either."""
SHOWN_LINES = 20
MOST_BELOW = 20
"""Up to so many lines may stand below a table: what a recorder says at the end, not text among the rows."""
COMMENT_MARKS = (b"#", b"%")
"""What a comment between rows begins with."""
EMPTY = (b"\n", b"\r\n", b"\r")
_COMMENT = re.compile(rb"(?:^|[\r\n])[ \t]*[#%]")
_NOTHING = frozenset(word.strip() for word in words_for_nothing())


@dataclass(frozen=True)
class OddRows:
    """Name the lines that hold no whole row, by their numbers from 1."""

    blank: tuple[int, ...] = ()
    """Lines between the first row and the last."""
    cut: int = 0
    """The last line, if it is cut short or otherwise no row; else 0."""
    below: tuple[int, ...] = ()
    """Lines below the table, some of which hold words where rows hold numbers."""
    comments: tuple[int, ...] = ()
    """Comments between the rows and below them."""

    def notes(self) -> Iterator[str]:
        """Say which rows are not read."""
        if self.blank:
            yield (
                f"{count_text(len(self.blank), 'row')} with another number of cells than there are columns "
                f"read as blank ({_named(self.blank)})"
            )
        if self.comments:
            comments = count_text(len(self.comments), "comment")
            yield f"{comments} between the rows left out ({_named(self.comments)})"
        if self.cut:
            yield f"the last row, cut short, left out (line {self.cut})"
        if self.below:
            lines = count_text(len(self.below), "line")
            yield f"{lines} below the table left out (from line {self.below[0]} on)"


def _named(lines: Sequence[int]) -> str:
    """Name the first of some lines."""
    shown = ", ".join(map(str, lines[:SHOWN_LINES]))
    return f"line{'s' if len(lines) > 1 else ''} {shown}{', ...' if len(lines) > SHOWN_LINES else ''}"


def find_odd_rows(path: Path, encoding: str, found: TextHeader, header: bytes = b"") -> OddRows:
    """Find the rows that do not have a cell for every column, and the comments between rows.

    Parameters
    ----------
    header
        The header, which may come again: it is no comment.

    Raises
    ------
    LogError
        If they are more than a few.
    """
    seen = _Rows(found, header)
    enough = MOST_ODD * path.stat().st_size / found.width  # a cell takes a byte at least
    blocks = _blocks(path, encoding)
    for block in blocks:
        seen.take(block)
        if len(seen.odd) > enough:
            break
    below = _below(seen)
    cut = 0 if below else _cut_line(seen)
    blank = tuple(line for line in seen.odd if line not in (cut, *below))
    if len(blank) > MOST_ODD * seen.rows:
        raise _too_many(seen, found, whole=not any(blocks))
    return OddRows(blank, cut, below, tuple(seen.comments))


def _cut_line(seen: "_Rows") -> int:
    """Give the last line if it is cut short or otherwise no row; else 0."""
    line, text = seen.last[-1] if seen.last else (0, b"")
    return line if seen.odd[-1:] == [line] or _breaks_off(text, seen.table) else 0


def _below(seen: "_Rows") -> tuple[int, ...]:
    """Give the lines at the end that are no rows, if one of them holds words in the place of numbers."""
    words = {line for line, text in seen.last if line not in seen.odd and _holds_words(text, seen.table)}
    no_rows = words.union(seen.odd)
    found = tuple(takewhile(no_rows.__contains__, (line for line, _ in reversed(seen.last))))
    return found[::-1] if words.intersection(found) and len(found) < min(MOST_BELOW, seen.rows) else ()


def _holds_words(line: bytes, table: TextHeader) -> bool:
    """Tell whether a line holds words in a column that begins with a number."""
    pairs = zip(_cells(line, table), split_cells(table.first_row, table.delimiter), strict=False)
    return any(is_number(first) and not (is_number(cell) or cell in _NOTHING) for cell, first in pairs)


def _blocks(path: Path, encoding: str) -> Iterator[bytes]:
    """Give the lines of a file, some thousand at a time."""
    rest = b""
    with open_utf8(path, encoding) as stream:
        while block := stream.read(BLOCK_BYTES):
            text = rest + block
            stop = len(text) - (2 if text.endswith(b"\r\n") else 1)
            end = 1 + max(text.rfind(b"\n", 0, stop), text.rfind(b"\r", 0, stop))
            rest = text[end:]  # the last line may go on
            if end:
                yield text[:end]
    yield rest


@dataclass
class _Rows:
    """Count the rows of a table, and gather those of another length."""

    table: TextHeader
    header: bytes = b""
    rows: int = 0
    odd: list[int] = field(default_factory=list)
    """Their lines."""
    first: bytes = b""
    """The first of them."""
    comments: list[int] = field(default_factory=list)
    """The lines of comments."""
    last: list[tuple[int, bytes]] = field(default_factory=list)
    """The last lines that are neither empty nor comments, with their numbers."""
    _lines: int = 0

    def take(self, block: bytes) -> None:
        """Take the next lines of the file."""
        ends = _ends_of_rows(block, self.table) if self._lines >= self.table.skip else None
        if ends is None:
            self._take(block.splitlines(keepends=True))
            return
        begin = ends[-MOST_BELOW - 1] + 1 if len(ends) > MOST_BELOW else 0
        self.rows += len(ends)
        self._lines += len(ends)
        last = block[begin:].splitlines(keepends=True)
        self._keep_last(last, 0, self._lines - len(last))

    def _take(self, lines: Sequence[bytes]) -> None:
        """Take lines one by one."""
        begin = max(self.table.skip - self._lines, 0)
        self.rows += len(lines[begin:])
        for place in self._doubtful(lines):
            line = lines[place]
            if place < begin:
                continue
            if self._is_comment(line):
                self.comments.append(self._lines + place + 1)
                self.rows -= 1
            elif line in EMPTY or line.strip() == self.header:
                self.rows -= 1
            elif not _is_whole(line, self.table):
                self.first = self.first or line
                self.odd.append(self._lines + place + 1)
        self._keep_last(lines, begin, self._lines)
        self._lines += len(lines)

    def _keep_last(self, lines: Sequence[bytes], begin: int, before: int) -> None:
        found = ((place, lines[place]) for place in reversed(range(begin, len(lines))))
        filled = ((place, line) for place, line in found if line.strip() and not self._is_comment(line))
        new = islice(((before + place + 1, line) for place, line in filled), MOST_BELOW)
        self.last = [*self.last, *reversed(list(new))][-MOST_BELOW:]

    def _doubtful(self, lines: Sequence[bytes]) -> Sequence[int]:
        """Leave out the lines that have as many separators as a row, no quotation, and are no comments."""
        if self.table.delimiter == BLANKS:
            return range(len(lines))
        mark, most = self.table.delimiter.encode(), self.table.width - 1
        return [
            place
            for place, line in enumerate(lines)
            if line.count(mark) != most or b'"' in line or self._is_comment(line)
        ]

    def _is_comment(self, line: bytes) -> bool:
        """Tell whether a line is a comment, unless the header or the first row begins like it."""
        text = line.lstrip()
        if not text.startswith(COMMENT_MARKS) or text.rstrip() == self.header:
            return False
        return not self.table.first_row.encode().lstrip().startswith(text[:1])


def _ends_of_rows(block: bytes, table: TextHeader) -> Indices | None:
    """Give where each line ends, if all have as many separators as a row and none is quoted or a comment."""
    marks = table.width - 1
    if table.delimiter == BLANKS or not marks or _is_odd(block):
        return None
    text = np.frombuffer(block, dtype=np.uint8)
    ends = np.flatnonzero(text == ord("\n"))
    between = np.flatnonzero(text == ord(table.delimiter))
    if not len(ends) or ends[-1] != len(text) - 1 or len(between) != marks * len(ends):
        return None
    rows = between.reshape(-1, marks)
    apart = (rows[:, -1] < ends).all() and (rows[1:, 0] > ends[:-1]).all()
    return ends if apart else None


def _is_odd(block: bytes) -> bool:
    """Tell whether a line is quoted or a comment, or ends in a carriage return alone."""
    if b'"' in block or (b"\r" in block and block.count(b"\r") != block.count(b"\r\n")):
        return True
    commented = any(mark in block for mark in COMMENT_MARKS)
    return commented and _COMMENT.search(block) is not None


def _is_whole(line: bytes, table: TextHeader) -> bool:
    """Tell whether a line has a cell for every column, and no quotation that would go on in the next one."""
    if line.count(b'"') % 2:
        return False
    cells = line.split() if table.delimiter == BLANKS else _cells(line, table)
    return len(cells) == table.width


def _breaks_off(line: bytes, table: TextHeader) -> bool:
    """Tell whether a last line ends within a number, as in `1.5e-`."""
    if line.endswith((b"\n", b"\r")) or not is_number(split_cells(table.first_row, table.delimiter)[-1]):
        return False
    cell = _cells(line, table)[-1]
    return not is_number(cell) and cell not in _NOTHING


def _cells(line: bytes, table: TextHeader) -> list[str]:
    return split_cells(line.decode("utf-8", "replace").strip("\r\n"), table.delimiter)


def _too_many(seen: _Rows, table: TextHeader, *, whole: bool) -> LogError:
    """Say how many rows are of another length, of the whole table or of the rows that were counted."""
    cells, text = _cells(seen.first, table), seen.first.decode("utf-8", "replace").strip()
    if text.count('"') % 2:
        return LogError(
            f"the quotation in line {seen.odd[0]} goes on in the next line",
            evidence={"text": text[:120], "lines": seen.odd[:SHOWN_LINES]},
            remedy="write lists on one line each, as numpy's tolist gives them, or a column for every number",
        )
    commas = len(cells) > table.width and table.delimiter == "," and "." not in text
    hint = ": the numbers seem to have decimal commas" if commas else ""
    return LogError(
        f"line {seen.odd[0]} holds {len(cells)} cells, and the header names {table.width} columns{hint}; "
        f"{len(seen.odd)} of {'' if whole else 'the first '}{seen.rows} rows are of another length",
        evidence={
            "lines": seen.odd[:SHOWN_LINES],
            "text": text[:120],
            "rows_of_another_length": len(seen.odd),
            "rows" if whole else "rows_counted": seen.rows,
            "accepted_share": MOST_ODD,
        },
        remedy="write decimal points, or keep the decimal commas and separate the columns by semicolons"
        if commas
        else "write one cell per column in every row, and rows of other columns to a file of their own",
    )
