"""Write parts of a result document as CSV, with the numbers as they are: rounding is for reports."""

import csv
import io
from collections.abc import Callable, Mapping

from app.store.records import Document

BASE_COLUMNS = (
    "name",
    "joint",
    "unit",
    "value",
    "value_ols",
    "standard_deviation",
    "relative_deviation_percent",
    "essential",
    "grouping",
)
STANDARD_COLUMNS = ("name", "joint", "unit", "value", "identifiable")


def base_parameter_table(result: Document) -> str:
    """Write the base parameters."""
    return _table(result.get("base_parameters"), BASE_COLUMNS)


def standard_parameter_table(result: Document) -> str:
    """Write the standard parameters."""
    return _table(result.get("standard_parameters"), STANDARD_COLUMNS)


ARTIFACTS: Mapping[str, Callable[[Document], str]] = {
    "parameters.csv": base_parameter_table,
    "standard_parameters.csv": standard_parameter_table,
}


def _table(rows: object, columns: tuple[str, ...]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, extrasaction="ignore", restval="")
    writer.writeheader()
    if isinstance(rows, list):
        writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)
    return text.getvalue()


def _cell(value: object) -> object:
    return str(value).lower() if isinstance(value, bool) else value
