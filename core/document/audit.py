"""Compose the document of an audit: what is odd about a description, and what logs contradict of it."""

from dataclasses import replace

import numpy as np

from ..arrays import LinkTable, Matrix, Vector
from ..audit.contradictions import Contradiction, Correction, described_mass
from ..audit.description import Remark
from ..audit.entries import Entry
from ..audit.thresholds import LOG
from ..identification.reference import bodies_spread
from ..identification.result import Identification
from ..numerics.distributions import normal_tail
from ..robot.inertia import mass_properties
from ..robot.model import RobotModel
from ..robot.writing import to_description
from .identification import SCHEMA_VERSION, grouping_row, identification_document
from .numbers import plain

_TAKEN_OVER = (
    "schema_version",
    "logs",
    "provenance",
    "fit",
    "fit_total_percent",
    "validation",
    "validation_total_percent",
    "held_out",
    "defects",
    "doubts",
)


def description_document(
    robot: RobotModel, remarks: tuple[Remark, ...], makers_mass: float | None
) -> dict[str, object]:
    """Compose the document of a description alone."""
    document = {
        "schema_version": SCHEMA_VERSION,
        "kind": "audit",
        "conflicts": [],
        "doubts": [],
        "robot": to_description(robot),
        "bodies_described": robot.prior is not None,
        "total_mass": {
            "described": None if robot.prior is None else described_mass(robot.prior),
            "maker": makers_mass,
        },
        "remarks": [_remark(remark, robot) for remark in remarks],
        "logs": [],
        "judged": False,
        "not_judged_because": "no log was given" if robot.prior is not None else NO_BODIES,
        "contradicted": [],
        "combinations": [],
        "corrected_robot": None,
    }
    return {key: plain(value) for key, value in document.items()}


NO_BODIES = "the description gives no masses and inertias, so there is nothing to contradict"


def measured_part(
    found: Identification,
    judged: tuple[tuple[Contradiction, ...], Correction] | None,
    why: str | None,
    *,
    version: str,
    options: object,
) -> dict[str, object]:
    """Compose what logs add to the document of a description."""
    whole = identification_document(found, version=version, options=options)
    robot = found.base.model.robot
    part: dict[str, object] = {key: whole[key] for key in _TAKEN_OVER}
    part |= {
        "judged": judged is not None,
        "not_judged_because": why,
        "combinations": [] if robot.prior is None else _combinations(found, robot.prior),
    }
    if judged is not None and robot.prior is not None:
        contradicted, correction = judged
        corrected = replace(robot, prior=correction.table)
        part["contradicted"] = [
            _contradiction(found_entry, robot, robot.prior, correction.table) for found_entry in contradicted
        ]
        part["corrected_robot"] = to_description(corrected) if contradicted else None
    return {key: plain(value) for key, value in part.items()}


def _remark(remark: Remark, robot: RobotModel) -> dict[str, object]:
    name = None if remark.link is None else robot.links[remark.link - 1].name
    return {**vars(remark), "name": name}


def _contradiction(
    found: Contradiction, robot: RobotModel, described: LinkTable, corrected: LinkTable
) -> dict[str, object]:
    entry = found.entry
    name = robot.links[entry.link - 1].name
    old, new = (_value(table, entry) for table in (described, corrected))
    others = [_entry(other, robot) for other in found.alternatives]
    chance = f"p = {found.p_value:.1g}" if found.p_value > 0.0 else "p < 1e-300"
    statement = (
        f"{TITLES[entry.kind]} of link {entry.link} ({name}): described {old[1]}, measured {new[1]} "
        f"({chance}, corrected for the number of entries)"
    )
    return {
        **_entry(entry, robot),
        "described": old[0],
        "corrected": new[0],
        "unit": UNITS[entry.kind],
        "chi_square": found.gain,
        "p_value": found.p_value,
        "statement": statement,
        "ambiguous_with": others,
    }


TITLES = {"mass": "mass", "centre": "mass centre", "inertia": "inertia about the mass centre"}
UNITS = {"mass": "kg", "centre": "m", "inertia": "kg m2"}


def _entry(entry: Entry, robot: RobotModel) -> dict[str, object]:
    return {"link": entry.link, "name": robot.links[entry.link - 1].name, "entry": entry.kind}


def _value(table: LinkTable, entry: Entry) -> tuple[list[float], str]:
    """Give an entry's numbers (inertia: XX XY XZ YY YZ ZZ), and the same for a reader."""
    mass, centre, inertia = mass_properties(table[entry.link - 1])
    if entry.kind == "mass":
        return [mass], f"{mass:.4g} kg"
    if entry.kind == "centre":
        return [*centre.tolist()], f"({_listed(centre)}) m"
    principal = np.linalg.eigvalsh(inertia)
    return inertia[np.triu_indices(3)].tolist(), f"principal moments {_listed(principal)} kg m2"


def _listed(values: np.ndarray) -> str:
    return ", ".join(f"{value:.3g}" for value in values)


def _combinations(found: Identification, prior: LinkTable) -> list[dict[str, object]]:
    """Say of every identifiable combination of bodies what was described and what was measured.

    Combinations with rotor inertia or friction are no matter of the description.
    """
    grouping, bodies = found.base.grouping, prior.size
    of_bodies = np.flatnonzero(grouping[:, :bodies].any(axis=1) & ~grouping[:, bodies:].any(axis=1))
    table = grouping[:, :bodies]
    described, slack = table @ prior.ravel(), _slack(table, prior)
    return [
        {**grouping_row(found.base, row), **_compared(found, row, described[row], slack[row], len(of_bodies))}
        for row in map(int, of_bodies)
    ]


def _slack(table: Matrix, prior: LinkTable) -> Vector:
    """Give by how much the described value of every combination may be off."""
    return np.asarray(np.linalg.norm(bodies_spread(table, prior, LOG.slack), axis=1))


def _compared(
    found: Identification, row: int, described: float, slack: float, count: int
) -> dict[str, object]:
    """Compare what was measured of a combination, one of so many, with what was described."""
    measured, deviation = found.estimate.unconstrained[row], found.precision.standard_deviation[row]
    whole = float(np.hypot(deviation, slack))
    known = bool(np.isfinite(whole)) and whole > 0.0
    size = float(measured - described) / whole if known else None
    tail = 1.0 if size is None else min(1.0, 2.0 * normal_tail(abs(size)) * count)
    return {
        "described": described,
        "measured": measured if known else None,
        "standard_deviation": deviation if known else None,
        "slack": slack,
        "deviations": size,
        "contradicted": tail < LOG.p_value,
    }
