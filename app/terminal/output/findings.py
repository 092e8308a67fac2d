"""Print a diagnosis in plain words: what the simulation gets wrong, why, what the cure gains, what is left.

The full story with its figures is in the report; this is what a reader sees first.
"""

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.padding import Padding

from .columns import Column, print_table
from .tables import effort_column, percent

Document = Mapping[str, Any]


def print_diagnosis(console: Console, result: Document) -> None:
    """Print findings, gains and what is left."""
    diagnosis = result["diagnosis"]
    findings, band = diagnosis["findings"], diagnosis["band_hz"]
    console.print(f"\n[bold]{escape(headline(result))}[/]")
    for place, finding in enumerate(findings, start=1):
        console.print(f"\n[bold]{place}. {escape(finding['statement'])}.[/]")
        for line in reasons(finding, band):
            console.print(Padding(escape(line), (0, 0, 0, 3)))
    if diagnosis["gain"]:
        title = "Error on data that no fit has seen, without and with the cure in the model"
        console.print()
        print_table(
            console,
            gain_columns(result),
            title=title,
            caption=where_judged(result),
            styles=["green" if is_sure(row) else "" for row in diagnosis["gain"]],
        )
    console.print(remainder(diagnosis["unexplained"]))


def headline(result: Document) -> str:
    """Say in a sentence what came out."""
    found, name = len({one["cause"] for one in result["diagnosis"]["findings"]}), result["robot"]["name"]
    if not found:
        return f"Nothing that this log can show is wrong with the simulation of {name}."
    return f"The simulation of {name} gets {found} thing{'s' if found > 1 else ''} wrong."


def reasons(finding: Document, band_hz: float) -> list[str]:
    """Say how sure a finding is, what it gains, and how its rivals stood."""
    sure, luck = 100.0 * finding["confidence"], chance(finding["p_value"])
    lines = [f"Confidence {sure:.0f} %. The chance that luck leaves so clear a trace is {luck}."]
    gain = finding["gain"]
    if gain is not None and gain["interval_95"] is not None:
        share, (low, high) = gain["improvement_total_percent"], gain["interval_95"]
        joints = "the joint" if len(finding["joints"]) == 1 else "these joints"
        lines.append(
            f"By itself it takes {share:.0f} % ({low:.0f} to {high:.0f} %) of the error on {joints} away, up "
            f"to {band_hz:.0f} Hz, on data that no fit has seen."
        )
    undecided, refuted = finding["ambiguous_with"], finding["refuted"]
    lines += [
        f"Not told apart from {spoken(rival)}; this would separate them: {rival['separating_experiment']}."
        for rival in undecided
    ]
    lines += [f"Refuted: {spoken(rival)}: {rival['why']}." for rival in refuted]
    return lines if undecided or refuted else [*lines, "No other known cause explains nearly as much."]


def chance(p_value: float) -> str:
    """Write a p-value; what is smaller than a number can hold is called so.

    Examples
    --------
    >>> chance(2.3e-9), chance(0.0)
    ('2e-09', 'below 1e-300')
    """
    return f"{p_value:.0e}" if p_value > 1e-300 else "below 1e-300"


def gain_columns(result: Document) -> list[Column]:
    """Give the error on held-out data before and after the cure, in torque and in motion."""
    diagnosis = result["diagnosis"]
    rows, moved = diagnosis["gain"], diagnosis["simulation"].get("improvement_total_percent") or []
    ends = [row["interval_95"] for row in rows]
    return [
        Column("joint", [str(row["joint"]) for row in rows]),
        effort_column(result, "before", rows, "rms_residual_before", spare=2),
        effort_column(result, "after", rows, "rms_residual_after", spare=1),
        Column("less torque error, %", [percent(row["improvement_percent"]) for row in rows]),
        Column("95 %", ["" if one is None else f"{one[0]:.1f} to {one[1]:.1f}" for one in ends], spare=3),
        Column("less motion error, %", [percent(moved[row["joint"] - 1]) if moved else "" for row in rows]),
    ]


def is_sure(row: Document) -> bool:
    """Tell a gain that is more than luck, and worth naming."""
    ends = row["interval_95"]
    return ends is not None and ends[0] > 0.0 and row["improvement_percent"] >= 1.0


def where_judged(result: Document) -> str:
    """Say what the columns of the table are measured on."""
    bands = ", ".join(f"{log['filter']['cutoff_hz']:.1f}" for log in result["logs"])
    simulated = result["diagnosis"]["simulation"]
    if not simulated["before"]:
        return f"torque up to {bands} Hz; motion was not compared: {simulated['note']}"
    times = ", ".join(f"{1000.0 * one:.0f}" for one in simulated["before"]["horizons_s"])
    return f"torque up to {bands} Hz; simulated motion over {times} ms"


def remainder(left: Document) -> str:
    """Say what stays unexplained."""
    if not left["joints"]:
        return "Nothing predictable is left: what remains of the torque is noise."
    if left["pattern"]:
        return f"{left['pattern']['statement']}, and no listed cause explains it."
    shares = left["predictable_residual_fraction"]
    told = ", ".join(f"{100.0 * shares[joint - 1]:.0f} % on joint {joint}" for joint in left["joints"])
    return f"Still predictable of what is left, without a known cause: {told}."


def spoken(effect: Document) -> str:
    """Name a cause and its joints.

    Examples
    --------
    >>> spoken({"cause": "torque_ripple", "joints": [4]})
    'torque ripple on joint 4'
    """
    joints = ", ".join(str(joint) for joint in effect["joints"]) or "all"
    return f"{effect['cause'].replace('_', ' ')} on joint {joints}"
