"""Say what robot and logs disagree in: headings, sentences, and the correction to paste."""

import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from .words import Document, number, series, share


class Disagreement(NamedTuple):
    """Hold the conflicts that one correction removes."""

    conflicts: Sequence[tuple[str, Sequence[str]]]
    """Heading and sentences of each."""
    applied: str
    """Whether the results are those of the corrected set-up, as a sentence."""
    correction: str
    """The correction as JSON; empty where nothing can be pasted."""


def disagreements(document: Document) -> list[Disagreement]:
    """Group the conflicts of a result by their correction; empty where robot and logs agree."""
    groups: dict[str, list[Document]] = {}
    for conflict in document.get("conflicts") or []:
        groups.setdefault(_correction(conflict["correction"]), []).append(conflict)
    return [
        Disagreement(
            [(_heading(conflict), _sentences(conflict)) for conflict in conflicts],
            "All results below are computed with this correction."
            if all(conflict["applied"] for conflict in conflicts)
            else "The results below are computed without this correction.",
            correction,
        )
        for correction, conflicts in groups.items()
    ]


def other_warnings(document: Document) -> list[str]:
    """Give the warnings without those of conflicts, which come first among them."""
    return list(document.get("doubts") or [])[len(document.get("conflicts") or []) :]


def _heading(conflict: Document) -> str:
    before, after = conflict["error_before_percent"], conflict["error_after_percent"]
    fall = "" if before is None or after >= before else f", error {number(before)} → {number(after)} %"
    return f"Robot and log disagree: {conflict['remedy']}{fall}"


def _sentences(conflict: Document) -> list[str]:
    statement = str(conflict["statement"])
    said = f"{statement[:1].upper()}{statement[1:]}. Confidence {share(conflict['confidence'])}."
    others = [_alternative(other) for other in conflict["ambiguous_with"]]
    return [said, *([f"Not distinguishable from: {series(others)}."] if others else [])]


def _alternative(other: Document) -> str:
    numbers = ", ".join(str(joint) for joint in other["joints"])
    return f"{other['conflict'].replace('_', ' ')}{f' of joint {numbers}' * bool(numbers)} ({other['why']})"


def _correction(correction: Mapping[str, Any]) -> str:
    """Write a correction as JSON, a line per channel or joint; empty parts are nothing to paste."""
    held = {name: part for name, part in correction.items() if part}
    return _lines(held, 2) if held else ""


def _lines(value: object, levels: int, indent: str = "") -> str:
    if levels == 0 or not isinstance(value, dict | list) or not value:
        return json.dumps(value)
    inner = indent + "  "
    items = (
        [f"{inner}{json.dumps(key)}: {_lines(item, levels - 1, inner)}" for key, item in value.items()]
        if isinstance(value, dict)
        else [f"{inner}{_lines(item, levels - 1, inner)}" for item in value]
    )
    begin, end = "{}" if isinstance(value, dict) else "[]"
    return "\n".join([begin, ",\n".join(items), indent + end])
