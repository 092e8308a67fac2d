"""State the programme in cvxpy.

The readable formulation, which is also the reference that the hot path is held against.
"""

import warnings

import cvxpy
import numpy as np

from ..robot.inertia import PSEUDO_INERTIA_BASIS, pseudo_inertia
from .constraints import CentreBox, congruence, link_columns, lower_bounds
from .plausibility import LinkBound, density_unit, link_bounds
from .programme import Programme, Solution, refusal

_KINDS = {
    cvxpy.OPTIMAL_INACCURATE: "inaccurate",
    cvxpy.INFEASIBLE: "infeasible",
    cvxpy.INFEASIBLE_INACCURATE: "infeasible",
    cvxpy.UNBOUNDED: "unbounded",
    cvxpy.UNBOUNDED_INACCURATE: "unbounded",
}


def solve_with_cvxpy(programme: Programme) -> Solution:
    """Solve the programme; needed for the entropic prior, whose logarithms the hot path does not state.

    Raises
    ------
    SolverError
        If cvxpy does not report ``optimal``.
    """
    scale = programme.prior.scale
    phi = cvxpy.Variable(len(scale))
    misfit, target = programme.scaled_rows
    objective = 0.5 * cvxpy.sum_squares(misfit @ phi - target)
    objective += 0.5 * programme.scaled_pull * cvxpy.sum_squares(phi - programme.prior.centre / scale)
    if programme.entropy > 0.0:
        objective += programme.entropy / programme.system.rows * _entropy(programme, phi)
    problem = cvxpy.Problem(cvxpy.Minimize(objective), _constraints(programme, phi))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # an inaccurate solution is refused below
            problem.solve(solver=cvxpy.CLARABEL, tol_gap_abs=1e-8, tol_gap_rel=1e-8, tol_feas=1e-8)
    except cvxpy.error.SolverError as error:
        raise refusal("stopped", status=str(error), solver="cvxpy", iterations=0) from None
    stats = problem.solver_stats
    iterations = int(stats.num_iters or 0) if stats is not None else 0
    if problem.status != cvxpy.OPTIMAL or phi.value is None:
        kind = _KINDS.get(problem.status, "stopped")
        raise refusal(kind, status=problem.status, solver="cvxpy", iterations=iterations)
    return Solution(np.asarray(phi.value) * scale, "optimal", iterations, "cvxpy", programme.bounds.margin)


def _constraints(programme: Programme, phi: cvxpy.Variable) -> list[cvxpy.Constraint]:
    scale, bounds, model = programme.prior.scale, programme.bounds, programme.base.model
    links = link_columns(model)
    lower = lower_bounds(model)
    signed = np.flatnonzero(np.isfinite(lower))
    constraints: list[cvxpy.Constraint] = (
        [phi[signed] >= lower[signed] / scale[signed]] if len(signed) else []
    )
    for asked in link_bounds(model, bounds, programme.prior):
        constraints += _of_body(programme, phi, asked)
    masses = [scale[columns[9]] * phi[columns[9]] for columns in links]
    for link, low, high in bounds.mass:
        constraints += [masses[link - 1] >= low, masses[link - 1] <= high]
    if bounds.total_mass is not None:
        constraints += [sum(masses) >= bounds.total_mass[0], sum(masses) <= bounds.total_mass[1]]
    for region in bounds.centres:
        first = list(links[region.link - 1][6:9])
        moment, mass = cvxpy.multiply(scale[first], phi[first]), masses[region.link - 1]
        if isinstance(region, CentreBox):
            constraints += [moment >= np.array(region.low) * mass, moment <= np.array(region.high) * mass]
        else:
            away = (moment - np.array(region.centre) * mass) / np.array(region.semi_axes)
            constraints.append(cvxpy.norm(away) <= mass)
    return constraints


def _of_body(programme: Programme, phi: cvxpy.Variable, link: LinkBound) -> list[cvxpy.Constraint]:
    """State that a body is consistent, lies in its link, and is not denser than metal."""
    scale, columns = programme.prior.scale, list(link.columns)
    weights = np.diag(congruence(programme.prior, link.columns))
    body, constraints = _pseudo_inertia(programme, phi, link.columns), list[cvxpy.Constraint]()
    if link.density_bounded:
        least = cvxpy.Variable()
        constraints.append(cvxpy.power(phi[columns[9]], 5 / 3) <= least)
        body = body - density_unit(programme.prior, link.columns) * least * np.diag([1.0, 1.0, 1.0, 0.0])
    constraints.append(weights @ body @ weights >> programme.bounds.margin * np.eye(4))
    if link.extent is not None:
        constraints.append((link.row * scale[columns] / scale[columns[0]]) @ phi[columns] >= 0.0)
    return constraints


def _pseudo_inertia(programme: Programme, phi: cvxpy.Variable, columns: tuple[int, ...]) -> cvxpy.Expression:
    parts = [
        programme.prior.scale[column] * phi[column] * PSEUDO_INERTIA_BASIS[k]
        for k, column in enumerate(columns)
    ]
    return sum(parts[1:], parts[0])


def _entropy(programme: Programme, phi: cvxpy.Variable) -> cvxpy.Expression:
    """Sum the links' divergence from the prior: trace(J J0^-1) - log det(J J0^-1) - 4, frame-independent.

    Links whose prior is not physically consistent (a frame without mass in a URDF) have none.
    """
    total = cvxpy.Constant(0.0)
    for columns in link_columns(programme.base.model):
        prior = pseudo_inertia(programme.prior.centre[list(columns)])
        weights = np.diag(congruence(programme.prior, columns))
        if np.linalg.eigvalsh(weights @ prior @ weights)[0] < 1e-9:
            continue
        body = weights @ _pseudo_inertia(programme, phi, columns) @ weights
        inverse = np.linalg.solve(weights @ prior @ weights, np.eye(4))
        total = (
            total + cvxpy.trace(inverse @ body) - cvxpy.log_det(body) - np.linalg.slogdet(inverse)[1] - 4.0
        )
    return total
