"""Compose the document of a comparison of estimators: one row each, failed ones with their reason."""

from collections.abc import Sequence

from ..estimate.methods.registry import ESTIMATORS
from ..identification.comparison import Compared
from ..identification.result import Identification
from ..precision.inference import relative_deviation_percent
from .estimation import estimation_fields
from .identification import grouping_row, identification_document, score_rows
from .motion import position_errors
from .numbers import plain

_TAKEN_OVER = (
    "schema_version",
    "robot",
    "logs",
    "provenance",
    "counts",
    "terms",
    "held_out",
    "condition_number",
    "defects",
)


def comparison_document(
    begun: Identification, compared: Sequence[Compared], *, version: str, options: object
) -> dict[str, object]:
    """Compose the document, without the conflicts.

    Parameters
    ----------
    begun
        The identification whose conditioned logs all estimators were fitted to.
    """
    whole = identification_document(begun, version=version, options=options)
    document = {
        "kind": "compare",
        **{key: whole[key] for key in _TAKEN_OVER},
        "doubts": whole["doubts"],
        "parameters": [grouping_row(begun.base, row) for row in range(len(begun.base.kept))],
        "compared": [_row(one) for one in compared],
    }
    return {key: plain(value) for key, value in document.items()}


def _row(one: Compared) -> dict[str, object]:
    failure = one.failure
    return {
        "estimator": one.estimator,
        "title": ESTIMATORS[one.estimator].title,
        "cpu_seconds": one.cpu_seconds,
        "failure": None
        if failure is None
        else {"cause": failure.cause, "evidence": failure.evidence, "remedy": failure.remedy},
        **(_NOTHING if one.found is None else _answer(one.found)),
        "simulated_motion": None if one.motion is None else position_errors(one.motion),
        "simulated_motion_note": one.motion_note,
    }


_NOTHING: dict[str, object] = {
    "feasible": None,
    "base_parameters": [],
    "fit_total_percent": None,
    "validation": [],
    "validation_total_percent": None,
    "estimation": None,
}


def _answer(found: Identification) -> dict[str, object]:
    deviation = found.precision.standard_deviation
    percent = relative_deviation_percent(found.estimate.base, deviation)
    return {
        "feasible": found.feasible,
        "base_parameters": [
            {
                "name": name,
                "unit": found.base.parameter(row).unit,
                "value": found.estimate.base[row],
                "standard_deviation": deviation[row],
                "relative_deviation_percent": percent[row],
            }
            for row, name in enumerate(found.base.names)
        ],
        "fit_total_percent": found.fit_total_percent,
        "validation": score_rows(found.validation),
        "validation_total_percent": found.validation_total_percent if found.validation else None,
        "estimation": estimation_fields(found),
    }
