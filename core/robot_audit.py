"""Audit a robot's description: by itself in no time, and against logs by what an identification tells."""

from dataclasses import replace

from .audit.contradictions import contradictions, evidence_of
from .audit.description import description_remarks
from .audit.thresholds import LOG
from .conflicts.check import Conflicts
from .document.audit import NO_BODIES, description_document, measured_part
from .document.conflicts import conflict_rows, with_conflicts
from .document.version import product_version
from .identification.identify import Progress
from .identification.result import Identification
from .robot.model import RobotModel
from .study import IdentifyRequest, identify_with_conflicts


def audit_description(robot: RobotModel, makers_mass: float | None = None) -> dict[str, object]:
    """Audit a description without a log.

    Parameters
    ----------
    makers_mass
        Mass of the robot by its data sheet, kg; None where it is not known.
    """
    return description_document(robot, description_remarks(robot, makers_mass), makers_mass)


def audit_robot(
    request: IdentifyRequest, makers_mass: float | None = None, progress: Progress | None = None
) -> dict[str, object]:
    """Audit a description against logs.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way of an identification, with cause, evidence and remedy.
    """
    quick = replace(request, options={**request.options, "bootstrap": {"draws": 0}}, traces=None)
    found, conflicts = identify_with_conflicts(quick, progress)
    why = _doubt(found, conflicts)
    evidence = evidence_of(found) if why is None else None
    document = audit_description(request.robot, makers_mass) | measured_part(
        found,
        None if evidence is None else contradictions(evidence),
        why,
        version=product_version(),
        options=dict(request.options),
    )
    return with_conflicts(document, conflict_rows(conflicts, request.robot, request.logs))


def _doubt(found: Identification, conflicts: Conflicts) -> str | None:
    """Say why no entry can be judged: what the model itself gets wrong is no entry's fault."""
    if found.base.model.robot.prior is None:
        return NO_BODIES
    if conflicts.is_open:
        return "robot and logs disagree in more than the bodies; correct that first"
    error = found.validation_total_percent if found.validation else found.fit_total_percent
    if error > LOG.tolerated_percent:
        return (
            f"the model predicts held-out torque only to {error:.3g} % of its RMS, more than "
            f"{LOG.tolerated_percent:g} %: no bodies of this robot explain it"
        )
    return None
