"""Print an identification: parameters, how well each is known, errors per joint, and a verdict in words."""

from collections.abc import Iterable, Mapping
from typing import Any, Final

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Table

Document = Mapping[str, Any]

FRICTION: Final = ("OFF", "FC", "FV")
LEFT: Final[dict[str, Any]] = {"title_justify": "left", "caption_justify": "left", "title_style": "bold"}


def print_result(console: Console, result: Document) -> None:
    """Print everything that a first reader asks."""
    friction, inertial = parted(result["base_parameters"])
    for title, part in (("Friction and offsets", friction), ("Base inertial parameters", inertial)):
        if part:
            console.print(parameter_table(title, part))
    console.print(score_table(result))
    for line in verdict(result):
        console.print(line)


def parted(rows: Iterable[Document]) -> tuple[list[Document], list[Document]]:
    """Part the parameters of friction and offsets from those of the bodies."""
    rows = list(rows)
    friction = [row for row in rows if str(row["name"]).startswith(FRICTION)]
    return friction, [row for row in rows if row not in friction]


def parameter_table(title: str, rows: Iterable[Document]) -> Table:
    """Set parameters in a table; a star marks the essential ones."""
    table = Table(title=title, caption="* essential", box=SIMPLE_HEAD, padding=(0, 1, 0, 0), **LEFT)
    table.add_column("")
    for heading in ("value", "deviation", "%P", "OLS"):
        table.add_column(heading, justify="right")
    table.add_column("unit", style="dim")
    for row in rows:
        table.add_row(
            f"{row['name']}{'*' if row.get('essential') else ''}",
            number(row["value"]),
            number(row.get("standard_deviation"), digits=2),
            percent(row.get("relative_deviation_percent")),
            number(row.get("value_ols")),
            str(row.get("unit", "")),
        )
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


def verdict(result: Document) -> list[str]:
    """Sum up in a few sentences: how many parameters, whether the robot can exist, what to look at twice."""
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
    return lines + [f"Look at this twice: {escape(doubt)}" for doubt in result.get("doubts", [])]


def existence(feasible: bool | None) -> str:  # noqa: FBT001  (three-valued answer, printed)
    """Say whether a robot can exist, as far as the document tells."""
    if feasible is None:
        return "not told whether such a robot can exist"
    return "[green]a robot that can exist[/]" if feasible else "[red]a robot that cannot exist[/]"


def number(value: float | None, *, digits: int = 4) -> str:
    """Write four significant digits, or as many as are asked for.

    Examples
    --------
    >>> number(0.0123456), number(0.0123456, digits=2), number(None)
    ('0.01235', '0.012', '')
    """
    return "" if value is None else f"{value:.{digits}g}"


def percent(value: float | None) -> str:
    """Write a percentage as far as it says anything."""
    if value is None:
        return ""
    return "> 999" if value > 999.0 else f"{value:.2f}" if value < 100.0 else f"{value:.0f}"
