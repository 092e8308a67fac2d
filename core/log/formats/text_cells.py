"""Cut lines of a text table into cells, and tell numbers and comments from other cells and lines."""

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

DELIMITERS = ",;\t"
BLANKS = " "
"""Stands for any number of blanks and tabs."""
COMMENT = re.compile(r"\s*(#+|//+|%%+|%(?=\s|$))")
"""Begins a comment above the rows. `%time` is the first name of a header."""


@dataclass(frozen=True)
class TextHeader:
    """Describe how a text table is to be read."""

    cells: tuple[str, ...]
    """Names of the columns as they stand; empty where there is no header."""
    width: int
    """Number of cells per row."""
    delimiter: str
    first_row: str
    skip: int
    """Physical lines before the first row of data."""
    header_at: int = 0
    """Physical line of the header, where there is one."""
    titles: int = 0
    """Lines above the header that are neither comments nor rows."""
    units: Mapping[str, str] = field(default_factory=dict)
    """What a row below the header says of each column's unit."""


def is_comment(line: str) -> bool:
    """Tell whether a line is blank or a comment."""
    return not line.strip() or COMMENT.match(line) is not None


def split_cells(line: str, delimiter: str) -> list[str]:
    """Cut a line into cells, without quotes."""
    if delimiter == BLANKS:
        return [cell.strip('"') for cell in line.split()]
    if '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]
    except csv.Error:  # a cell longer than any name or number
        return [cell.strip() for cell in line.split(delimiter)]


def is_number(cell: str) -> bool:
    """Tell whether a cell is a number, with a decimal point or comma."""
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True
