"""Say in a sentence what a diagnosis came to, and show all joints before and after, in torque and motion."""

from collections.abc import Sequence

from core.report.page.figures import joint_bars
from core.report.page.markup import Html, section, table, tag
from core.report.page.words import (
    Document,
    count,
    fit_band,
    interval,
    joints,
    lower,
    number,
    percent,
    series,
    share,
    unbroken,
    unit_of_effort,
)

_REAL = 1.0
"""Improvements below one percent are not worth a word in the headline."""


def headline(document: Document) -> str:
    """Give the verdict as a sentence or two."""
    diagnosis, name = document["diagnosis"], document["robot"]["name"]
    found, left = diagnosis["findings"], diagnosis["unexplained"]["joints"]
    if not found:
        if diagnosis["verdict"] == "nothing_found":
            return f"Nothing that this log can show is wrong with the simulation of {name}."
        return (
            f"The simulation of {name} leaves structure in the torque of {joints(left)}, and no known cause "
            "explains it."
        )
    where = _where_by_title(found)
    titles = series([f"{lower(title)} ({joints(places)})" for title, places in where.items()])
    what = f"{count(len(where))} thing{'s' if len(where) > 1 else ''}"
    sentence = f"The simulation of {name} gets {what} wrong: {titles}."
    if diagnosis["verdict"] == "unexplained" and left:
        sentence += f" Part of what is left on {joints(left)} has no known cause."
    return sentence + "".join(_in_its_place(one) for one in found if one["ambiguous_with"])


def _in_its_place(finding: Document) -> str:
    """Say what a finding could be instead, because a name that is not sure must not stand alone."""
    rivals = _where_by_title(finding["ambiguous_with"])
    others = " or ".join(f"{lower(title)} ({joints(places)})" for title, places in rivals.items())
    return f" Instead of {lower(finding['title'])} it may be: {others}; this log cannot tell."


def at_a_glance(document: Document) -> Html | None:
    """List several findings with their sizes, before each is told at length."""
    found = document["diagnosis"]["findings"]
    if len(found) < 2:
        return None
    lines = (unbroken(f"{one['statement']} ({share(one['confidence'])} sure).") for one in found)
    return tag("ol", *(tag("li", line) for line in lines))


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
        one for one in diagnosis.get("gain") or [] if _real(one["improvement_percent"], one["interval_95"])
    ]
    if not helped:
        return None
    parts = [
        f"by {percent(one['improvement_percent'])} on joint {one['joint']} "
        f"(95 %: {interval(one['interval_95'])})"
        for one in helped
    ]
    torque = (
        f"With the cure in the model, the torque error on data that no fit has seen falls {series(parts)}."
    )
    return torque + _moved_better(diagnosis.get("simulation") or {})


def _moved_better(simulation: Document) -> str:
    gains = simulation.get("improvement_total_percent") or []
    ends = simulation.get("interval_95") or [None] * len(gains)
    parts = [
        f"{percent(gain)} less on joint {joint}"
        for joint, (gain, own) in enumerate(zip(gains, ends, strict=True), start=1)
        if _real(gain, own)
    ]
    return f" The simulated motion strays {series(parts)}." if parts else ""


def _real(gain: float | None, ends: Sequence[float] | None) -> bool:
    return gain is not None and gain > _REAL and ends is not None and ends[0] > 0.0


def joints_section(document: Document) -> Html | None:
    """Tabulate every joint before and after on held-out data, in torque and in simulated motion."""
    diagnosis = document["diagnosis"]
    old, new = (_by_joint(diagnosis[side].get("validation") or []) for side in ("before", "after"))
    if not old:
        return None
    measured = {one["joint"]: one for one in diagnosis.get("gain") or []}
    causes = [_causes_on(document, joint) for joint in old]
    sides = [(row, new.get(joint)) for joint, row in old.items()]
    rows = [
        [*_row(document, joint, side, measured.get(joint)), cause]
        for joint, side, cause in zip(old, sides, causes, strict=True)
    ]
    caption = "Error of the predicted torque on data that no fit has seen"
    errors = ("torque RMS", "error before", "after", "before, % of RMS", "after")
    headings = ("joint", *errors, "improvement", "95 %", "what was found on it")
    note = f"{_TORQUE_NOTE} Torque and error {fit_band(document)}, the band that the model is fitted in."
    parts: list[object] = [table(caption, headings, rows, note=note, text=(8,))]
    if new:
        parts.insert(0, _bars(old, new))
    return section("Joint by joint, in torque and in motion", *parts, _motion_table(document))


_TORQUE_NOTE = (
    "RMS in N m (N where a joint slides). The interval comes from drawing whole blocks of time anew; an "
    "interval that holds zero means no difference on that joint that is sure."
)


def _causes_on(document: Document, joint: int) -> str:
    titles = (one["title"] for one in document["diagnosis"]["findings"] if joint in one["joints"])
    return "; ".join(dict.fromkeys(titles))


def _row(
    document: Document, joint: int, sides: tuple[Document, Document | None], gain: Document | None
) -> list[object]:
    old, new = sides
    return [
        str(joint),
        f"{number(old['rms_torque'])} {unit_of_effort(document, joint)}",
        number(old["rms_residual"]),
        number(new["rms_residual"]) if new else "",
        percent(old["nrmse_of_rms_percent"]),
        percent(new["nrmse_of_rms_percent"]) if new else "",
        _improvement(gain["improvement_percent"], gain["interval_95"]) if gain else "",
        interval(gain["interval_95"]) if gain else "",
    ]


def _bars(old: dict[int, Document], new: dict[int, Document]) -> Html:
    before, after = (
        [float(row["nrmse_of_rms_percent"] or 0.0) for row in side.values()] for side in (old, new)
    )
    return joint_bars(
        "Error per joint", before, after, "Error of the predicted torque, % of the torque's RMS, unseen data"
    )


def _motion_table(document: Document) -> Html | None:
    simulation = document["diagnosis"].get("simulation") or {}
    old, new = simulation.get("before") or {}, simulation.get("after") or {}
    if not old:
        told = simulation.get("note")
        return (
            tag("p", f"The motion of both models was not compared: {told}.", class_="note") if told else None
        )
    horizons, number_of_joints = old["horizons_s"], len(old["position_rms"][0])
    ends = simulation.get("interval_95") or [None] * number_of_joints
    headings = [
        "joint",
        *(f"{side} {1000.0 * one:.0f} ms" for one in horizons for side in ("before,", "after,")),
    ]
    rows = [
        [
            f"{joint + 1}",
            *(
                f"{number(1000.0 * side['position_rms'][place][joint])}"
                for place in range(len(horizons))
                for side in (old, new)
            ),
            _improvement(simulation["improvement_total_percent"][joint], ends[joint]),
            interval(ends[joint]),
        ]
        for joint in range(number_of_joints)
    ]
    note = (
        f"From {old['windows']} measured states in unseen data, both models were driven by the measured "
        "torque; the error is how far the simulated robot had strayed from the measured one. RMS in mrad (mm "
        "where a joint slides)."
    )
    return table("Error of the simulated motion", (*headings, "improvement", "95 %"), rows, note=note)


def _improvement(value: float | None, ends: Sequence[float] | None) -> Html:
    sure = ends is not None and None not in ends and ends[0] * ends[1] > 0.0
    if value is None or not sure or abs(value) < _REAL:
        return tag("span", percent(value))
    return tag("span", percent(value), class_="better" if value > 0.0 else "worse")


def _by_joint(rows: Sequence[Document]) -> dict[int, Document]:
    return {int(row["joint"]): row for row in rows}
