"""Describe an identification: parameters with their precision, errors, and physical consistency."""

from collections.abc import Iterator, Sequence

from ...validation.quality import QUALITIES
from .render import Table, element
from .units import effort, unit_of_mass_matrix
from .whisker import whisker
from .words import Document, fit_band, joints, number, percent, series, uncertain, unit

_PSEUDO_INERTIA_UNIT = "in SI units, with entries in kg m², kg m and kg; only its sign matters"


def headline(document: Document) -> str:
    """Give the result in one sentence; a joint that the model does not predict comes before all else."""
    held_out = document.get("validation_total_percent")
    error, data = (
        (document.get("fit_total_percent"), "fitted data")
        if held_out is None
        else (held_out, "held-out data")
    )
    name, failed = document["robot"]["name"], joints_predicted(document).get("failed")
    if failed:
        return (
            f"{name}: identification failed on {joints(failed)}, more than half of the torque is left; "
            f"torque error {percent(error)} on {data}."
        )
    feasible = document["feasibility"].get("feasible")
    consistency = {True: ", physically consistent", False: ", physically inconsistent"}.get(feasible, "")
    return (
        f"{name}: {document['counts']['base']} base parameters identified{consistency}; "
        f"torque error {percent(error)} on {data}{_in_words(document)}."
    )


def joints_predicted(document: Document) -> dict[str, list[int]]:
    """List the joints by the word for their error: on held-out data, where there are any."""
    listed: dict[str, list[int]] = {}
    for row in _judged(document):
        if row.get("quality"):
            listed.setdefault(row["quality"], []).append(int(row["joint"]))
    return listed


def _judged(document: Document) -> list[Document]:
    return document.get("validation") or document.get("fit") or []


def _in_words(document: Document) -> str:
    """Say how well the joints are predicted, the worst first."""
    listed = joints_predicted(document)
    words = [word for word, _ in reversed(QUALITIES) if word in listed]
    if len(words) < 2:
        every = "joint" if all(row.get("quality") for row in _judged(document)) else "joint that moves"
        return f" ({words[0]} on every {every})" if words else ""
    return f" ({series([f'{word} on {joints(listed[word])}' for word in words])})"


def scores(document: Document) -> Table:
    """Tabulate the torque prediction error per joint, fitted and held out."""
    held_out = {int(row["joint"]): row for row in document.get("validation") or []}
    rows = [
        (
            str(row["joint"]),
            effort(document, row["joint"], row["rms_torque"]),
            effort(document, row["joint"], row["rms_residual"]),
            percent(row["nrmse_of_range_percent"]),
            percent(row["nrmse_of_rms_percent"]),
            *_held_out(document, held_out.get(int(row["joint"]))),
        )
        for row in document.get("fit") or []
    ]
    headings = ("joint", "RMS torque", "fit error", "% of range", "% of RMS", "held-out error", "% of RMS")
    note = (
        f"RMS {fit_band(document)}: torque and error pass the filter of the fit. Held out: blocks of time "
        "excluded from the fit."
    )
    return Table("Torque prediction error", headings, rows, note)


def _held_out(document: Document, row: Document | None) -> tuple[str, str]:
    if row is None:
        return "", ""
    return effort(document, row["joint"], row["rms_residual"]), percent(row["nrmse_of_rms_percent"])


def consistency(document: Document) -> list[str]:
    """List facts about physical consistency and its cost; empty where the document has none."""
    found, solver = document.get("feasibility") or {}, document.get("solver") or {}
    if not found:
        return []
    objective, least = (number(solver.get(name), 4) for name in ("objective", "objective_ols"))
    words = {True: "consistent", False: "inconsistent", None: "unknown"}
    own, ols = (words[found.get(name)] for name in ("feasible", "ols_feasible"))
    sentences = [
        f"Identified parameters: {own}; ordinary least squares: {ols}.",
        *_smallest_eigenvalues(document, found),
        f"Cost of the consistency constraint: objective {objective}, ordinary least squares {least}.",
        f"Solver: {solver.get('status')}.",
    ]
    if bounds := found.get("active_constraints"):
        sentences.append(f"Active constraints: {', '.join(bounds)}.")
    return sentences


def _smallest_eigenvalues(document: Document, found: Document) -> Iterator[str]:
    eigenvalues = [value for value in found.get("pseudo_inertia_min_eigenvalue") or [] if value is not None]
    if eigenvalues:
        smallest = number(min(eigenvalues))
        yield f"Smallest eigenvalue of a link's pseudo-inertia: {smallest} {_PSEUDO_INERTIA_UNIT}."
    if mass := found.get("mass_matrix_min_eigenvalue"):
        workspace = f"{mass.get('configurations')} configurations of the workspace"
        smallest = f"{number(mass['workspace'])} {unit_of_mass_matrix(document)}"
        yield f"Smallest eigenvalue of the mass matrix in {workspace}: {smallest}."


def base_parameters(rows: Sequence[Document]) -> Table:
    """Tabulate base parameters with %P, added ones first; a star marks the essential ones."""
    listed = [
        (
            f"{row['name']}{'*' if row.get('essential') else ''}",
            uncertain(row["value"], row["standard_deviation"]),
            percent(row.get("relative_deviation_percent")),
            whisker(row) or "",
            number(row.get("value_ols")),
            unit(row["unit"]),
            element("b", "added")
            if row.get("new")
            else element("span", row.get("grouping") or "", class_="meta"),
        )
        for row in sorted(rows, key=lambda row: not row.get("new"))
    ]
    note = (
        "* essential. %P: standard deviation in percent of the value. Error bars, scaled per row, zero at "
        "the vertical line. Dot: value; thick bar: 95 % interval; thin bar: 95 % interval of the block "
        "bootstrap, constraints included."
    )
    headings = (
        "parameter",
        "value ± standard deviation",
        "%P",
        "error bars",
        "least squares",
        "unit",
        "grouping",
    )
    return Table("Base parameters", headings, listed, note, (6,))
