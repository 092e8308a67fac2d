"""Write a comparison of estimators as tables: CSV for programs, LaTeX for a paper."""

import csv
import io
import re
from collections.abc import Iterator, Mapping
from typing import Any

from .formats import Format

Document = Mapping[str, Any]
_NAMED, _KINDS = ("name", "joint", "unit", "grouping"), ("value", "standard_deviation")
_SPECIAL = re.compile(r"([&%$#_{}])")


def comparison_csv(document: Document) -> bytes:
    """Write one row per parameter, with value and deviation by every estimator that gave one."""
    given = _given(document)
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow([*_NAMED, *(f"{row['estimator']}_{kind}" for row in given for kind in _KINDS)])
    for number, parameter in enumerate(document["parameters"]):
        own = [row["base_parameters"][number] for row in given]
        # A deviation that is not known is an empty cell.
        writer.writerow([*(parameter[key] for key in _NAMED), *(one[kind] for one in own for kind in _KINDS)])
    return text.getvalue().encode()


def comparison_latex(document: Document) -> bytes:
    """Write the parameters with their deviations, and below them errors and cost, as a `tabular`."""
    given = _given(document)
    lines = [
        rf"\begin{{tabular}}{{ll{'r' * len(given)}}}",
        r"\hline",
        _line(["parameter", "unit", *(_text(row["estimator"]) for row in given)]),
        r"\hline",
        *(_parameter(number, row, given) for number, row in enumerate(document["parameters"])),
        r"\hline",
        *_figures(given),
        r"\hline",
        r"\end{tabular}",
    ]
    return ("\n".join(lines) + "\n").encode()


def _given(document: Document) -> list[Document]:
    """List the estimators that gave parameters."""
    return [row for row in document["compared"] if row["base_parameters"]]


def _parameter(number: int, named: Document, given: list[Document]) -> str:
    cells = [_measured(row["base_parameters"][number]) for row in given]
    return _line([_text(named["name"]), _text(named["unit"]), *cells])


def _measured(row: Document) -> str:
    deviation = row["standard_deviation"]
    known = "" if deviation is None else rf" \pm {_number(deviation, 2)}"
    return f"${_number(row['value'], 4)}{known}$"


def _figures(given: list[Document]) -> Iterator[str]:
    for title, unit, key in (
        ("held-out torque error", r"\%", "validation_total_percent"),
        ("processor time", "s", "cpu_seconds"),
    ):
        values = [row[key] for row in given]
        yield _line([title, unit, *("--" if value is None else f"${_number(value, 3)}$" for value in values)])


def _number(value: float, digits: int) -> str:
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else mantissa


def _line(cells: list[str]) -> str:
    return " & ".join(cells) + r" \\"


def _text(text: str) -> str:
    return _SPECIAL.sub(r"\\\1", text)


FORMATS: Mapping[str, Format] = {
    "comparison.csv": Format("text/csv", "parameters by every estimator", comparison_csv),
    "comparison.tex": Format("application/x-tex", "the same as a LaTeX table", comparison_latex),
}
"""The files that a comparison is offered as."""
