"""Print a diagnosis, and beside it what had been hidden in the log, where that is known."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from examples.yumi.summary import LEFT, score
from veritorque.app.terminal.output import findings
from veritorque.app.terminal.output.findings import cause_on_joints
from veritorque.app.terminal.output.tables import number

Document = Mapping[str, Any]


def print_diagnosis(console: Console, result: Document, hidden: Sequence[Document] | None = None) -> None:
    """Print findings, gains and what is left; beside them what had been hidden, where that is known."""
    findings.print_diagnosis(console, result)
    if hidden:
        console.print(truth_table(result["diagnosis"]["findings"], hidden))


def truth_table(found: Sequence[Document], hidden: Sequence[Document]) -> Table:
    """Set what had been hidden beside what was found, and how many standard deviations lie between."""
    title, caption = "\nHidden effects and findings", "z: deviation from the truth in standard deviations"
    table = Table(title=title, caption=caption, box=SIMPLE_HEAD, **LEFT)
    table.add_column("hidden")
    for heading in ("", "true", "found", "z"):
        table.add_column(heading, justify="right")
    for effect in hidden:
        sizes = sizes_found(found, effect)
        for name, true in effect["parameters"].items():
            value, deviation = sizes.get(name, (None, None))
            shown = "not found" if value is None else f"{value:.4g} ± {deviation:.2g}"
            z = (value - true) / deviation if value is not None and deviation else None
            table.add_row(cause_on_joints(effect), name.replace("_", " "), number(true), shown, score(z))
    return table


def sizes_found(found: Sequence[Document], effect: Document) -> dict[str, tuple[float | None, float | None]]:
    """Give, by name, the sizes that were found for an effect's cause on its joints; none if it was missed."""
    return {
        one["name"]: (one["value"], one["standard_deviation"])
        for finding in found
        if finding["cause"] == effect["cause"] and finding["joints"] == effect["joints"]
        for one in finding["parameters"]
    }
