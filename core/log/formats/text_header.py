"""Find where a text table begins, how its cells are separated, and what its columns are called.

Recorders write titles above the header, a row of units below it, blanks or tabs in any number between the
cells, or no header at all. The rows of numbers say which line is which: a header has as many cells as the
rows that follow it, and no number among them.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import islice

from ..columns.named_units import UNIT_WORDS
from .text_cells import BLANKS, COMMENT, DELIMITERS, TextHeader, is_comment, is_number, split_cells
from .text_labels import find_labelled

ROWS, WIDE = 20, 0.8
"""More than this share of so many rows below a header has to be as wide as the header."""
SEARCHED_LINES = 200
"""The header has to come within so many lines that are no comments."""
STAMP = re.compile(
    r"((?P<date>\d{4}-\d{2}-\d{2}[T ])|\d{1,4}([./-])\d{1,2}\3\d{1,4}[ ,T]+|\d+ days? )?"
    r"\d{1,2}:\d{2}:\d{2}([.,]\d{1,9}|:\d{3})?(?P<zone>Z|[+-]\d{2}:?\d{2})?"
)
"""A time of day, alone, after a date (ISO 8601 or as people write it), or after a count of days."""


def find_header(lines: Sequence[str]) -> TextHeader | None:
    """Find the header, or that there is none; None where no row of numbers follows anything like it.

    Examples
    --------
    >>> found = find_header(["Recorder 2", "", "time q_1", "s   rad", "0.0 1.0", "0.1 1.1"])
    >>> found.cells, found.titles, found.units, found.skip
    (('time', 'q_1'), 1, {'time': 's', 'q_1': 'rad'}, 4)
    """
    content = list(
        islice((index for index, line in enumerate(lines) if not is_comment(line)), SEARCHED_LINES)
    )
    for place, index in enumerate(content):
        if found := find_labelled(lines, content, place):
            return found
        if (found := _commented(lines, index)) or (found := _header_at(lines, content, place)):
            return found
        if found := _without_header(lines, content, place):
            return found
    return None


def _header_at(lines: Sequence[str], content: Sequence[int], place: int) -> TextHeader | None:
    """Take the line for a header if rows of as many cells follow, perhaps below one of units."""
    line = lines[content[place]]
    for delimiter in _delimiters(line):
        names = split_cells(line, delimiter)
        if len(names) < 2 or any(map(is_number, names)) or not any(names):
            continue
        rows = _rows(lines, content[place + 1 : place + 1 + ROWS], delimiter)
        names += _names_behind(rows, len(names))
        if not _are_wide(rows, len(names)):
            continue
        if _is_row(rows[0], len(names)):
            return _found(lines, content, place, delimiter, names, rows_at=1)
        if len(rows) > 1 and _are_units(rows[0], len(names)) and _is_row(rows[1], len(names)):
            return _found(lines, content, place, delimiter, names, rows_at=2)
    return None


def _names_behind(rows: Sequence[Sequence[str]], width: int) -> list[str]:
    """Give an empty name where all rows end with a separator and the header does not."""
    return [""] if rows and all(len(row) == width + 1 and not row[-1] for row in rows) else []


def _found(
    lines: Sequence[str],
    content: Sequence[int],
    place: int,
    delimiter: str,
    names: Sequence[str],
    *,
    rows_at: int,
) -> TextHeader:
    units = split_cells(lines[content[place + 1]], delimiter) if rows_at == 2 else []
    first = content[place + rows_at]
    return TextHeader(
        cells=tuple(names),
        width=len(names),
        delimiter=delimiter,
        first_row=lines[first],
        skip=first,
        header_at=content[place],
        titles=place,
        units={name: unit.strip("[]()") for name, unit in zip(names, units, strict=False) if unit},
    )


def _commented(lines: Sequence[str], index: int) -> TextHeader | None:
    """Take the comment right above numbers for the header, as numpy.savetxt writes it."""
    above = next(filter(str.strip, reversed(lines[:index])), "")
    above = above[mark.end() :].strip() if (mark := COMMENT.match(above)) else above
    for delimiter in _delimiters(lines[index]):
        row, names = split_cells(lines[index], delimiter), split_cells(above, delimiter)
        if len(row) == len(names) > 1 and all(map(is_number, row)) and not any(map(is_number, names)):
            at = index - 1 - next(k for k, line in enumerate(reversed(lines[:index])) if line.strip())
            return TextHeader(tuple(names), len(names), delimiter, lines[index], index, header_at=at)
    return None


def _without_header(lines: Sequence[str], content: Sequence[int], place: int) -> TextHeader | None:
    """Take the line for the first row of a table without header if the next rows are like it."""
    index = content[place]
    for delimiter in _delimiters(lines[index]):
        if any(map(_may_be_names, _rows(lines, content[:place], delimiter))):
            continue  # what stands above may be a header that does not fit
        cells = split_cells(lines[index], delimiter)
        if _are_alike(cells, _rows(lines, content[place + 1 : place + 1 + ROWS], delimiter)):
            return TextHeader((), len(cells), delimiter, lines[index], index, titles=place)
    return None


def _may_be_names(cells: Sequence[str]) -> bool:
    """Tell whether a line holds several cells, and not only the numbers of half a row."""
    return len(cells) > 1 and not all(map(is_number, cells))


def _are_alike(cells: Sequence[str], rows: Sequence[Sequence[str]]) -> bool:
    """Tell whether cells are numbers, as many as in the next row; or the rows repeat their words as well."""
    if _are_numbers(cells):
        return all(len(row) == len(cells) for row in rows[:1])
    words = _words(cells)
    numbers = len(list(filter(None, cells))) - len(words)
    return numbers > 1 and bool(rows) and all(len(row) == len(cells) and _words(row) == words for row in rows)


def _words(cells: Sequence[str]) -> dict[int, str]:
    """Give the cells that hold something else than a number, by their places."""
    return {place: cell for place, cell in enumerate(cells) if cell and not is_number(cell)}


def _rows(lines: Sequence[str], at: Sequence[int], delimiter: str) -> list[list[str]]:
    return [split_cells(lines[index], delimiter) for index in at]


def _are_numbers(cells: Sequence[str]) -> bool:
    """Tell whether cells hold numbers or nothing, and at least two of them numbers."""
    filled = [cell for cell in cells if cell]
    return len(filled) > 1 and all(map(is_number, filled))


def _delimiters(line: str) -> Iterator[str]:
    """Give the separators that a line may have, the most frequent first, blanks last."""
    yield from sorted((mark for mark in DELIMITERS if mark in line), key=line.count, reverse=True)
    if len(line.split()) > 1:
        yield BLANKS


def _is_row(cells: Sequence[str], width: int) -> bool:
    return len(cells) == width and any(map(is_number, cells))


def _are_wide(rows: Sequence[Sequence[str]], width: int) -> bool:
    """Tell whether nearly all rows are as wide as the header: titles in pairs are no table."""
    return sum(len(cells) == width for cells in rows) > WIDE * len(rows)


def _are_units(cells: Sequence[str], width: int) -> bool:
    named = [cell.strip("[]()").lower() for cell in cells if cell]
    return len(cells) == width and bool(named) and all(unit in UNIT_WORDS for unit in named)
