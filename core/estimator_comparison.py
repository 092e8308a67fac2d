"""Fit one set of logs by several estimators, and set parameters, errors and cost beside each other.

Logs are conditioned, checked against the robot and observed once.
"""

from dataclasses import replace

from .document.conflicts import conflict_rows, with_conflicts
from .document.estimator_comparison import comparison_document
from .document.version import product_version
from .identification.comparison import fit_by
from .identification.comparison_options import options_for, read_estimators, read_options
from .identification.identify import Progress, no_progress
from .identification.options import BEGINNING
from .numerics.threads import on_one_thread
from .study import IdentifyRequest, identify_with_conflicts


@on_one_thread()
def compare_estimators(request: IdentifyRequest, progress: Progress | None = None) -> dict[str, object]:
    """Fit by every estimator that the option `compare` names, and give the document.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way of all of them, with cause, evidence and remedy.
    """
    tell, names = progress or no_progress, read_estimators(request.options)
    read_options(request.options)
    plain = options_for(request.options, BEGINNING) | {"bootstrap": {"draws": 0}}
    begun, conflicts = identify_with_conflicts(
        replace(request, options=plain, traces=None), lambda stage, done: tell(stage, 0.4 * done)
    )
    compared = []
    for number, name in enumerate(names):
        tell(f"fit by {name}", 0.4 + 0.6 * number / len(names))
        compared.append(fit_by(name, request.options, begun))
    document = comparison_document(begun, compared, version=product_version(), options=dict(request.options))
    return with_conflicts(document, conflict_rows(conflicts, request.robot, request.logs))
