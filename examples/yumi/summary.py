"""Print a result document for a reader: what was found, how well each number is known, and how far it is from the truth.

The tables follow the study's Tables 2 (friction and offsets) and 3 (inertial parameters), with the true
values beside them.
"""

from collections.abc import Iterable, Mapping
from typing import Any, Final

from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

Document = Mapping[str, Any]
Truth = Mapping[str, float]

FRICTION: Final = ("OFF", "FC", "FV")
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
    table = Table(title=title, title_justify="left", caption="* essential", caption_justify="left")
    table.add_column("parameter")
    for heading in ("value", "%P", "95 % interval", "OLS"):
        table.add_column(heading, justify="right")
    if truth is not None:
        table.add_column("true", justify="right", style="cyan")
        table.add_column("z", justify="right")
    table.add_column("unit", style="dim")
    for row in rows:
        cells: list[RenderableType] = [
            f"{row['name']}{'*' if row.get('essential') else ''}",
            number(row["value"]),
            percent(row.get("relative_deviation_percent")),
            interval(row.get("interval_95")),
            number(row.get("value_ols")),
        ]
        if truth is not None:
            cells += [number(true_value(row, truth)), score(deviations(row, truth))]
        table.add_row(*cells, str(row.get("unit", "")))
    return table


def score_table(result: Document) -> Table:
    """Set the error of the predicted torque per joint in a table, fitted and held out."""
    table = Table(title="Error of the predicted torque", title_justify="left")
    headings = (
        "joint",
        "torque rms, N m",
        "fitted, % of range",
        "% of rms",
        "held out, % of range",
        "% of rms",
    )
    for heading in headings:
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
    """Sum up in a few sentences: how many parameters, whether the robot can exist, and how near the truth it is."""
    counts = result["counts"]
    feasibility, solver = result["feasibility"], result["solver"]
    smallest = min(feasibility["pseudo_inertia_min_eigenvalue"])
    lines = [
        f"Parameters: {counts['standard']} standard -> {counts['base']} base -> {counts['essential']} essential.",
        f"Ordinary least squares: {existence(feasibility.get('ols_feasible'))}.",
        f"Semidefinite programme: {existence(smallest > 0.0)}; smallest pseudo-inertia eigenvalue {smallest:.2g}.",
        f"Solver: {solver['status']}, {solver['iterations']} iterations; "
        f"objective {number(solver['objective'])} beside {number(solver['objective_ols'])} of least squares.",
    ]
    workspace = feasibility.get("mass_matrix_min_eigenvalue") or {}
    if "workspace" in workspace:
        lines.append(
            f"Smallest eigenvalue of the mass matrix: {number(workspace['workspace'])} kg m2 over "
            f"{workspace.get('configurations', 'all')} configurations."
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


def interval(bounds: Iterable[float] | None) -> str:
    """Write lower and upper bound."""
    return "" if bounds is None else " .. ".join(f"{bound:.3g}" for bound in bounds)


def score(z: float | None) -> Text:
    """Write a distance from the truth in standard deviations, red where it is far."""
    if z is None:
        return Text("")
    return Text(f"{z:+.1f}", style="red" if abs(z) > FAR else "")
