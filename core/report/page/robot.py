"""Tell an identification: what was found, how well it is known, and whether such a robot can exist."""

from collections.abc import Sequence

from .markup import Html, listing, section, table, tag
from .units import effort, unit_of_mass_matrix
from .whisker import whisker
from .words import Document, fit_band, number, percent, uncertain, unit

_OF_PSEUDO_INERTIA = "in SI units, of entries in kg m², kg m and kg; its sign is what counts"


def headline(document: Document) -> str:
    """Give the result as a sentence."""
    counts, held = document["counts"], document.get("validation_total_percent")
    on = "unseen data" if held is not None else "the data it was fitted to"
    error = held if held is not None else document.get("fit_total_percent")
    exists = document["feasibility"].get("feasible")
    can = {True: "a robot that can exist", False: "a robot that cannot exist"}.get(exists, "a robot")
    return (
        f"{document['robot']['name']} is identified as {can}: {counts['base']} base parameters, torque error "
        f"{percent(error)} on {on}."
    )


def scores_section(document: Document) -> Html | None:
    """Tabulate the error of the predicted torque per joint, fitted and held out."""
    fit, held = (_by_joint(document.get(name) or []) for name in ("fit", "validation"))
    if not fit:
        return None
    rows = [
        (
            str(joint),
            effort(document, joint, row["rms_torque"]),
            effort(document, joint, row["rms_residual"]),
            percent(row["nrmse_of_range_percent"]),
            percent(row["nrmse_of_rms_percent"]),
            *_unseen(document, held.get(joint)),
        )
        for joint, row in fit.items()
    ]
    headings = ("joint", "torque RMS", "error, fitted", "% of range", "% of RMS", "error, unseen", "% of RMS")
    note = (
        f"RMS {fit_band(document)}: torque and error pass the filter that "
        "the model is fitted with. Unseen: blocks of time that were held out of the fit."
    )
    told = table("Error of the predicted torque", headings, rows, note=note)
    return section("How well it predicts torque", told, key="torque")


def _unseen(document: Document, row: Document | None) -> tuple[str, str]:
    if row is None:
        return "", ""
    return effort(document, row["joint"], row["rms_residual"]), percent(row["nrmse_of_rms_percent"])


def existence_section(document: Document) -> Html | None:
    """Say whether the robot can exist, and what that cost."""
    found, solver = document.get("feasibility") or {}, document.get("solver") or {}
    if not found:
        return None
    smallest = [one for one in found.get("pseudo_inertia_min_eigenvalue") or [] if one is not None]
    mass = found.get("mass_matrix_min_eigenvalue") or {}
    workspace = f"{mass.get('configurations')} configurations of the workspace"
    objectives = [number(solver.get(name), 4) for name in ("objective", "objective_ols")]
    can, least = ("can" if found.get(name) else "cannot" for name in ("feasible", "ols_feasible"))
    bounds = found.get("active_constraints") or []
    told = [
        f"The identified robot {can} exist; plain least squares gives one that {least}.",
        smallest
        and f"Smallest eigenvalue of a link's pseudo-inertia: {number(min(smallest))} {_OF_PSEUDO_INERTIA}.",
        mass
        and f"Smallest eigenvalue of the mass matrix in {workspace}: {number(mass['workspace'])} "
        f"{unit_of_mass_matrix(document)}.",
        f"Solver: {solver.get('status')}; objective {objectives[0]} beside {objectives[1]} of least squares.",
        bounds and f"Bounds that the estimate touches: {', '.join(bounds)}.",
    ]
    return section("Whether such a robot can exist", listing(one for one in told if one))


def doubts_section(document: Document) -> Html | None:
    """List what does not look right."""
    doubts = document.get("doubts") or []
    return section("What deserves a second look", listing(f"{one}." for one in doubts)) if doubts else None


def parameters_section(rows: Sequence[Document], heading: str) -> Html | None:
    """Tabulate base parameters with %P, new ones first; a star marks the essential ones."""
    if not rows:
        return None
    listed = [
        (
            f"{row['name']}{'*' if row.get('essential') else ''}",
            uncertain(row["value"], row["standard_deviation"]),
            percent(row.get("relative_deviation_percent")),
            whisker(row),
            number(row.get("value_ols")),
            tag("span", unit(row["unit"])),
            tag("b", "joined the model")
            if row.get("new")
            else tag("span", row.get("grouping") or "", class_="meta"),
        )
        for row in sorted(rows, key=lambda row: not row.get("new"))
    ]
    note = (
        "* essential; %P: relative standard deviation. Error bars, each row on a scale of its own with zero "
        "as the upright line: the dot is the value, the thick bar the 95 % interval, the thin one that of "
        "blocks of the log drawn anew, constraints included."
    )
    headings = (
        "parameter",
        "value ± standard deviation",
        "%P",
        "error bars",
        "least squares",
        "unit",
        "what is grouped in it",
    )
    return section(
        heading,
        table("Base parameters", headings, listed, note=note, text=(6,)),
        key="parameters",
    )


def _by_joint(rows: Sequence[Document]) -> dict[int, Document]:
    return {int(row["joint"]): row for row in rows}
