"""Tell each finding: what is wrong, how large, how sure, what it gains, and its rivals."""

from collections.abc import Sequence

from .figures import finding_figure
from .markup import Html, listing, section, table, tag, together
from .units import unit_of_effort
from .words import (
    Document,
    band,
    chance,
    cure,
    interval,
    joints,
    number,
    percent,
    quantity,
    share,
    unbroken,
    uncertain,
    unit,
)

_RAW = "raw check"
_NOT_CURED = (
    "Nothing joins the model for it, so that there is no gain to measure: it has to be mended where the log "
    "is recorded."
)
_READ = {
    "likelihood ratio": "With it in the model the log is more likely: twice the log-likelihood rises by {}",
    "log10 p": "Luck leaves so clear a trace with a chance of ten to the power of {}, all trials counted in",
    "criterion difference": "The best rival in its place falls behind by {}; less than 6 would tell nothing",
    "lead over the nameless": "The best pattern without a name falls behind by {}; less than 0 leaves doubt",
    _RAW: "The raw samples show it before any model is fitted; the check's statistic is {}",
}
_READ_WITHOUT_VALUE = {
    "log10 p": "Luck leaves so clear a trace with a chance smaller than can be computed",
    "criterion difference": "No rival can take its place",
}


def findings_section(document: Document) -> Html | None:
    """Write all findings, the surest first as the document has them."""
    found = document["diagnosis"]["findings"]
    if not found:
        return None
    cards = [_card(place, one, document) for place, one in enumerate(found, start=1)]
    return section("What is wrong, and why", *cards)


def _card(place: int, finding: Document, document: Document) -> Html:
    curve = finding.get("curve")
    return tag(
        "article",
        tag("h3", f"{place}. {finding['title']}, {joints(finding['joints'])}"),
        tag("p", unbroken(f"{finding['statement']}. {_repair(place, document)}"), class_="statement"),
        _key_figures(finding, band(document)),
        finding_figure(curve, unit_of_effort(document, curve["joint"])) if curve else None,
        _parameters(finding),
        tag("h4", "Why this cause"),
        listing(_reasons(finding)),
        _undecided(finding["ambiguous_with"]),
        tag("p", _NOT_CURED, class_="note") if _is_raw(finding) else _refuted(finding["refuted"]),
        class_="finding",
    )


def _repair(place: int, document: Document) -> str:
    """Say what mends a finding, where the document tells it."""
    listed = document["diagnosis"].get("repairs", ())[place - 1 : place]
    return "".join(f"Repair: {one['what']}." for one in listed)


def _is_raw(finding: Document) -> bool:
    return any(one["statistic"] == _RAW for one in finding["evidence"])


def _key_figures(finding: Document, band: str) -> Html:
    gain = finding.get("gain")
    told = [(share(finding["confidence"]), "confidence that this is the cause")]
    if gain:
        told += [
            (
                percent(gain.get("improvement_total_percent")),
                f"smaller error on data that no fit has seen, {band} (95 %: {interval(gain['interval_95'])})",
            )
        ]
    told += [
        (share(finding["explained_residual_fraction"]), "of the residual's mean square explained"),
        (chance(finding["p_value"]), "chance that luck leaves so clear a trace somewhere"),
    ]
    return tag("div", *(tag("div", tag("b", big), tag("span", small)) for big, small in told), class_="key")


def _parameters(finding: Document) -> Html | None:
    rows = [
        (
            quantity(one["name"]),
            uncertain(one["value"], one["standard_deviation"]),
            percent(one.get("relative_deviation_percent")),
            tag("span", unit(one["unit"])),
        )
        for one in finding["parameters"]
    ]
    if not rows:
        return None
    headings = ("", "value ± standard deviation", "%P", "unit")
    return table(
        "How large it is", headings, rows, note="%P: the standard deviation in percent of the value."
    )


def _reasons(finding: Document) -> list[str]:
    cured = f"What has to be mended: {cure(finding['cure'])}."
    return [*(_reason(one) for one in finding["evidence"]), cured]


def _reason(evidence: Document) -> str:
    value, statistic = evidence["value"], evidence["statistic"]
    if value is None:
        return f"{_READ_WITHOUT_VALUE.get(statistic, evidence['statement'])}."
    if statistic in _READ:
        return f"{_READ[statistic].format(number(value))}."
    return f"{evidence['statement']}: {number(value)} ({statistic})."


def _undecided(rivals: Sequence[Document]) -> Html | None:
    if not rivals:
        return None
    items = [
        together(
            [
                tag("b", f"{one['title']}, {joints(one['joints'])}"),
                f": {one['why']}. ",
                tag("i", "Experiment that separates the two: "),
                f"{one['separating_experiment']}.",
            ]
        )
        for one in rivals
    ]
    return together([tag("h4", "This log cannot tell it apart from"), listing(items)])


def _refuted(rivals: Sequence[Document]) -> Html | None:
    if not rivals:
        return tag("p", "No other cause comes near to explaining the same trace.", class_="note")
    items = [f"{one['title']}, {joints(one['joints'])}: {one['why']}." for one in rivals]
    return together([tag("h4", "Refuted"), listing(items)])
