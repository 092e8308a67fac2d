"""Say by which estimator a robot was fitted, how it ended, and what its instruments tell."""

from collections.abc import Iterator

from ..estimate.methods.registry import ESTIMATORS
from ..identification.result import Identification
from ..precision.endogeneity import Endogeneity


def estimation_fields(found: Identification) -> dict[str, object]:
    """Tell of the estimator, of every step that it took, and of the motion that it simulated."""
    method, ended = ESTIMATORS[found.estimator], found.convergence
    return {
        "estimator": found.estimator,
        "title": method.title,
        "statements": list(_statements(found)),
        "constrained": method.feasible,
        "converged": ended.converged,
        "stop_reason": ended.reason,
        "steps": [vars(step) for step in ended.steps],
        "simulation": {"from": "replay", **vars(found.simulation)} if method.iterative else None,
        "instruments": None if found.endogeneity is None else vars(found.endogeneity),
    }


def _statements(found: Identification) -> Iterator[str]:
    """Say the same in sentences, for people."""
    method, ended = ESTIMATORS[found.estimator], found.convergence
    yield f"Estimator: {method.title} ({found.estimator})."
    if method.iterative:
        yield f"It simulated the logs {len(ended.steps)} times: {ended.reason}."
    if found.endogeneity is not None:
        yield _difference(found.endogeneity)


def _difference(told: Endogeneity) -> str:
    matters = "which matters" if told.largest > 1.0 else "less than the uncertainty"
    weak = f" The weakest instrument has a correlation of {told.weakest:.2g}." if told.weakest < 0.5 else ""
    return (
        f"The largest difference of a parameter to least squares is {told.largest:.2g} standard deviations, "
        f"{matters}.{weak}"
    )
