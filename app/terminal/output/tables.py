"""Print an identification: parameters with standard deviations, errors per joint, and a summary."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from rich.console import Console
from rich.markup import escape

from ....core.report.page.units import unit_of_effort
from .columns import Column, print_table
from .warnings import print_warnings

Document = Mapping[str, Any]
FRICTION: Final = ("OFF", "FC", "FV")
READ_OTHERWISE: Final = (
    "rearranged", "missing_values", "doubled_rows", "blank_rows", "lost_values", "bad_end", "time_restarts",
    "shuffled_rows", "broken_stamps",
)  # fmt: skip  # a table
"""Defects of a log by which it was read otherwise than it stands in its file."""


def print_result(console: Console, result: Document) -> None:
    """Print warnings, parameters, errors and the summary."""
    print_warnings(console, result)
    friction, inertial = by_kind(result["base_parameters"])
    for title, part in (("Friction and offsets", friction), ("Base inertial parameters", inertial)):
        if part:
            print_table(console, parameter_columns(part), title=title, caption="* essential")
    title = "Torque prediction error, % of range and of RMS"
    print_table(console, score_columns(result), title=title)
    for line in summary(result):
        console.print(line)


def by_kind(rows: Iterable[Document]) -> tuple[list[Document], list[Document]]:
    """Separate parameters of friction and offsets from inertial ones."""
    rows = list(rows)
    friction = [row for row in rows if str(row["name"]).startswith(FRICTION)]
    return friction, [row for row in rows if row not in friction]


def parameter_columns(rows: Sequence[Document]) -> list[Column]:
    """Give the columns of a table of parameters; a star marks the essential ones."""
    return [
        Column("", [f"{row['name']}{'*' if row.get('essential') else ''}" for row in rows], is_text=True),
        Column("value", [number(row["value"]) for row in rows]),
        Column("std. dev.", [number(row.get("standard_deviation"), digits=2) for row in rows], spare=2),
        Column("%P", [percent(row.get("relative_deviation_percent")) for row in rows]),
        Column("OLS", [number(row.get("value_ols")) for row in rows], spare=3),
        Column("unit", [str(row.get("unit", "")) for row in rows], is_text=True, spare=1),
    ]


def score_columns(result: Document) -> list[Column]:
    """Give the error of the predicted torque per joint, fitted and held out."""
    fitted = result["fit"]
    by_joint = {row["joint"]: row for row in result.get("validation") or []}
    held_out = [by_joint.get(row["joint"], {}) for row in fitted]
    errors = [
        Column(f"{name}: {label}", [percent(row.get(f"nrmse_of_{key}_percent")) for row in rows], spare=spare)
        for name, rows, spare in (("fitted", fitted, 2), ("held out", held_out, 0))
        for key, label in (("range", "range"), ("rms", "RMS"))
    ]
    return [
        Column("joint", [str(row["joint"]) for row in fitted]),
        effort_column(result, "RMS", fitted, "rms_torque", spare=1),
        *errors,
    ]


def effort_column(result: Document, heading: str, rows: Sequence[Document], key: str, spare: int) -> Column:
    """Give the column of joint torques; with prismatic joints among them, every row states its unit."""
    numbers = [number(row.get(key)) for row in rows]
    units = [unit_of_effort(result, row["joint"]) for row in rows]
    if len(set(units)) == 1:
        return Column(f"{heading}, {units[0]}", numbers, spare=spare)
    cells = [f"{value} {unit}" if value else "" for value, unit in zip(numbers, units, strict=True)]
    return Column(heading, cells, spare=spare)


def summary(result: Document) -> list[str]:
    """Summarise parameter counts, physical consistency, solver and estimator, and how the logs were read."""
    counts, feasibility, solver = result["counts"], result["feasibility"], result["solver"]
    smallest = min(feasibility["pseudo_inertia_min_eigenvalue"])
    objective, least = number(solver["objective"]), number(solver["objective_ols"])
    steps = " -> ".join(f"{counts[kind]} {kind}" for kind in ("standard", "base", "essential"))
    lines = [
        f"Parameters: {steps}.",
        f"Least squares: {consistency(feasibility.get('ols_feasible'))}.",
        f"Identified parameters: {consistency(feasibility.get('feasible'))}.",
        f"Smallest eigenvalue of a link's pseudo-inertia: {smallest:.2g}.",
        f"Solver: {solver['status']}, {solver['iterations']} iterations.",
        f"Cost of the consistency constraint: objective {objective}, least squares {least}.",
    ]
    workspace = feasibility.get("mass_matrix_min_eigenvalue") or {}
    if "workspace" in workspace:
        lines.append(
            f"Smallest eigenvalue of the mass matrix in {workspace.get('configurations', 'all')} "
            f"configurations: {number(workspace['workspace'])}."
        )
    estimation = result.get("estimation") or {}
    return [*lines, *estimation.get("statements", []), *reading_lines(result)]


def reading_lines(result: Document) -> list[str]:
    """Say in what the logs were read otherwise than they stand in their files.

    Examples
    --------
    >>> reading_lines({"defects": [{"log": 1, "kind": "rearranged", "statement": "It was sorted."}]})
    ['Log 1: It was sorted.']
    """
    defects = [defect for defect in result.get("defects", []) if defect["kind"] in READ_OTHERWISE]
    return [f"Log {defect['log']}: {escape(defect['statement'])}" for defect in defects]


def consistency(feasible: bool | None) -> str:  # noqa: FBT001  (three-valued answer, printed)
    """Describe the physical consistency of a robot; None means unknown."""
    if feasible is None:
        return "physical consistency unknown"
    return "[green]physically consistent[/]" if feasible else "[red]physically inconsistent[/]"


def number(value: float | None, *, digits: int = 4) -> str:
    """Write four significant digits, or as many as are asked for.

    Examples
    --------
    >>> number(0.0123456), number(0.0123456, digits=2), number(None)
    ('0.01235', '0.012', '')
    """
    return "" if value is None else f"{value:.{digits}g}"


def percent(value: float | None) -> str:
    """Write a percentage with two decimals; large values without or as a bound."""
    if value is None:
        return ""
    return "> 999" if value > 999.0 else f"{value:.2f}" if value < 100.0 else f"{value:.0f}"
