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

Document = Mapping[str, Any]
Truth = Mapping[str, float]

FRICTION: Final = ("OFF", "FC", "FV")
LEFT: Final[dict[str, Any]] = {"title_justify": "left", "caption_justify": "left", "title_style": "bold"}
FAR: Final = 3.0
"""Standard deviations from the truth beyond which a number is shown in red."""


def print_summary(console: Console, result: Document, truth: Truth | None = None) -> None:
    """Print everything a first reader asks; true values only where the truth is known."""
    rows = result["base_parameters"]
    friction = [row for row in rows if str(row["name"]).startswith(FRICTION)]
    inertial = [row for row in rows if not str(row["name"]).startswith(FRICTION)]
    for title, part in (("Friction and offsets", friction), ("Base inertial parameters", inertial)):
        console.print(parameter_table(title, part, truth))
    console.print(score_table(result))
    for line in verdict(result, truth):
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


def score_table(result: Document) -> Table:
    """Set the error of the predicted torque per joint in a table, fitted and held out."""
    table = Table(
        title="Error of the predicted torque, % of its range and of its rms", box=SIMPLE_HEAD, **LEFT
    )
    for heading in ("joint", "rms, N m", "fitted: range", "rms", "held out: range", "rms"):
        table.add_column(heading, justify="right")
    unseen = {row["joint"]: row for row in result.get("validation") or []}
    for row in result["fit"]:
        other = unseen.get(row["joint"], {})
        table.add_row(
            str(row["joint"]),
            number(row.get("rms_torque")),
            *(
                percent(part.get(f"nrmse_of_{of}_percent"))
                for part in (row, other)
                for of in ("range", "rms")
            ),
        )
    return table


def verdict(result: Document, truth: Truth | None) -> list[str]:
    """Sum up in a few sentences: how many parameters, whether the robot can exist, how near the truth."""
    counts, feasibility, solver = result["counts"], result["feasibility"], result["solver"]
    smallest = min(feasibility["pseudo_inertia_min_eigenvalue"])
    objective, least = number(solver["objective"]), number(solver["objective_ols"])
    steps = " -> ".join(f"{counts[kind]} {kind}" for kind in ("standard", "base", "essential"))
    lines = [
        f"Parameters: {steps}.",
        f"Least squares: {existence(feasibility.get('ols_feasible'))}.",
        f"Semidefinite programme: {existence(smallest > 0.0)}.",
        f"Smallest eigenvalue of a link's pseudo-inertia: {smallest:.2g}.",
        f"Solver: {solver['status']}, {solver['iterations']} iterations.",
        f"Price of existence: objective {objective} beside {least} of least squares.",
    ]
    workspace = feasibility.get("mass_matrix_min_eigenvalue") or {}
    if "workspace" in workspace:
        lines.append(
            f"Smallest eigenvalue of the mass matrix in {workspace.get('configurations', 'all')} "
            f"configurations: {number(workspace['workspace'])}."
        )
    scores = [abs(z) for row in result["base_parameters"] if (z := deviations(row, truth)) is not None]
    if scores:
        near = sum(z <= 1.96 for z in scores)
        lines.append(f"Truth: {near} of {len(scores)} base parameters within 1.96 standard deviations of it.")
    return lines


def existence(feasible: bool | None) -> str:  # noqa: FBT001  (three-valued answer, printed)
    """Say whether a robot can exist, as far as the document tells."""
    if feasible is None:
        return "not told whether such a robot can exist"
    return "[green]a robot that can exist[/]" if feasible else "[red]a robot that cannot exist[/]"


def number(value: float | None) -> str:
    """Write four significant digits."""
    return "" if value is None else f"{value:.4g}"


def percent(value: float | None) -> str:
    """Write a percentage as far as it says anything."""
    if value is None:
        return ""
    return "> 999" if value > 999.0 else f"{value:.2f}" if value < 100.0 else f"{value:.0f}"


def half_width(interval: tuple[float, float] | None) -> str:
    """Write half the width of an interval."""
    return "" if interval is None else f"{(interval[1] - interval[0]) / 2.0:.2g}"


def score(z: float | None) -> Text:
    """Write a distance from the truth in standard deviations, red where it is far."""
    if z is None:
        return Text("")
    return Text(f"{z:+.1f}", style="red" if abs(z) > FAR else "")
