"""Ask whether base parameters can belong to any robot at all, by the largest margin that one could have.

Base parameters fix only combinations, so their own signs say nothing; what counts is whether some choice of
the open directions makes every pseudo-inertia positive definite. That is a small semidefinite programme with
a certificate either way. Source: Sousa & Cortesao 2014.
"""

from dataclasses import dataclass

import clarabel
import numpy as np
from scipy import sparse

from ..arrays import BaseParameters, Parameters
from ..dynamics.model import DynamicModel
from ..reduction.base import BaseModel
from ..robot.inertia import pseudo_inertia
from .constraints import Bounds, Prior, congruence, link_columns, lower_bounds
from .with_clarabel import SVEC_IDENTITY, svec_rows

_CAP = 1.0


@dataclass(frozen=True)
class Feasibility:
    """Tell whether a physically consistent robot exists.

    `margin` is the largest least scaled eigenvalue (or signed parameter) any choice reaches. Both are None
    where the programme has no accurate optimum, as for values that a motion leaves open to any size.
    """

    feasible: bool | None
    margin: float | None


def feasibility(base: BaseModel, values: BaseParameters, prior: Prior) -> Feasibility:
    """Maximise the margin t over all standard parameters that group into the given base parameters."""
    model, scale = base.model, prior.scale
    size = len(scale)
    own = np.linalg.norm(base.grouping * scale, axis=1)
    equal = np.hstack([base.grouping * scale / own[:, None], np.zeros((len(own), 1))])
    rows, right, cones = [equal], [values / own], [clarabel.ZeroConeT(len(own))]
    for columns in link_columns(model):
        link = np.zeros((10, size + 1))
        link[:, list(columns)] = -svec_rows(congruence(prior, columns)) * scale[list(columns)]
        link[:, -1] = SVEC_IDENTITY
        rows.append(link)
        right.append(np.zeros(10))
        cones.append(clarabel.PSDTriangleConeT(4))
    lower = lower_bounds(model)
    bounded = np.flatnonzero(np.isfinite(lower))
    signs = np.hstack([-np.eye(size)[bounded], np.ones((len(bounded), 1))])
    cap = np.append(np.zeros(size), 1.0)[None, :]
    rows += [signs, cap]
    right += [-lower[bounded] / scale[bounded], np.array([_CAP])]
    cones.append(clarabel.NonnegativeConeT(len(bounded) + 1))
    return _maximise(rows, right, cones, size)


def _maximise(rows: list[np.ndarray], right: list[np.ndarray], cones: list[object], size: int) -> Feasibility:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    linear = np.append(np.zeros(size), -1.0)
    quadratic = sparse.diags(np.append(np.full(size, 1e-9), 0.0), format="csc")
    answer = clarabel.DefaultSolver(
        quadratic, linear, sparse.csc_matrix(np.vstack(rows)), np.concatenate(right), cones, settings
    ).solve()
    if str(answer.status) not in ("Solved", "AlmostSolved"):
        return Feasibility(None, None)
    margin = float(answer.x[-1])
    return Feasibility(margin > -1e-7, margin)


def active_constraints(
    model: DynamicModel, standard: Parameters, prior: Prior, bounds: Bounds
) -> tuple[str, ...]:
    """Name the constraints that hold the estimate: links at the margin, parameters at their lower bound."""
    held: list[str] = []
    for number, columns in enumerate(link_columns(model), start=1):
        weights = congruence(prior, columns)
        body = pseudo_inertia(standard[list(columns)]) * np.outer(weights, weights)
        if np.linalg.eigvalsh(body)[0] < 3.0 * bounds.margin + 1e-7:
            held.append(f"pseudo_inertia_{number}")
    lower = lower_bounds(model)
    at_bound = (standard - lower) / prior.scale < 1e-5
    return (*held, *(model.parameters[column].name for column in np.flatnonzero(at_bound)))
