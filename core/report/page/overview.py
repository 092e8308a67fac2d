"""Summarise a diagnosis: findings, their sizes, and the improvement by the correction."""

from collections.abc import Sequence

from .robot import joints_predicted
from .words import (
    Document,
    count,
    fit_band,
    interval,
    is_significant,
    joints,
    lower,
    no_break,
    percent,
    reference,
    series,
    share,
)

EVEN = 0.5
"""A cause of no more confidence than this is possible, and not found."""


def headline(document: Document) -> str:
    """Give the result in one or two sentences; what the model does not predict at all comes last."""
    after = document["diagnosis"]["after"].get("validation") or []
    failed = joints_predicted({"validation": after} if after else document).get("failed")
    rest = (
        f" The model does not predict {joints(failed)}: more than half of the torque is left."
        if failed
        else ""
    )
    return _verdict(document) + rest


def _verdict(document: Document) -> str:
    diagnosis, left = document["diagnosis"], document["diagnosis"]["unexplained"]["joints"]
    name, other = document["robot"]["name"], reference(document)
    if diagnosis["findings"]:
        sentence = f"{_found(document)}."
        unexplained = diagnosis["verdict"] == "unexplained" and left
        return sentence + (
            f" Part of the residual on {joints(left)} has no known cause." if unexplained else ""
        )
    if diagnosis["verdict"] == "nothing_found":
        return f"No difference found between {name} and {other}." if other else f"No {_subject(document)}."
    what = (
        f"Unexplained difference between {name} and {other}" if other else f"Unexplained residual of {name}"
    )
    return f"{what} in the torque of {joints(left)}: no known cause explains it."


def _found(document: Document) -> str:
    """Name the causes that are more likely than not, then those that are only possible."""
    findings = document["diagnosis"]["findings"]
    likely = [finding for finding in findings if finding["confidence"] > EVEN]
    possible = [finding for finding in findings if finding["confidence"] <= EVEN]
    others = f"; possible: {_titles(possible)}" if possible else ""
    if not likely:
        return f"No {_subject(document)} with more than {share(EVEN)} confidence{others}"
    size = len(_joints_by_title(likely))
    subject = _subject(document, plural="s" * (size > 1))
    return f"{count(size).capitalize()} {subject}: {_titles(likely)}{others}"


def _subject(document: Document, plural: str = "") -> str:
    name, other = document["robot"]["name"], reference(document)
    if other:
        return f"difference{plural} between {name} and {other}"
    return f"cause{plural} of simulation error found for {name}"


def _titles(findings: Sequence[Document]) -> str:
    unsure = {finding["title"] for finding in findings if finding["ambiguous_with"]}
    return series(
        [
            f"{lower(title)}{', or a similar cause' * (title in unsure)} ({joints(numbers)})"
            for title, numbers in _joints_by_title(findings).items()
        ]
    )


def overview_lines(document: Document) -> list[str]:
    """List findings with size, confidence and alternatives; empty for a single unambiguous one."""
    findings = document["diagnosis"]["findings"]
    if len(findings) < 2 and not any(finding["ambiguous_with"] for finding in findings):
        return []
    return [no_break(_line(finding)) for finding in findings]


def _line(finding: Document) -> str:
    line = f"{finding['statement']} (confidence {share(finding['confidence'])})."
    alternatives = _joints_by_title(finding["ambiguous_with"])
    if not alternatives:
        return line
    others = " or ".join(f"{lower(title)} ({joints(numbers)})" for title, numbers in alternatives.items())
    return f"{line} Not distinguishable in this log from: {others}."


def _joints_by_title(causes: Sequence[Document]) -> dict[str, list[int]]:
    """List the joints of every cause, so that a cause on three joints counts once."""
    listed: dict[str, set[int]] = {}
    for cause in causes:
        listed.setdefault(cause["title"], set()).update(cause["joints"])
    return {title: sorted(numbers) for title, numbers in listed.items()}


def improvement(document: Document) -> str:
    """Give the significant improvements by the correction on held-out data; empty without a correction."""
    diagnosis = document["diagnosis"]
    gains = diagnosis.get("gain") or []
    parts = [
        f"by {percent(gain['improvement_percent'])} on joint {gain['joint']} "
        f"(95 %: {interval(gain['interval_95'])})"
        for gain in gains
        if is_significant(gain["improvement_percent"], gain["interval_95"])
    ]
    motion = _motion_improvement(diagnosis.get("simulation") or {})
    if parts:
        return f"The correction reduces the torque error on held-out data {series(parts)}.{motion}"
    if not gains:
        return ""
    return (
        f"Within the bandwidth of the fit ({fit_band(document)}), the correction gives no significant "
        f"improvement on held-out data.{motion}"
    )


def _motion_improvement(simulation: Document) -> str:
    gains = simulation.get("improvement_total_percent") or []
    intervals = simulation.get("interval_95") or [None] * len(gains)
    parts = [
        f"{percent(gain)} smaller on joint {joint}"
        for joint, (gain, ends) in enumerate(zip(gains, intervals, strict=True), start=1)
        if is_significant(gain, ends)
    ]
    return f" The simulated position error is {series(parts)}." if parts else ""
