"""Make columns of a long table, whose every row carries one joint, or one signal, at one instant.

The column that names the joint is one of text, or of numbers under a name that says so; stamps occur once per
joint. What is left of a row are the joint's values, which become columns `value.joint`.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...errors import LogError
from .table import MemoryTable, Table, check_columns, check_values

KEY_WORDS = frozenset(
    (
        "joint",
        "joint_name",
        "name",
        "motor",
        "motor_id",
        "axis",
        "id",
        "joint_id",
        "servo",
        "actuator",
        "signal",
    )
)
"""Names of the column that says which joint a row is of, in small letters."""
RUN_WORDS = frozenset(("name", "id"))
"""Of these the ones that may as well call a run."""
VALUE_WORDS = frozenset(("value", "values", "val", "data"))
"""Names of a single column whose meaning is the key's."""
FEWEST_TURNS = 0.9
"""At least this share of the rows name the joint that was named as many rows before as there are joints, and
another one than the row before."""
MOST_IN_TURN = 0.5
"""The mean square by which some value changes from turn to turn is less than this share of that from row to
row. Between samples of one signal it is larger."""
FEWEST_REPEATS = 0.5
"""At least this share of the stamps repeat the row before in a table of two joints or more."""
MOST_KEYS = 64
MOST_SHARED = 0.5
"""Of the instants more than this share have a row of every joint where single rows are missing; fewer have
where each joint was sampled at its own."""


@dataclass(frozen=True, eq=False)
class _Long:
    """Carry a long table."""

    key: str
    keys: list[str]
    """The joints or signals, in the order in which they first occur."""
    rows: list[np.ndarray]
    """Rows of each."""
    stamp: str
    values: tuple[str, ...]


def widen(table: Table) -> Table:
    """Give a table with a column per joint, if the table is a long one; any other as it is.

    Raises
    ------
    LogError
        If joints have different stamps, so that their rows belong to different instants.
    """
    found = _long(table)
    if found is None:
        return table
    block = np.hstack(list(table.batches((found.stamp, *found.values))))
    stamps, places = _shared_stamps(found, block[0])
    columns: dict[str, np.ndarray | None] = {found.stamp: stamps}
    for name, values in zip(found.values, block[1:], strict=True):
        for key, rows, at in zip(found.keys, found.rows, places, strict=True):
            column = np.full(len(stamps), np.nan)
            column[at] = values[rows]
            columns[_name(found, name, key)] = column
    check_columns(list(columns))
    check_values(len(columns) * len(stamps))
    note = (
        f"rows of one {found.key} each, {len(found.keys)} of them ({', '.join(found.keys[:8])}), made columns"
    )
    units = {found.stamp: table.units[found.stamp]} if found.stamp in table.units else {}
    return MemoryTable(columns, units, (*table.notes, note))


def _is_key(name: str) -> bool:
    return name.lower() in KEY_WORDS


def _first(names: Iterable[str], matches: Callable[[str], bool]) -> str | None:
    return next(filter(matches, names), None)


def _long(table: Table) -> _Long | None:
    """Recognise a long table by its key and by stamps that repeat."""
    key, stamp = _first(table.names, _is_key), _first(table.names, _is_stamp)
    if key is None or stamp is None:
        return None
    texts = set(table.texts)
    values = tuple(name for name in table.names if name not in {key, stamp, *texts})
    words = table.words(key) if key in texts else _numbers(table, key)
    keys = list(dict.fromkeys(filter(None, words)))
    if not values or not 2 <= len(keys) <= MOST_KEYS:
        return None
    stamps = np.hstack(list(table.batches([stamp])))[0]
    named = np.array(words)
    rows = [np.flatnonzero(named == word) for word in keys]
    is_long = _are_together(stamps, len(keys)) or _follow_each_other(key, stamps, rows)
    if not is_long and not _take_turns(table, named, len(keys), values):
        return None  # a row per instant whose key says something else
    return _Long(key, keys, rows, stamp, values)


def _are_together(stamps: np.ndarray, keys: int) -> bool:
    """Tell whether the rows of an instant are one of each joint's."""
    return bool(np.mean(np.diff(stamps) == 0.0) >= FEWEST_REPEATS * (1.0 - 1.0 / keys))


def _follow_each_other(key: str, stamps: np.ndarray, rows: Sequence[np.ndarray]) -> bool:
    """Tell whether all rows of a joint stand before those of the next, at the same instants.

    So do the rows of two runs, whose key is a name or a number but tells no joint.
    """
    if key.lower() in RUN_WORDS or any(len(own) != own[-1] - own[0] + 1 for own in rows):
        return False
    return all(np.array_equal(stamps[own], stamps[rows[0]]) for own in rows)


def _take_turns(table: Table, named: np.ndarray, keys: int, values: tuple[str, ...]) -> bool:
    """Tell whether joints that are asked one after the other each have a row, and columns without numbers.

    A counter that starts again has turns, too; the values beside it go on from row to row.
    """
    if len(named) <= keys or any(name[-1:].isdigit() for name in values):
        return False
    turns = np.mean(named[keys:] == named[:-keys]), np.mean(named[1:] != named[:-1])
    if min(turns) < FEWEST_TURNS:
        return False
    try:
        block = np.hstack(list(table.batches(values)))
    except LogError:
        return False
    in_turn, by_row = (np.nansum((block[:, by:] - block[:, :-by]) ** 2, axis=1) for by in (keys, 1))
    return bool(np.any(in_turn < MOST_IN_TURN * by_row))


def _is_stamp(name: str) -> bool:
    word = name.lower().lstrip("%").split("[")[0].split("(")[0].strip()
    return word in ("time", "t", "timestamp", "stamp") or word.startswith(("time_", "timestamp_", "stamp_"))


def _numbers(table: Table, key: str) -> list[str]:
    """Read a key of whole numbers, empty where one is missing; nothing where they are none."""
    try:
        numbers = np.hstack(list(table.batches([key])))[0]
    except LogError:
        return []
    known = np.isfinite(numbers)
    whole = bool(known.any()) and bool(np.all(numbers[known] == np.rint(numbers[known])))
    return [str(int(number)) if np.isfinite(number) else "" for number in numbers] if whole else []


def _shared_stamps(found: _Long, stamps: np.ndarray) -> tuple[np.ndarray, list[np.ndarray | slice]]:
    """Give all stamps, and where those of each joint stand among them: a joint may lack some rows."""
    own = [stamps[rows] for rows in found.rows]
    if all(np.array_equal(others, own[0]) for others in own):
        return np.asarray(own[0]), [slice(None)] * len(own)
    every, counts = np.unique(np.concatenate(own), return_counts=True)
    in_order = all(np.all(np.diff(stamps) > 0.0) for stamps in own)
    if in_order and np.count_nonzero(counts == len(own)) > MOST_SHARED * len(every):
        return every, [np.searchsorted(every, stamps_of_joint) for stamps_of_joint in own]
    raise LogError(
        f"the rows of different {found.key}s have different stamps",
        evidence={
            "rows": dict(zip(found.keys[:16], map(len, own), strict=False)),
            "first_stamps": dict(zip(found.keys[:16], [float(stamps[0]) for stamps in own], strict=False)),
        },
        remedy=f"write one row per {found.key} and instant, all of an instant under one stamp; or write each "
        f"{found.key} to a file of its own and join the files",
    )


def _name(found: _Long, value: str, key: str) -> str:
    return key if len(found.values) == 1 and value.lower() in VALUE_WORDS else f"{value}.{key}"
