"""Write parts of a result document as CSV, with the numbers as they are: rounding is for reports."""

import csv
import io
from collections.abc import Mapping
from typing import Any

from ..document.model.answer import model_name, plain_document

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
    "model",
    "value_plain",
)
STANDARD_COLUMNS = ("name", "joint", "unit", "value", "identifiable", "model", "value_plain")


def base_parameter_table(result: Document) -> str:
    """Write the base parameters, which are identifiable, with the standard ones that each groups.

    Of a diagnosis they are the extended model's, as `model` says, with the plain model's in `value_plain`.
    """
    return _table(_rows(result, "base_parameters"), BASE_COLUMNS)


def standard_parameter_table(result: Document) -> str:
    """Write one feasible representative; `identifiable` tells which values are known only in combination."""
    return _table(_rows(result, "standard_parameters"), STANDARD_COLUMNS)


def _rows(result: Document, table: str) -> list[dict[str, object]]:
    """Give the rows of a table with the model that they are of, and the plain model's values beside them."""
    rows = result.get(table)
    if not isinstance(rows, list):
        return []
    plain = {row["name"]: row["value"] for row in plain_document(result)[table]}
    beside = {"model": model_name(result)}
    return [row | beside | {"value_plain": plain.get(row["name"])} for row in rows]


def _table(rows: list[dict[str, object]], columns: tuple[str, ...]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, extrasaction="ignore", restval="")
    writer.writeheader()
    writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)
    return text.getvalue()


def _cell(value: object) -> object:
    return str(value).lower() if isinstance(value, bool) else value
