"""Print a diagnosis: findings with evidence, improvement by the correction, and the unexplained residual.

The report holds the details and figures.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.padding import Padding

from ....core.report.page.overview import headline
from ....core.report.page.words import is_significant
from .columns import Column, print_table
from .tables import effort_column, percent
from .warnings import print_warnings

Document = Mapping[str, Any]


def print_diagnosis(console: Console, result: Document) -> None:
    """Print warnings, findings, improvements and the unexplained residual."""
    diagnosis = result["diagnosis"]
    findings, band = diagnosis["findings"], diagnosis["band_hz"]
    print_warnings(console, result)
    console.print(f"\n[bold]{escape(headline(result))}[/]")
    for number, finding in enumerate(findings, start=1):
        console.print(f"\n[bold]{number}. {escape(finding['statement'])}.[/]")
        for line in reasons(finding, band):
            console.print(Padding(escape(line), (0, 0, 0, 3), expand=False))
    if diagnosis["gain"]:
        title = "Error on held-out data, before and after the correction"
        console.print()
        print_table(
            console,
            gain_columns(result),
            title=title,
            caption=evaluation_note(result),
            styles=[
                "green" if is_significant(row["improvement_percent"], row["interval_95"]) else ""
                for row in diagnosis["gain"]
            ],
        )
    console.print(remainder(diagnosis["unexplained"]))
    if result.get("model"):
        console.print(f"Parameters and files: {escape(result['model']['statement'])}.")


def reasons(finding: Document, band_hz: float) -> list[str]:
    """List confidence, p-value, improvement and alternatives of a finding."""
    sure, p_value = 100.0 * finding["confidence"], p_value_text(finding["p_value"])
    lines = [f"Confidence {sure:.0f} %, {p_value}, corrected for all candidates."]
    gain = finding["gain"]
    if gain is not None and gain["interval_95"] is not None:
        share, (low, high) = gain["improvement_total_percent"], gain["interval_95"]
        joints = "the joint" if len(finding["joints"]) == 1 else "these joints"
        lines.append(
            f"Its correction alone reduces the error on {joints} by {share:.0f} % "
            f"(95 %: {low:.0f} to {high:.0f} %), up to {band_hz:.0f} Hz, on held-out data."
        )
    undecided, refuted = finding["ambiguous_with"], finding["refuted"]
    lines += [
        f"Not distinguishable from {cause_on_joints(alternative)}; "
        f"separating experiment: {alternative['separating_experiment']}."
        for alternative in undecided
    ]
    lines += [f"Rejected: {cause_on_joints(alternative)}: {alternative['why']}." for alternative in refuted]
    return lines if undecided or refuted else [*lines, "No other known cause explains a comparable part."]


def p_value_text(p_value: float) -> str:
    """Write a p-value, bounded below by 1e-300.

    Examples
    --------
    >>> p_value_text(2.3e-9), p_value_text(0.0)
    ('p = 2e-09', 'p < 1e-300')
    """
    return f"p = {p_value:.0e}" if p_value > 1e-300 else "p < 1e-300"


def gain_columns(result: Document) -> list[Column]:
    """Give torque and motion errors on held-out data before and after the correction."""
    diagnosis = result["diagnosis"]
    rows, moved = diagnosis["gain"], diagnosis["simulation"].get("improvement_total_percent") or []
    ends = [_range(row["interval_95"]) for row in rows]
    return [
        Column("joint", [str(row["joint"]) for row in rows]),
        effort_column(result, "before", rows, "rms_residual_before", spare=2),
        effort_column(result, "after", rows, "rms_residual_after", spare=1),
        Column("torque improvement, %", [percent(row["improvement_percent"]) for row in rows]),
        Column("95 %", ends, spare=3),
        Column("motion improvement, %", [percent(moved[row["joint"] - 1]) if moved else "" for row in rows]),
    ]


def _range(ends: Sequence[float] | None) -> str:
    return "" if ends is None else f"{ends[0]:.1f} to {ends[1]:.1f}"


def evaluation_note(result: Document) -> str:
    """Describe bandwidth and horizons of the table."""
    bands = ", ".join(f"{log['filter']['cutoff_hz']:.1f}" for log in result["logs"])
    simulated = result["diagnosis"]["simulation"]
    if not simulated["before"]:
        return f"torque up to {bands} Hz; motion not compared: {simulated['note']}"
    times = ", ".join(f"{1000.0 * horizon:.0f}" for horizon in simulated["before"]["horizons_s"])
    return f"torque up to {bands} Hz; simulated motion over {times} ms"


def remainder(left: Document) -> str:
    """Describe the unexplained residual."""
    if not left["joints"]:
        return "The remaining residual is not predictable: it is noise."
    if left["pattern"]:
        return f"{left['pattern']['statement']}; no known cause explains it."
    shares = left["predictable_residual_fraction"]
    listed = ", ".join(f"{100.0 * shares[joint - 1]:.0f} % on joint {joint}" for joint in left["joints"])
    return f"Explainable variance of the residual (R2, upper bound), without a known cause: {listed}."


def cause_on_joints(effect: Document) -> str:
    """Name a cause and its joints.

    Examples
    --------
    >>> cause_on_joints({"cause": "torque_ripple", "joints": [4]})
    'torque ripple on joint 4'
    """
    joints = ", ".join(str(joint) for joint in effect["joints"]) or "all"
    return f"{effect['cause'].replace('_', ' ')} on joint {joints}"
