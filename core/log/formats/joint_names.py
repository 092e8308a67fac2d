"""Name columns after joints where every row of the text says which joint is at which place.

`rostopic echo -p` and `ros2 topic echo --csv` write the names of a joint state's joints into every row, most
often in the order of the alphabet. A place in that list is no number of a joint.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile

from ...arrays import Series
from ...errors import LogError
from .table import BY_NUMBER, Table, check_columns

QUANTITIES = ("position", "velocity", "effort")
"""Fields of a joint state, in the order of the message."""
BEFORE_NAMES = ("sec", "nanosec", "frame_id")
"""What stands before the names where there is no header."""
_NAME = re.compile(r"(.*\.|)name(\d+)")


@dataclass(frozen=True)
class _Renamed:
    """Give a table's columns under other names; columns without a new name are not given."""

    table: Table
    renamed: Mapping[str, str]
    """Old names by new ones."""
    notes: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """List the columns in the file's order."""
        return tuple(self.renamed)

    @property
    def texts(self) -> tuple[str, ...]:
        """Name the columns of text that can be read."""
        texts = set(self.table.texts)
        return tuple(name for name, old in self.renamed.items() if old in texts)

    @property
    def units(self) -> Mapping[str, str]:
        """Give what the file itself says of its columns' units, outside their names."""
        units = self.table.units
        return {name: units[old] for name, old in self.renamed.items() if old in units}

    def words(self, name: str) -> list[str]:
        """Read a column of text."""
        return self.table.words(self.renamed[name])

    def batches(self, names: Sequence[str]) -> Iterator[Series]:
        """Read the named columns from the first row on."""
        return self.table.batches([self.renamed[name] for name in names])


def name_joints(table: Table) -> Table:
    """Name the columns of positions, velocities and efforts by their joints, where the rows name these.

    Raises
    ------
    LogError
        If the rows name different joints at one place.
    """
    new = _with_header(table) or _without_header(table)
    if not new:
        return table
    check_columns(list(new.values()))
    joints = [new_name.partition("position.")[2] for new_name in new.values() if "position." in new_name]
    note = f"columns named by the joints that every row names ({', '.join(joints[:16])})"
    return _Renamed(table, {name: old for old, name in new.items()}, (*table.notes, note))


def _with_header(table: Table) -> dict[str, str]:
    """Give new names for columns such as `field.position0`, of the joint that `field.name0` names."""
    found = filter(None, map(_NAME.fullmatch, table.texts))
    named = [match for match in found if f"{match[1]}position{match[2]}" in table.names]
    places: dict[str, str] = {}
    for match in named:
        joint = _joint(table, match[0])
        places |= {f"{match[1]}{value}{match[2]}": f"{match[1]}{value}.{joint}" for value in QUANTITIES}
    kept = set(table.names) - {match[0] for match in named}
    return {name: places.get(name, name) for name in table.names if name in kept} if named else {}


def _without_header(table: Table) -> dict[str, str]:
    """Give names for a joint state: seconds, nanoseconds, frame, names, and three numbers for each name."""
    if not all(name.startswith(BY_NUMBER) for name in table.names):
        return {}
    texts = set(table.texts)
    before, rest = table.names[: len(BEFORE_NAMES)], table.names[len(BEFORE_NAMES) :]
    named = list(takewhile(texts.__contains__, rest))
    if not named or len(rest) != len(named) * (1 + len(QUANTITIES)):
        return {}
    joints = [_joint(table, name) for name in named]
    columns = [f"{quantity}.{joint}" for quantity in QUANTITIES for joint in joints]
    clock = dict(zip(before[:2], BEFORE_NAMES, strict=False))
    return clock | dict(zip(rest[len(named) :], columns, strict=True))


def _joint(table: Table, column: str) -> str:
    """Give the joint that all rows name in a column."""
    joints = list(dict.fromkeys(filter(None, table.words(column))))
    if len(joints) != 1:
        raise LogError(
            "the rows name different joints at one place",
            evidence={"column": column, "joints": joints[:16]},
            remedy="keep the rows of one publisher, or give every joint columns of its own",
        )
    return joints[0]
