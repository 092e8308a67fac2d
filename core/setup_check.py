"""Check a set-up in a second: whether robot and logs belong together, and what these logs can show.

It asks what an identification asks, without redrawing it, and what a diagnosis could distinguish, without
searching.
"""

from collections.abc import Mapping
from dataclasses import replace

from .diagnosis.checks.separability import Separability, separability
from .diagnosis.problem import DiagnosisProblem
from .document.conflicts import conflict_rows, with_conflicts
from .document.setup_check import check_document
from .document.version import product_version
from .errors import ExcitationError
from .identification.identify import Progress
from .identification.options import parse_options
from .identification.result import Identification
from .regressor.columns import ColumnPlan
from .study import IdentifyRequest, identify_with_conflicts

NOT_REDRAWN: Mapping[str, object] = {"bootstrap": {"draws": 0}}


def check_setup(request: IdentifyRequest, progress: Progress | None = None) -> dict[str, object]:
    """Check whether a robot and its logs belong together, and give the document.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way, with cause, evidence and remedy.
    """
    quick = replace(request, options={**request.options, **NOT_REDRAWN}, traces=None)
    found, conflicts = identify_with_conflicts(quick, progress, doubted=True)
    document = check_document(
        found,
        conflicts,
        _separability(found, parse_options(quick.options).validation.blocks),
        version=product_version(),
        options=dict(request.options),
    )
    return with_conflicts(document, conflict_rows(conflicts, request.robot, request.logs))


def _separability(found: Identification, blocks: int) -> Separability | None:
    """Say which causes the logs distinguish; None where they are too short for a diagnosis."""
    plan = ColumnPlan(found.base.model, found.base.kept)
    try:
        return separability(DiagnosisProblem(plan, found.logs, found.held_out, blocks))
    except ExcitationError:
        return None
