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
from .cones import AUXILIARY, SVEC_IDENTITY, Cones, add_links
from .constraints import Bounds, Prior, congruence, link_columns, lower_bounds
from .plausibility import link_bounds

_CAP = 1.0


@dataclass(frozen=True)
class Feasibility:
    """Tell whether a physically consistent robot exists.

    `margin` is the largest least scaled eigenvalue (or signed parameter) any choice reaches. Both are None
    where the programme has no accurate optimum, as for values that a motion leaves open to any size.
    """

    feasible: bool | None
    margin: float | None


def feasibility(
    base: BaseModel, values: BaseParameters, prior: Prior, bounds: Bounds | None = None
) -> Feasibility:
    """Maximise the margin t over all standard parameters that group into the given base parameters.

    Parameters
    ----------
    bounds
        Sizes and densities to keep to; None where consistent bodies of any size will do.
    """
    model, scale = base.model, prior.scale
    size = len(scale)
    links = link_bounds(model, bounds or Bounds(plausible=False), prior)
    own = np.linalg.norm(base.grouping * scale, axis=1)
    cones = Cones(size + AUXILIARY * len(links) + 1)
    cones.add(clarabel.ZeroConeT(len(own)), base.grouping * scale / own[:, None], values / own)
    add_links(cones, prior, links, size)
    for link in cones.links:
        link[:, -1] = SVEC_IDENTITY
    lower = lower_bounds(model)
    bounded = np.flatnonzero(np.isfinite(lower))
    signs = np.zeros((len(bounded) + 1, cones.width))
    signs[:-1, :size], signs[:, -1] = -np.eye(size)[bounded], 1.0
    right = np.append(-lower[bounded] / scale[bounded], _CAP)
    cones.add(clarabel.NonnegativeConeT(len(right)), signs, right)
    return _maximise(cones, size)


def _maximise(cones: Cones, size: int) -> Feasibility:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    linear = np.append(np.zeros(cones.width - 1), -1.0)
    quadratic = np.zeros(cones.width)
    quadratic[:size] = 1e-9
    answer = clarabel.DefaultSolver(
        sparse.diags(quadratic, format="csc"),
        linear,
        sparse.csc_matrix(np.vstack(cones.rows)),
        np.concatenate(cones.right),
        cones.kinds,
        settings,
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
    for link in link_bounds(model, bounds, prior):
        held += link.exhausted(standard)
    lower = lower_bounds(model)
    at_bound = (standard - lower) / prior.scale < 1e-5
    return (*held, *(model.parameters[column].name for column in np.flatnonzero(at_bound)))
