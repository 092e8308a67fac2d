"""Set a table in the columns that a terminal has; no number and no name is ever cut.

Where a table is too wide, its headings are folded. Where that is not enough, columns that matter less are
left out, and named. What is left then runs over the edge, where the terminal folds it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from rich.box import SIMPLE_HEAD
from rich.cells import cell_len
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

UNBOUNDED = 100_000


@dataclass(frozen=True)
class Column:
    """Hold one column."""

    heading: str
    cells: Sequence[str]
    is_text: bool = False
    """Set to the left, as words are."""
    spare: int = 0
    """0 for a column that is always shown; of the others the highest is left out first."""

    @property
    def narrowest(self) -> int:
        """Give the width that the cells need, with the heading folded between its words."""
        return max(map(cell_len, (*self.cells, *self.heading.split())), default=0)


def print_table(
    console: Console,
    columns: Sequence[Column],
    *,
    title: str = "",
    caption: str = "",
    styles: Sequence[str] = (),
) -> None:
    """Print a table as wide as the console allows.

    Parameters
    ----------
    styles
        One a row; plain if empty.
    """
    shown = _fitting(console, columns)
    if title:
        console.print(Text(title, style="bold"))
    table = _table(shown, styles, fold=_width(console, _table(shown, styles, fold=False)) > console.width)
    if (needed := _width(console, table)) > console.width:
        table.width = needed
    console.print(table, crop=False)
    left_out = [column.heading for column in columns if column not in shown]
    notes = [caption, f"columns omitted: {', '.join(left_out)}" if left_out else ""]
    for note in filter(None, notes):
        console.print(Text(note, style="dim italic"))


def _fitting(console: Console, columns: Sequence[Column]) -> list[Column]:
    """Leave out spare columns until the rest fits, or none is left."""
    shown = list(columns)
    while _width(console, _table(shown, (), fold=True)) > console.width:
        spare = max(shown, key=lambda column: column.spare)
        if not spare.spare:
            break
        shown.remove(spare)
    return shown


def _table(columns: Sequence[Column], styles: Sequence[str], *, fold: bool) -> Table:
    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for column in columns:
        table.add_column(
            Text(column.heading),
            justify="left" if column.is_text else "right",
            width=column.narrowest if fold else None,
            no_wrap=not fold,
        )
    rows = list(zip(*(column.cells for column in columns), strict=True))
    for row, style in zip(rows, styles or [""] * len(rows), strict=True):
        table.add_row(*map(Text, row), style=style)
    return table


def _width(console: Console, table: Table) -> int:
    return Measurement.get(console, console.options.update(max_width=UNBOUNDED), table).maximum
