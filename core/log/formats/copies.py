"""Tell columns of one name apart where all hold the same, as a clock that is written before every channel."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ...errors import LogError
from .table import Table, duplicate_columns


def told_apart(names: Sequence[str]) -> tuple[tuple[str, ...], dict[str, str]]:
    """Give every column a name of its own, and the names that copies had: the second `Time` is `Time (2)`.

    Examples
    --------
    >>> told_apart(["Time", "q_1", "Time"])
    (('Time', 'q_1', 'Time (2)'), {'Time (2)': 'Time'})

    Raises
    ------
    LogError
        If another column has such a name already.
    """
    seen: Counter[str] = Counter()
    apart: dict[str, str] = {}
    for name in names:
        seen[name] += 1
        apart[name if seen[name] == 1 else f"{name} ({seen[name]})"] = name
    if len(apart) < len(names):
        raise duplicate_columns([name for name, count in seen.items() if count > 1])
    return tuple(apart), {name: had for name, had in apart.items() if name != had}


def copy_notes(copies: Mapping[str, str]) -> Iterator[str]:
    """Say which columns are copies."""
    for name, count in Counter(copies.values()).items():
        yield f"{name!r}, which {count + 1} columns are called and all hold alike, read from the first"


def check_copies(table: Table, copies: Mapping[str, str]) -> None:
    """Refuse columns of one name that differ, since neither can be meant.

    Parameters
    ----------
    copies
        The names that were in the file, by those that the columns have now, where these differ.

    Raises
    ------
    LogError
        If a copy holds other values than the column whose name it had.
    """
    for name in dict.fromkeys(copies.values()):
        own = [copy for copy, had in copies.items() if had == name]
        if not {name, *own}.isdisjoint(table.texts) or not _are_alike(table, [name, *own]):
            raise duplicate_columns([name])


def _are_alike(table: Table, names: Sequence[str]) -> bool:
    """Tell whether columns hold the same numbers."""
    try:
        return all(
            np.array_equal(block[1:], np.tile(block[0], (len(block) - 1, 1)), equal_nan=True)
            for block in table.batches(names)
        )
    except LogError:
        return False
