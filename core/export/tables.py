"""Write parts of a result document as CSV, with the numbers as they are: rounding is for reports."""

import csv
import io
from collections.abc import Mapping
from typing import Any

Document = Mapping[str, Any]

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
    """Write the base parameters, which are identifiable, with the standard ones that each groups."""
    return _table(result.get("base_parameters"), BASE_COLUMNS)


def standard_parameter_table(result: Document) -> str:
    """Write one feasible representative; `identifiable` tells which values are known only in combination."""
    return _table(result.get("standard_parameters"), STANDARD_COLUMNS)


def _table(rows: object, columns: tuple[str, ...]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, extrasaction="ignore", restval="")
    writer.writeheader()
    if isinstance(rows, list):
        writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)
    return text.getvalue()


def _cell(value: object) -> object:
    return str(value).lower() if isinstance(value, bool) else value
