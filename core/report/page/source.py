"""Describe the origin of a result: logs with defects, excitation, method, and provenance."""

import json

from .render import Table, element
from .units import effort
from .words import Document, number, percent, reference


def sources(document: Document) -> dict[str, object]:
    """Give what the sections on data and method show."""
    return {
        "logs": _logs(document),
        "filters": [
            f"{log['name']}: {log['filter']['reason']}."
            for log in document.get("logs") or []
            if (log.get("filter") or {}).get("reason")
        ],
        "excitation": _excitation(document),
        "noise": _noise(document),
        "reference": reference(document) if document.get("diagnosis") else None,
        "provenance": _provenance(document),
        "estimation": _estimation(document),
    }


def _estimation(document: Document) -> str:
    """Say how the estimate was computed."""
    estimation = document.get("estimation") or {}
    constrained = estimation.get("constrained", True)
    programme = (
        "The estimate is the optimum of a semidefinite programme whose constraints ensure the physical "
        "consistency of every link."
        if constrained
        else "The estimate is not constrained to be physically consistent."
    )
    return " ".join([*estimation.get("statements", []), programme])


def _logs(document: Document) -> Table:
    rows = [
        (
            str(log.get("name", "")),
            str(log.get("samples", "")),
            f"{number(log.get('duration_s'), 4)} s",
            f"{number(log.get('rate_hz'), 4)} Hz",
            f"{number((log.get('filter') or {}).get('cutoff_hz'))} Hz",
        )
        for log in document.get("logs") or []
    ]
    return Table("Logs", ("log", "samples", "duration", "rate", "filter cut-off"), rows)


def _excitation(document: Document) -> list[str]:
    precision = document.get("precision") or {}
    scaled, plain = document.get("condition_number_scaled"), document.get("condition_number")
    sentences = [
        scaled
        and f"Condition number of the observation matrix: {number(scaled)} with columns scaled to unit norm, "
        f"{number(plain)} without scaling.",
        precision.get("equations")
        and f"{precision['equations']} filtered equations were fitted; "
        f"{percent(precision.get('left_out_percent'))} were excluded at standstill and at ends of segments.",
    ]
    return [sentence for sentence in sentences if sentence]


def _noise(document: Document) -> Table:
    precision = document.get("precision") or {}
    pairs = zip(precision.get("noise") or [], precision.get("memory_factor") or [], strict=False)
    rows = [
        (str(joint), effort(document, joint, rms), number(factor))
        for joint, (rms, factor) in enumerate(pairs, start=1)
    ]
    note = "Variance inflation: factor by which autocorrelation increases the variance of a constant."
    return Table("Residual noise per joint", ("joint", "residual RMS", "variance inflation"), rows, note)


def _provenance(document: Document) -> Table:
    """List hashes, options and versions, from which every number can be computed again."""
    provenance = document.get("provenance") or {}
    version = provenance.get("version", "")
    names = [str(log.get("name", "")) for log in document.get("logs") or []]
    hashes = filter(None, provenance.get("log_sha256") or [])
    rows = [
        *(
            (f"log {name}", element("span", "SHA-256 ", element("code", digest)))
            for name, digest in zip(names, hashes, strict=False)
        ),
        ("options", element("code", json.dumps(provenance.get("options") or {}))),
        ("program", f"Veritorque {version}, document {document.get('schema_version', '')}"),
    ]
    note = "The same robot, logs, options and version give bit-identical results."
    return Table("Provenance", ("source", "value"), rows, note, (1,))
