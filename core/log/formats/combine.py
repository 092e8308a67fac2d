"""Make plain columns of lists that were written as text, and one clock of stamps in two columns.

A data set's lists become `[0.1, 0.2]` where they are saved as text, and a stamp of ROS is whole seconds and
nanoseconds beside them.
"""

import re
from collections.abc import Iterator, Sequence

import numpy as np

from ...arrays import Matrix
from ...errors import LogError
from .table import MemoryTable, Table, check_columns, check_values

NANOSECONDS = 1e9
STAMP = "stamp_s"
"""Name of the clock that is made of two columns."""
_SECONDS = re.compile(r"(.*?)(secs?|seconds|sek)$", re.IGNORECASE)
_NANOSECONDS = re.compile(r"(.*?)(nanosecs?|nsecs?|nanoseconds|nanosek)$", re.IGNORECASE)
_LIST = re.compile(r"\s*[\[(]([^\[\]()]*)[\])]\s*")
_BETWEEN = re.compile(r"[,;\s]+")


def split_lists(table: Table) -> Table:
    """Give columns for the places of lists that were written as text; the table as it is without any.

    Raises
    ------
    LogError
        If the lists of a column differ in length.
    """
    lists = {name: found for name in table.texts if (found := _lists(name, table)) is not None}
    if not lists:
        return table
    columns = dict(_numbers(table))
    for name, values in lists.items():
        columns |= {f"{name}_{place + 1}": values[:, place] for place in range(values.shape[1])}
    check_columns(list(columns))
    note = f"lists in {', '.join(map(repr, lists))} split into columns, from _1 on"
    return MemoryTable(columns, dict(table.units), (*table.notes, note))


def combine_stamps(table: Table) -> Table:
    """Give one clock for seconds and nanoseconds in two columns; the table as it is without them."""
    pair = _pair(table.names)
    if pair is None or table.texts:
        return table
    columns = dict(_numbers(table))
    seconds, nanoseconds = columns.get(pair[0]), columns.get(pair[1])
    if seconds is None or nanoseconds is None or len(seconds) == 0:
        return table
    stamps = (seconds - seconds[0]) + nanoseconds / NANOSECONDS
    note = f"{pair[0]!r} and {pair[1]!r} made one clock, from its first second on"
    return MemoryTable({STAMP: stamps} | columns, dict(table.units), (*table.notes, note))


def _by_stem(pattern: re.Pattern[str], names: Sequence[str]) -> dict[str, str]:
    return {found[1]: name for name in names if (found := pattern.fullmatch(name))}


def _pair(names: Sequence[str]) -> tuple[str, str] | None:
    """Find two columns that differ in the words for seconds and nanoseconds only."""
    fine = _by_stem(_NANOSECONDS, names)
    coarse = _by_stem(_SECONDS, [name for name in names if name not in fine.values()])
    return next(((coarse[stem], fine[stem]) for stem in coarse if stem in fine), None)


def _numbers(table: Table) -> Iterator[tuple[str, np.ndarray | None]]:
    """Read the columns of numbers; those that are none have no values."""
    for name in table.names:
        try:
            blocks = [block[0] for block in table.batches([name])] if name not in table.texts else []
        except LogError:
            blocks = []
        yield name, np.concatenate(blocks) if blocks else None


def _cells(word: str) -> list[str]:
    return _BETWEEN.split(word.strip(" []()")) if word else []


def _lists(name: str, table: Table) -> Matrix | None:
    """Read a column of lists as rows; None where it holds other text.

    A list that is missing, or of another length than the first, holds NaN.
    """
    words = table.words(name)
    if not words or not _LIST.fullmatch(words[0] or ""):
        return None
    cells = list(map(_cells, words))
    width = len(cells[0])
    check_values(width * len(cells))
    whole = np.flatnonzero(np.array(list(map(len, cells))) == width)
    if 2 * len(whole) < sum(map(bool, words)):
        raise LogError(
            f"the lists of the column {name!r} differ in length",
            evidence={"column": name, "first": words[0][:80], "others": len(cells) - len(whole)},
            remedy="give every row a number for every joint",
        )
    rows = np.full((len(cells), width), np.nan)
    try:
        rows[whole] = np.array([cells[row] for row in whole], dtype=np.float64)
    except ValueError:
        return None
    return rows
