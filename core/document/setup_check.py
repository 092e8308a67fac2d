"""Compose the document of a set-up check: whether robot and logs belong together, and what the logs show."""

from typing import Literal

import numpy as np

from ..conflicts.check import Conflicts
from ..diagnosis.causes.protocol import Site
from ..diagnosis.causes.registry import BY_ID
from ..diagnosis.checks.separability import Pair, Separability, Shown, Smallest
from ..identification.result import Identification
from ..precision.inference import POOR_PERCENT, relative_deviation_percent
from ..validation.quality import quality
from .identification import grouping_row, identification_document
from .numbers import plain

_TAKEN_OVER = (
    "schema_version",
    "robot",
    "logs",
    "provenance",
    "counts",
    "terms",
    "fit",
    "fit_total_percent",
    "validation",
    "validation_total_percent",
    "held_out",
    "condition_number",
    "defects",
    "doubts",
)
Agreement = Literal["yes", "after_correction", "doubtful"]


def check_document(
    found: Identification,
    conflicts: Conflicts,
    separable: Separability | None,
    *,
    version: str,
    options: object,
) -> dict[str, object]:
    """Compose the document, without the conflicts themselves."""
    whole = identification_document(found, version=version, options=options)
    document = {
        "kind": "check",
        "agreement": _agreement(found, conflicts),
        **{key: whole[key] for key in _TAKEN_OVER},
        "identifiable": _identifiable(found),
        "shown": [] if separable is None else _causes(separable.shown),
        "separable": {} if separable is None else _matrix(separable.pairs),
        "not_separable": [] if separable is None else _not_separable(separable),
    }
    return {key: plain(value) for key, value in document.items()}


def _agreement(found: Identification, conflicts: Conflicts) -> Agreement:
    """Say whether robot and logs belong together.

    It is doubtful where a conflict is not corrected, or the model fails to predict a joint.
    """
    failed = any(quality(score.nrmse_of_rms_percent) == "failed" for score in found.validation or found.fit)
    if conflicts.is_open or failed:
        return "doubtful"
    return "after_correction" if conflicts.found else "yes"


def _identifiable(found: Identification) -> list[dict[str, object]]:
    percent = relative_deviation_percent(found.estimate.base, found.precision.standard_deviation)
    known = np.isfinite(found.precision.standard_deviation)
    return [
        {
            **grouping_row(found.base, row),
            "relative_deviation_percent": percent[row] if known[row] else None,
            "identifiable": "needs_motion"
            if not known[row]
            else "yes"
            if percent[row] <= POOR_PERCENT
            else "poorly",
        }
        for row in range(len(found.base.kept))
    ]


def _causes(shown: tuple[Shown, ...]) -> list[dict[str, object]]:
    """Say per cause on which joints these logs can show it, and from which size on."""
    sites: dict[str, list[Shown]] = {}
    for site in shown:
        sites.setdefault(site.cause.id, []).append(site)
    return [_of_cause(own) for own in sites.values()]


def _of_cause(sites: list[Shown]) -> dict[str, object]:
    cause = sites[0].cause
    return {
        "cause": cause.id,
        "title": cause.title,
        "visible": any(site.visible for site in sites),
        "not_on_joints": sorted({joint for site in sites if not site.visible for joint in site.site}),
        "smallest": [_size(site.smallest, site.site) for site in sites if site.smallest is not None],
        "experiment": cause.experiment,
    }


def _size(smallest: Smallest, site: Site) -> dict[str, object]:
    quantity = smallest.quantity
    return {
        "joints": site,
        "name": quantity.name,
        "unit": quantity.unit,
        "bound": "at_most" if smallest.falls else "at_least",
        "value": abs(quantity.value),
    }


def _matrix(pairs: tuple[Pair, ...]) -> dict[str, dict[str, str]]:
    """Tabulate causes by causes."""
    table: dict[str, dict[str, str]] = {}
    for pair in pairs:
        first, second = pair.causes
        table.setdefault(first, {})[second] = pair.answer
        table.setdefault(second, {})[first] = pair.answer
    return table


def _not_separable(separable: Separability) -> list[dict[str, object]]:
    """List the pairs that are not distinguished, of causes that these logs can show at all."""
    visible = {site.cause.id for site in separable.shown if site.visible}
    return [
        _pair(pair) for pair in separable.pairs if pair.answer != "yes" and visible.issuperset(pair.causes)
    ]


def _pair(pair: Pair) -> dict[str, object]:
    """Say why two causes are not distinguished, and which experiment does it."""
    first, second = pair.causes
    if pair.known is not None:
        why, experiment = pair.known.why, pair.known.experiment
    elif pair.joints:
        why = "the torque of both is nearly the same in this motion"
        experiment = BY_ID[second].experiment
    else:
        why = "this motion shows both on no joint together"
        experiment = f"{BY_ID[first].experiment}; {BY_ID[second].experiment}"
    return {
        "causes": [first, second],
        "answer": pair.answer,
        "joints": pair.joints,
        "why": why,
        "experiment": experiment,
    }
