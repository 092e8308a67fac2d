"""Find the header of a text table whose lines begin with what they say, and repeat it for every clock.

TwinCAT Scope writes so: a line of names, lines of types, units and more, and a clock in milliseconds before
every channel, or before those that share a rate. A line's first word stands again wherever a clock is.
"""

from collections.abc import Sequence
from itertools import takewhile

from ..columns.named_units import UNIT_WORDS
from .text_cells import DELIMITERS, TextHeader, is_number, split_cells

FIRST, UNITS = "Name", "Unit"
CLOCK = "Time [ms]"


def find_labelled(lines: Sequence[str], content: Sequence[int], place: int) -> TextHeader | None:
    """Take the line for one of names if lines of that form follow down to a row of numbers."""
    found = (_found(lines, content, place, delimiter) for delimiter in DELIMITERS)
    return next(filter(None, found), None)


def _found(lines: Sequence[str], content: Sequence[int], place: int, delimiter: str) -> TextHeader | None:
    names = _without_end(split_cells(lines[content[place]], delimiter))
    if len(names) < 2 or names[0] != FIRST:
        return None
    labels = _labels(lines, content[place + 1 :], delimiter, names)
    row_at = place + 1 + len(labels)
    is_table = labels or names.count(FIRST) > 1  # else one whose first column has this name
    row = split_cells(lines[content[row_at]], delimiter) if row_at < len(content) else []
    if not is_table or not all(map(is_number, _fitted(row, len(names)))):
        return None
    called = _called(names)
    return TextHeader(
        cells=(*called, *row[len(names) :]),
        width=len(row),
        delimiter=delimiter,
        first_row=lines[content[row_at]],
        skip=content[row_at],
        header_at=content[place],
        titles=place + len(labels),
        units=_units(called, labels),
    )


def _called(names: Sequence[str]) -> list[str]:
    """Call the columns whose name is the line's first word by what they are."""
    return [CLOCK if name == FIRST else name for name in names]


def _labels(
    lines: Sequence[str], below: Sequence[int], delimiter: str, names: Sequence[str]
) -> list[list[str]]:
    """Give the lines that repeat their first word where the names repeat theirs."""
    cells = (_fitted(split_cells(lines[index], delimiter), len(names)) for index in below)
    return list(takewhile(lambda own: _places(own) == _places(names), cells))


def _units(called: Sequence[str], labels: Sequence[Sequence[str]]) -> dict[str, str]:
    """Give what the line of units says of each column."""
    line = next((cells for cells in labels if cells[0] == UNITS), [])
    said = {name: unit.strip("[]()") for name, unit in zip(called, line, strict=False)}
    return {name: unit for name, unit in said.items() if unit.lower() in UNIT_WORDS}


def _places(cells: Sequence[str]) -> list[int]:
    """Give the places of a line's first word, where it is one."""
    return [] if is_number(cells[0]) else [at for at, cell in enumerate(cells) if cell == cells[0]]


def _fitted(cells: Sequence[str], width: int) -> list[str]:
    """Give so many cells of a line, empty ones behind its end; none where it holds more."""
    return [""] * width if any(cells[width:]) else [*cells, *[""] * (width - len(cells))][:width]


def _without_end(cells: list[str]) -> list[str]:
    """Leave out the empty cells behind the last name."""
    return cells[: 1 + max((at for at, cell in enumerate(cells) if cell), default=-1)]
