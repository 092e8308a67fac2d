"""Print a set-up check: conflicts, errors per joint, and what the logs can show."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape

from .columns import Column, print_table
from .tables import number, reading_lines, score_columns
from .warnings import print_warnings

Document = Mapping[str, Any]
_AGREEMENT = {
    "yes": "[green]Robot and logs belong together.[/]",
    "after_correction": "[yellow]Robot and logs belong together once they are corrected as stated above.[/]",
    "doubtful": "[red]It is doubtful whether robot and logs belong together.[/]",
}


def print_check(console: Console, result: Document) -> None:
    """Print warnings, how the logs were read, the verdict, errors, parameters and causes."""
    print_warnings(console, result)
    for line in reading_lines(result):
        console.print(line)
    console.print(_AGREEMENT[result["agreement"]])
    print_table(console, score_columns(result), title="Torque prediction error, % of range and of RMS")
    for line in parameter_lines(result["identifiable"]):
        console.print(escape(line))
    if not result["shown"]:
        console.print("The logs are too short for a diagnosis: which causes they show is not known.")
        return
    title = "Causes that these logs can show"
    print_table(
        console,
        cause_columns(result["shown"]),
        title=title,
        caption="from which size on one is found, on the best joint",
    )
    for pair in result["not_separable"]:
        console.print(escape(pair_line(pair)))


def parameter_lines(rows: Sequence[Document]) -> list[str]:
    """Say how many base parameters these logs determine, and name the others.

    Examples
    --------
    >>> parameter_lines([{"name": "ZZR1", "identifiable": "yes"}, {"name": "MX2", "identifiable": "poorly"}])
    ['Base parameters: 1 of 2 identifiable.', 'Poorly: MX2.']
    """
    named = {
        answer: ", ".join(row["name"] for row in rows if row["identifiable"] == answer)
        for answer in ("poorly", "needs_motion")
    }
    sure = sum(row["identifiable"] == "yes" for row in rows)
    lines = [f"Base parameters: {sure} of {len(rows)} identifiable."]
    lines += [f"Poorly: {named['poorly']}."] if named["poorly"] else []
    return lines + ([f"Only with another motion: {named['needs_motion']}."] if named["needs_motion"] else [])


def cause_columns(causes: Sequence[Document]) -> list[Column]:
    """Give per cause the joints that cannot show it, and the smallest size that would be found."""
    smallest = [_best(cause) for cause in causes]
    return [
        Column("cause", [cause["cause"].replace("_", " ") for cause in causes], is_text=True),
        Column("not on joints", [_hidden(cause) for cause in causes], is_text=True),
        Column("from", [_limit(size) if size else "" for size in smallest]),
        Column("of", [_name(size) if size else "" for size in smallest], is_text=True),
    ]


def _limit(size: Document) -> str:
    rounded = float(number(size["value"], digits=2))
    return f"{'<' * (size['bound'] == 'at_most')}{rounded:g}"


def _name(size: Document) -> str:
    unit = "" if size["unit"] == "1" else f", {size['unit']}"
    return f"{size['name'].replace('_', ' ')}{unit}"


def _hidden(cause: Document) -> str:
    if not cause["visible"]:
        return "all"
    return ", ".join(str(joint) for joint in cause["not_on_joints"])


def _best(cause: Document) -> Document | None:
    """Give the size of the joint on which the smallest effect is found."""
    choose = max if any(size["bound"] == "at_most" for size in cause["smallest"]) else min
    return choose(cause["smallest"], key=lambda size: size["value"], default=None)


def pair_line(pair: Document) -> str:
    """Say why two causes are not distinguished."""
    first, second = (cause.replace("_", " ") for cause in pair["causes"])
    joints = f" (joint {', '.join(map(str, pair['joints']))})" if pair["joints"] else ""
    return f"Not separable: {first} and {second}{joints}: {pair['why']}. Experiment: {pair['experiment']}."
