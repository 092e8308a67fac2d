"""Tell where a result comes from: the logs with their defects, the method in short, version and hashes."""

import json

from core.report.page.markup import Html, listing, section, table, tag, together
from core.report.page.words import Document, number, reference

_IDENTIFY = (
    "Position is differentiated and torque filtered by the same zero-phase filters; the equations of motion "
    "are linear in the parameters, and the parameters are the optimum of one semidefinite programme whose "
    "constraints say that every link can exist. Standard deviations know the memory of the noise. Blocks of "
    "time that no fit has seen are predicted to measure the error."
)
_ANEW = (
    "First everything the standard model has was identified, so that what is left cannot be absorbed by any "
    "of its parameters. "
)
_COMPARED = (
    "The parameters of the model were believed to be those of {}, as near to them as they are known there, "
    "so that a change shows which a new identification would absorb. "
)
_DIAGNOSE = (
    "Then every known cause was tried on every joint against the whitened residual, "
    "corrected for the number of trials; causes joined the model one by one, each had to defend its place "
    "against being dropped and against its rivals, and none was built from the measured torque. The extended "
    "model was identified again under the same physical constraints and measured on blocks of time that no "
    "fit has seen."
)


def data_section(document: Document) -> Html | None:
    """Describe the logs and list what is wrong with them."""
    logs = document.get("logs") or []
    if not logs:
        return None
    rows = [
        (
            str(log.get("name", "")),
            str(log.get("samples", "")),
            f"{number(log.get('duration_s'), 4)} s",
            f"{number(log.get('rate_hz'), 4)} Hz",
            f"{number((log.get('filter') or {}).get('cutoff_hz'))} Hz",
        )
        for log in logs
    ]
    defects = document.get("defects") or []
    said = listing(_defect(one) for one in defects) or tag("p", "No defect was found in them.")
    headings = ("log", "samples", "duration", "rate", "filtered at")
    return section("The data", table("Logs", headings, rows), tag("h4", "Defects"), said)


def method_section(document: Document) -> Html:
    """Say in short how it was done, and from what."""
    given = document.get("provenance") or {}
    text = f"{_first(document)}{_DIAGNOSE} {_IDENTIFY}" if document.get("diagnosis") else _IDENTIFY
    hashes = ", ".join(str(one) for one in given.get("log_sha256") or [] if one) or "none"
    return section(
        "How this was done",
        tag("p", text),
        listing(
            [
                f"Veritorque {given.get('version', '')}, document {document.get('schema_version', '')}",
                together(["Options: ", tag("code", json.dumps(given.get("options") or {}))]),
                together(["SHA-256 of the logs: ", tag("code", hashes)]),
            ]
        ),
    )


def _first(document: Document) -> str:
    other = reference(document)
    return _COMPARED.format(other) if other else _ANEW


def _defect(defect: Document) -> Html:
    where = "" if defect.get("joint") is None else f", joint {defect['joint']}"
    head = tag("b", f"{defect['kind'].replace('_', ' ')}{where} (log {defect['log']})")
    return together([head, f": {defect['statement']}."])
