"""Tell where a result comes from: the logs with their defects, the method in short, version and hashes."""

import json

from .markup import Html, listing, section, table, tag, together
from .units import effort
from .words import Document, number, percent, reference

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
    reasons = listing(_filtered(log) for log in logs if (log.get("filter") or {}).get("reason"))
    parts = (table("Logs", headings, rows), reasons, tag("h3", "Defects"), said, *_excitation(document))
    return section("The data", *parts, key="data")


def _filtered(log: Document) -> str:
    return f"{log['name']}: {log['filter']['reason']}."


def _excitation(document: Document) -> list[object]:
    """Say how well the motion tells the parameters apart, and what of it was used."""
    precision = document.get("precision") or {}
    scaled, plain = document.get("condition_number_scaled"), document.get("condition_number")
    told = [
        scaled
        and f"Condition number of the equations: {number(scaled)} with columns of equal length, "
        f"{number(plain)} as they are. The smaller, the better the motion tells parameters apart.",
        precision.get("equations")
        and f"{precision['equations']} filtered equations were fitted; "
        f"{percent(precision.get('left_out_percent'))} were left out at standstill and at ends of stretches.",
    ]
    noise, memory = precision.get("noise") or [], precision.get("memory_factor") or []
    rows = [
        (str(joint), effort(document, joint, one), number(factor))
        for joint, (one, factor) in enumerate(zip(noise, memory, strict=False), start=1)
    ]
    note = "Memory: by how much samples that resemble their neighbours inflate the variance of a constant."
    headings = ("joint", "RMS of the residual", "memory")
    noted = table("Noise per joint, as the fit sees it", headings, rows, note=note) if rows else None
    listed = listing(one for one in told if one)
    return [tag("h3", "Excitation and noise"), listed, noted] if listed or rows else []


def method_section(document: Document) -> Html:
    """Say in short how it was done, and from what."""
    text = f"{_first(document)}{_DIAGNOSE} {_IDENTIFY}" if document.get("diagnosis") else _IDENTIFY
    return section("How this was done", tag("p", text), _sources(document), key="method")


def _sources(document: Document) -> Html:
    """List what every number of the page rests on, so that it can be computed again."""
    given = document.get("provenance") or {}
    names = [str(log.get("name", "")) for log in document.get("logs") or []]
    hashes = [one for one in given.get("log_sha256") or [] if one]
    logs = [(together(["log ", name]), tag("code", one)) for name, one in zip(names, hashes, strict=False)]
    rows = [
        *((name, together(["SHA-256 ", code])) for name, code in logs),
        ("options", tag("code", json.dumps(given.get("options") or {}))),
        ("program", f"Veritorque {given.get('version', '')}, document {document.get('schema_version', '')}"),
    ]
    note = "The same robot, logs, options and version give the same numbers, byte for byte."
    return table("What every number of this page comes from", ("source", "which"), rows, note=note, text=(1,))


def _first(document: Document) -> str:
    other = reference(document)
    return _COMPARED.format(other) if other else _ANEW


def _defect(defect: Document) -> Html:
    where = "" if defect.get("joint") is None else f", joint {defect['joint']}"
    head = tag("b", f"{defect['kind'].replace('_', ' ')}{where} (log {defect['log']})")
    return together([head, f": {defect['statement']}."])
