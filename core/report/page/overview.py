"""Say in a few sentences what a diagnosis came to: what is wrong, how large it is, what its cure gains."""

from collections.abc import Sequence

from .markup import Html, tag
from .words import (
    Document,
    count,
    fit_band,
    interval,
    is_real,
    joints,
    lower,
    percent,
    reference,
    series,
    share,
    unbroken,
)


def headline(document: Document) -> str:
    """Give the verdict as a sentence or two."""
    diagnosis, left = document["diagnosis"], document["diagnosis"]["unexplained"]["joints"]
    if not diagnosis["findings"]:
        return _nothing(document) if diagnosis["verdict"] == "nothing_found" else _unnamed(document)
    sentence = f"{_subject(document)}: {_titles(diagnosis['findings'])}."
    if diagnosis["verdict"] == "unexplained" and left:
        sentence += f" Part of what is left on {joints(left)} has no known cause."
    return sentence


def _nothing(document: Document) -> str:
    name, other = document["robot"]["name"], reference(document)
    if other:
        return f"{name} differs from {other} in nothing that this log can show."
    return f"Nothing that this log can show is wrong with the simulation of {name}."


def _unnamed(document: Document) -> str:
    name, other = document["robot"]["name"], reference(document)
    left = joints(document["diagnosis"]["unexplained"]["joints"])
    who = f"What {name} does differently from {other}" if other else f"The simulation of {name}"
    return f"{who} leaves structure in the torque of {left}, and no known cause explains it."


def _subject(document: Document) -> str:
    name, other = document["robot"]["name"], reference(document)
    size = len(_where_by_title(document["diagnosis"]["findings"]))
    what = f"{count(size)} thing{'s' if size > 1 else ''}"
    return (
        f"{name} differs from {other} in {what}" if other else f"The simulation of {name} gets {what} wrong"
    )


def _titles(found: Sequence[Document]) -> str:
    unsure = {one["title"] for one in found if one["ambiguous_with"]}
    return series(
        [
            f"{lower(title)}{', or a cause like it' * (title in unsure)} ({joints(places)})"
            for title, places in _where_by_title(found).items()
        ]
    )


def at_a_glance(document: Document) -> Html | None:
    """List findings with their sizes before each is told at length, and what else they may be."""
    found = document["diagnosis"]["findings"]
    if len(found) < 2 and not any(one["ambiguous_with"] for one in found):
        return None
    return tag("ol", *(tag("li", unbroken(_in_a_line(one))) for one in found))


def _in_a_line(finding: Document) -> str:
    line = f"{finding['statement']} ({share(finding['confidence'])} sure)."
    rivals = _where_by_title(finding["ambiguous_with"])
    if not rivals:
        return line
    others = " or ".join(f"{lower(title)} ({joints(places)})" for title, places in rivals.items())
    return f"{line} It may as well be {others}; this log cannot tell."


def _where_by_title(found: Sequence[Document]) -> dict[str, list[int]]:
    """List the joints of every cause, so that one which acts on three joints is one thing, not three."""
    where: dict[str, set[int]] = {}
    for one in found:
        where.setdefault(one["title"], set()).update(one["joints"])
    return {title: sorted(places) for title, places in where.items()}


def gained(document: Document) -> str | None:
    """Say what the cure gained on unseen data, joint by joint."""
    diagnosis = document["diagnosis"]
    helped = [
        one for one in diagnosis.get("gain") or [] if is_real(one["improvement_percent"], one["interval_95"])
    ]
    if not helped:
        return _nothing_sure(document) if diagnosis.get("gain") else None
    parts = [
        f"by {percent(one['improvement_percent'])} on joint {one['joint']} "
        f"(95 %: {interval(one['interval_95'])})"
        for one in helped
    ]
    torque = (
        f"With the cure in the model, the torque error on data that no fit has seen falls {series(parts)}."
    )
    return torque + _moved_better(diagnosis.get("simulation") or {})


def _nothing_sure(document: Document) -> str:
    moved = _moved_better(document["diagnosis"].get("simulation") or {})
    return (
        f"In the band that the model is fitted in ({fit_band(document)}), the cure gains nothing sure on "
        f"data that no fit has seen.{moved}"
    )


def _moved_better(simulation: Document) -> str:
    gains = simulation.get("improvement_total_percent") or []
    ends = simulation.get("interval_95") or [None] * len(gains)
    parts = [
        f"{percent(gain)} less on joint {joint}"
        for joint, (gain, own) in enumerate(zip(gains, ends, strict=True), start=1)
        if is_real(gain, own)
    ]
    return f" The simulated motion strays {series(parts)}." if parts else ""
