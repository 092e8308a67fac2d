"""Print a diagnosis in plain words: what the simulation gets wrong, why, what the cure gains, what is left.

The full story with its figures is in the report; this is what a reader sees first.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from examples.yumi.summary import LEFT, number, percent

Document = Mapping[str, Any]


def print_diagnosis(console: Console, result: Document, hidden: Sequence[Document] | None = None) -> None:
    """Print findings, gains and what is left; beside them what had been hidden, where that is known."""
    diagnosis = result["diagnosis"]
    findings = diagnosis["findings"]
    if not findings:
        console.print("[bold]Nothing that this log can show is wrong with the simulation.[/]")
    for place, finding in enumerate(findings, start=1):
        console.print(f"\n[bold]{place}. {escape(finding['statement'])}.[/]")
        for line in reasons(finding):
            console.print(f"   {escape(line)}")
    if diagnosis["gain"]:
        console.print(gain_table(diagnosis["gain"]))
    console.print(remainder(diagnosis["unexplained"]))
    for effect in hidden or ():
        console.print(f"Hidden was: {escape(in_words(effect))}.")


def reasons(finding: Document) -> list[str]:
    """Say how sure a finding is, what it gains, and how its rivals stood."""
    lines = [f"Confidence {100.0 * finding['confidence']:.0f} %."]
    gain = finding["gain"]
    if gain is not None and gain["interval_95"] is not None:
        low, high = gain["interval_95"]
        joints = "the joint" if len(finding["joints"]) == 1 else "these joints"
        lines.append(
            f"Alone it takes {gain['improvement_total_percent']:.0f} % ({low:.0f} to {high:.0f} %) of the "
            f"error on {joints} away, on data that no fit has seen."
        )
    undecided, refuted = finding["ambiguous_with"], finding["refuted"]
    lines += [
        f"Not told apart from {spoken(rival)}; this would separate them: {rival['separating_experiment']}."
        for rival in undecided
    ]
    lines += [f"Refuted: {spoken(rival)}: {rival['why']}." for rival in refuted]
    return lines if undecided or refuted else [*lines, "No other known cause explains nearly as much."]


def gain_table(gains: Sequence[Document]) -> Table:
    """Set the error on held-out data before and after the cure in a table."""
    table = Table(
        title="\nError of the predicted torque on data that no fit has seen", box=SIMPLE_HEAD, **LEFT
    )
    for heading in ("joint", "before, N m", "after, N m", "improvement, %", "95 %"):
        table.add_column(heading, justify="right")
    for row in gains:
        ends = row["interval_95"]
        sure = ends is not None and ends[0] > 0.0 and row["improvement_percent"] >= 1.0
        table.add_row(
            str(row["joint"]),
            number(row["rms_residual_before"]),
            number(row["rms_residual_after"]),
            percent(row["improvement_percent"]),
            "" if ends is None else f"{ends[0]:.1f} to {ends[1]:.1f}",
            style="green" if sure else None,
        )
    return table


def remainder(left: Document) -> str:
    """Say what stays unexplained."""
    if not left["joints"]:
        return "Nothing predictable is left: what remains of the torque is noise."
    shares = left["predictable_residual_fraction"]
    told = ", ".join(f"{100.0 * shares[joint - 1]:.0f} % on joint {joint}" for joint in left["joints"])
    return f"Still predictable of what is left, without a known cause: {told}."


def in_words(effect: Document) -> str:
    """Write a hidden effect.

    Examples
    --------
    >>> in_words({"cause": "torque_ripple", "joints": [4], "parameters": {"amplitude": 0.12}})
    'torque ripple on joint 4 (amplitude 0.12)'
    """
    sizes = ", ".join(f"{name.replace('_', ' ')} {value:g}" for name, value in effect["parameters"].items())
    joints = ", ".join(str(joint) for joint in effect["joints"])
    return f"{effect['cause'].replace('_', ' ')} on joint {joints} ({sizes})"


def spoken(rival: Document) -> str:
    """Name a rival and its joints."""
    joints = ", ".join(str(joint) for joint in rival["joints"]) or "all"
    return f"{rival['cause'].replace('_', ' ')} on joint {joints}"
