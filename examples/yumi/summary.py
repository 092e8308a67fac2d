"""Print a result document for a reader: what was found, how well it is known, how far it is from the truth.

The tables follow the study's Tables 2 (friction and offsets) and 3 (inertial parameters), with the true
values beside them.
"""

from collections.abc import Iterable, Mapping
from typing import Any, Final

from rich.box import SIMPLE_HEAD
from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

from veritorque.app.terminal.output import tables
from veritorque.app.terminal.output.columns import print_table
from veritorque.app.terminal.output.tables import by_kind, number, percent, score_columns

Document = Mapping[str, Any]
Truth = Mapping[str, float]

LEFT: Final[dict[str, Any]] = {"title_justify": "left", "caption_justify": "left", "title_style": "bold"}
FAR: Final = 3.0
"""Standard deviations from the truth beyond which a number is shown in red."""


def print_summary(console: Console, result: Document, truth: Truth | None = None) -> None:
    """Print the result; true values only where the truth is known."""
    friction, inertial = by_kind(result["base_parameters"])
    for title, part in (("Friction and offsets", friction), ("Base inertial parameters", inertial)):
        console.print(parameter_table(title, part, truth))
    print_table(console, score_columns(result), title="Torque prediction error, % of range and of RMS")
    for line in summary(result, truth):
        console.print(line)


def true_value(row: Document, truth: Truth) -> float | None:
    """Add up the true standard parameters that a base parameter groups; None where one of them is unknown.

    Examples
    --------
    >>> true_value({"relation": {"ZZ1": 1.0, "M2": 0.25}}, {"ZZ1": 0.5, "M2": 2.0})
    1.0
    """
    relation: Mapping[str, float] = row.get("relation") or {}
    if not relation or not relation.keys() <= truth.keys():
        return None
    return sum(coefficient * truth[name] for name, coefficient in relation.items())


def deviations(row: Document, truth: Truth | None) -> float | None:
    """Say how many standard deviations the estimate lies above the truth."""
    expected = None if truth is None else true_value(row, truth)
    spread = row.get("standard_deviation")
    return (row["value"] - expected) / spread if expected is not None and spread else None


def parameter_table(title: str, rows: Iterable[Document], truth: Truth | None) -> Table:
    """Set parameters in a table; a star marks the essential ones."""
    table = Table(title=title, caption="* essential", box=SIMPLE_HEAD, padding=(0, 1, 0, 0), **LEFT)
    table.add_column("")
    for heading in ("value", "± 95 %", "%P", "OLS"):
        table.add_column(heading, justify="right")
    if truth is not None:
        table.add_column("true", justify="right", style="cyan")
        table.add_column("z", justify="right")
    table.add_column("unit", style="dim")
    for row in rows:
        cells: list[RenderableType] = [
            f"{row['name']}{'*' if row.get('essential') else ''}",
            number(row["value"]),
            half_width(row.get("interval_95")),
            percent(row.get("relative_deviation_percent")),
            number(row.get("value_ols")),
        ]
        if truth is not None:
            cells += [number(true_value(row, truth)), score(deviations(row, truth))]
        table.add_row(*cells, str(row.get("unit", "")))
    return table


def summary(result: Document, truth: Truth | None) -> list[str]:
    """Summarise the result, and how close the parameters are to the truth."""
    lines = tables.summary(result)
    scores = [abs(z) for row in result["base_parameters"] if (z := deviations(row, truth)) is not None]
    if scores:
        near = sum(z <= 1.96 for z in scores)
        lines.append(f"Truth: {near} of {len(scores)} base parameters within 1.96 standard deviations of it.")
    return lines


def half_width(interval: tuple[float, float] | None) -> str:
    """Write half the width of an interval."""
    return "" if interval is None else f"{(interval[1] - interval[0]) / 2.0:.2g}"


def score(z: float | None) -> Text:
    """Write a distance from the truth in standard deviations, red where it is far."""
    if z is None:
        return Text("")
    return Text(f"{z:+.1f}", style="red" if abs(z) > FAR else "")
