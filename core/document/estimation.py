"""Say by which estimator a robot was fitted, how it ended, and what its instruments tell."""

from ..estimate.methods.registry import ESTIMATORS
from ..identification.result import Identification


def estimation_fields(found: Identification) -> dict[str, object]:
    """Tell of the estimator, of every step that it took, and of the motion that it simulated."""
    method, ended = ESTIMATORS[found.estimator], found.convergence
    return {
        "estimator": found.estimator,
        "title": method.title,
        "constrained": method.feasible,
        "converged": ended.converged,
        "stop_reason": ended.reason,
        "steps": [vars(step) for step in ended.steps],
        "simulation": {"from": "replay", **vars(found.simulation)} if method.iterative else None,
        "instruments": None if found.endogeneity is None else vars(found.endogeneity),
    }
