"""Print the model of one joint: what is seen of its elasticity, then parameters and errors."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape

from .columns import Column, print_table
from .tables import number
from .warnings import print_warnings

Document = Mapping[str, Any]
MISSING = "-"


def print_joint_model(console: Console, document: Document) -> None:
    """Print warnings, the statement on elasticity, and a table per model."""
    print_warnings(console, document)
    data = document["data"]
    console.print(
        f"Joint {document['joint']} ({document['joint_type']}), {escape(document['estimator_title'])}:"
        f" {data['samples']} samples at {number(data['rate_hz'])} Hz"
    )
    console.print(escape(document["flexibility"]["statement"]))
    for model in document["models"]:
        if model["parameters"]:
            rows = [*model["parameters"], *model["frequencies"]]
            print_table(console, parameter_columns(rows), title=f"{model['order'].capitalize()} model")
    print_table(console, error_columns(document["models"]), title="Errors on held-out rows")


def parameter_columns(rows: Sequence[Document]) -> list[Column]:
    """Give value, deviation and interval of every parameter."""
    return [
        Column("parameter", [f"{row['name']} ({row['symbol']})" for row in rows], is_text=True),
        Column("value", [number(row["value"]) for row in rows]),
        Column("deviation", [number(row["standard_deviation"], digits=2) for row in rows]),
        Column("%P", [_shown(row["relative_deviation_percent"]) for row in rows]),
        Column("95 % interval", [" to ".join(map(number, row["interval_95"])) for row in rows], spare=1),
        Column("unit", [row["unit"] for row in rows], is_text=True),
    ]


def error_columns(models: Sequence[Document]) -> list[Column]:
    """Give the errors and the convergence of every model."""
    return [
        Column("model", [model["order"] for model in models], is_text=True),
        Column("torque, %", [_shown(model["torque_error_percent"]) for model in models]),
        Column("below, Hz", [_shown(model["crossover_hz"]) for model in models]),
        Column("simulated position, %", [_shown(model["simulated_position_percent"]) for model in models]),
        Column("steps", [str(len(model["steps"])) for model in models]),
        Column("answer", ["no" if model["failure"] else "yes" for model in models], is_text=True),
    ]


def _shown(value: float | None) -> str:
    return MISSING if value is None else number(value, digits=3)
