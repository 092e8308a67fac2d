"""Describe each finding: size, confidence, evidence, improvement, and alternatives."""

from .figures import finding_figure
from .render import Table
from .units import unit_of_effort
from .words import (
    Document,
    band,
    corrected_object,
    interval,
    joints,
    no_break,
    number,
    p_value_text,
    percent,
    quantity,
    share,
    uncertain,
    unit,
)

_RAW = "raw check"
_READ = {
    "likelihood ratio": "Log-likelihood ratio statistic {}",
    "log10 p": "log10 of the p-value, corrected for all candidates: {}",
    "log10 p between blocks": "log10 of the p-value by the scatter between parts of the log: {} (the finding "
    "is doubtful where p exceeds 0.001)",
    "criterion difference": "Best alternative: ΔBIC {} (below 6: undecided)",
    "lead over unnamed patterns": "Best unnamed pattern: ΔBIC {} (below 0: undecided)",
    _RAW: "The raw samples show it before any model is fitted; test statistic {}",
}
_READ_WITHOUT_VALUE = {
    "log10 p": "The p-value is below the smallest representable number",
    "criterion difference": "No alternative cause is applicable",
}


def findings(document: Document) -> list[dict[str, object]]:
    """Describe all findings in the order of the document."""
    repairs = document["diagnosis"].get("repairs", ())
    return [
        _finding_view(finding, repairs[index : index + 1], document)
        for index, finding in enumerate(document["diagnosis"]["findings"])
    ]


def _finding_view(finding: Document, repairs: list[Document], document: Document) -> dict[str, object]:
    curve = finding.get("curve")
    correction = "".join(f" Correction: {repair['what']}." for repair in repairs)
    return {
        "title": f"{finding['title']}, {joints(finding['joints'])}",
        "statement": no_break(f"{finding['statement']}.{correction}"),
        "key_figures": _key_figures(finding, band(document)),
        "figure": finding_figure(curve, unit_of_effort(document, curve["joint"])) if curve else None,
        "parameters": _parameters(finding),
        "evidence": [
            *(_sentence(evidence) for evidence in finding["evidence"]),
            f"Object of the correction: {corrected_object(finding['cure'])}.",
        ],
        "undecided": finding["ambiguous_with"],
        "rejected": finding["refuted"],
        "is_raw": any(evidence["statistic"] == _RAW for evidence in finding["evidence"]),
    }


def _key_figures(finding: Document, band: str) -> list[tuple[str, str]]:
    gain = finding.get("gain")
    improvement = gain and (
        percent(gain.get("improvement_total_percent")),
        f"reduction of the error on held-out data, {band} (95 %: {interval(gain['interval_95'])})",
    )
    return [
        (share(finding["confidence"]), "confidence in this cause"),
        *([improvement] if improvement else []),
        (share(finding["explained_residual_fraction"]), "of the mean-square residual explained"),
        (p_value_text(finding["p_value"]), "p-value, corrected for all candidates"),
    ]


def _parameters(finding: Document) -> Table:
    rows = [
        (
            quantity(parameter["name"]),
            uncertain(parameter["value"], parameter["standard_deviation"]),
            percent(parameter.get("relative_deviation_percent")),
            unit(parameter["unit"]),
        )
        for parameter in finding["parameters"]
    ]
    headings = ("parameter", "value ± standard deviation", "%P", "unit")
    note = "%P: standard deviation in percent of the value."
    return Table("Parameters of the finding", headings, rows, note)


def _sentence(evidence: Document) -> str:
    value, statistic = evidence["value"], evidence["statistic"]
    if value is None:
        return f"{_READ_WITHOUT_VALUE.get(statistic, evidence['statement'])}."
    if statistic in _READ:
        return f"{_READ[statistic].format(number(value))}."
    return f"{evidence['statement']}: {number(value)} ({statistic})."
