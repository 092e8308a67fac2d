"""Estimate the parameters: one function for every estimator, one result for everything that follows.

The default is the semidefinite programme on equations weighted per joint. The unconstrained optimum of the
same equations is always reported beside it: the difference is the cost of the consistency constraint.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BaseParameters, Indices, Parameters
from ..reduction.base import BaseModel
from .constraints import DEFAULT_MARGIN, LIGHT_MARGIN, Prior, check_links
from .options import EstimateOptions
from .programme import Programme, Solution
from .system import System
from .with_clarabel import solve_with_clarabel

DEAR = 1.05
"""Cost of the consistency constraint over least squares, from which it is asked whether the margin is why.
About 1.01 is usual; a light tip that has to keep the margin costs 1.5 to 60 times."""


@dataclass(frozen=True, eq=False)
class Estimate:
    """Hold an estimate."""

    base: BaseParameters
    """Base parameters."""
    standard: Parameters
    """A robot with these base parameters: of the many, the feasible one nearest the prior (`sdp`), or just
    the nearest."""
    unconstrained: BaseParameters
    """The optimum of the same equations without constraints."""
    system: System
    prior: Prior
    solution: Solution | None
    """What the solver said; None where none was needed."""

    @property
    def objective(self) -> float:
        """Give the weighted sum of squared residuals."""
        return self.system.cost(self.base)

    @property
    def objective_unconstrained(self) -> float:
        """Give the same at the unconstrained optimum: a lower bound."""
        return self.system.cost(self.unconstrained)

    @property
    def cost_ratio(self) -> float:
        """Give the factor by which the constraints raise the weighted sum of squares."""
        return self.objective / max(self.objective_unconstrained, np.finfo(float).tiny)


def estimate(
    base: BaseModel,
    system: System,
    prior: Prior,
    options: EstimateOptions,
    *,
    essential: Indices | None = None,
) -> Estimate:
    """Estimate base and standard parameters from weighted equations.

    Parameters
    ----------
    essential
        Positions of the base parameters that may explain torque; the others are left to the prior and do not
        count.

    Raises
    ------
    OptionError
        If a bound names a link that the model does not have.
    SolverError
        If the programme has no accurate optimum.
    """
    check_links(options.bounds, base.model)
    if essential is not None:
        system = _restrict(system, essential)
    unconstrained = system.solved()
    if not options.method.feasible:
        return Estimate(
            unconstrained, nearest(base, unconstrained, prior), unconstrained, system, prior, None
        )
    programme = Programme(base, system, prior, options.bounds, options.pull, options.entropy)
    solution = _solve_with_light_links(programme, options.solver, system.cost(unconstrained))
    values = base.base_of(solution.standard)
    if essential is not None:
        values = np.where(np.isin(np.arange(len(values)), essential), values, 0.0)
    return Estimate(values, solution.standard, unconstrained, system, prior, solution)


def _solve_with_light_links(programme: Programme, solver: str, least: float) -> Solution:
    """Solve a programme; where the default margin itself is what costs, solve it with a lighter one.

    Parameters
    ----------
    least
        The cost of the unconstrained optimum.

    Notes
    -----
    The margin is a share of an ordinary link. A point mass or a light tip has less, and keeping it above
    contradicts the log. A contradiction of the log with every consistent robot stays, and keeps the margin.
    """
    solution = solve(programme, solver)
    cost = programme.cost(solution)
    if programme.bounds.margin != DEFAULT_MARGIN or cost <= DEAR * least:
        return solution
    lighter = replace(programme, bounds=replace(programme.bounds, margin=LIGHT_MARGIN))
    answer = solve(lighter, solver)
    return answer if cost - programme.cost(answer) > 0.5 * (cost - least) else solution


def solve(programme: Programme, solver: str) -> Solution:
    """Solve a programme with the named solver."""
    if solver == "clarabel":
        return solve_with_clarabel(programme)
    from .with_cvxpy import solve_with_cvxpy  # takes as long to load as all the rest together

    return solve_with_cvxpy(programme)


def _restrict(system: System, kept: Indices) -> System:
    triangle = np.zeros_like(system.triangle)
    triangle[:, kept] = system.triangle[:, kept]
    return replace(system, triangle=triangle)


def nearest(base: BaseModel, values: BaseParameters, prior: Prior) -> Parameters:
    """Give the standard parameters nearest a prior that group into these base parameters."""
    scaled = base.grouping * prior.scale
    step, *_ = np.linalg.lstsq(scaled, values - base.base_of(prior.centre), rcond=1e-12)
    return np.asarray(prior.centre + prior.scale * step)
