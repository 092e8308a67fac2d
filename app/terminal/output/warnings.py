"""Print what stands before a result: conflicts of robot and logs with their correction, and warnings."""

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.padding import Padding

from ....core.report.page.conflicts import disagreements, other_warnings


def print_warnings(console: Console, result: Mapping[str, Any]) -> None:
    """Print conflicts and warnings; nothing where there are none."""
    for conflict in disagreements(result):
        for heading, sentences in conflict.conflicts:
            console.print(f"[bold red]{escape(heading)}[/]")
            for sentence in sentences:
                console.print(Padding(escape(sentence), (0, 0, 0, 3), expand=False))
        ends = " Correction to paste:" if conflict.correction else ""
        console.print(Padding(f"{escape(conflict.applied)}{ends}", (0, 0, 0, 3), expand=False))
        if conflict.correction:
            console.print(conflict.correction, markup=False, highlight=False, soft_wrap=True)
        console.print()
    for warning in other_warnings(result):
        console.print(f"[yellow]Warning:[/] {escape(warning)}")
