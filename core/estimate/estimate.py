"""Estimate the parameters: one function for every estimator, one result for everything that follows.

The default is the semidefinite programme on equations weighted per joint. The unconstrained optimum of the
same equations is always reported beside it: the difference is the cost of the consistency constraint.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BaseParameters, Indices, Parameters
from ..reduction.base import BaseModel
from .constraints import Prior, check_links
from .options import EstimateOptions
from .programme import Programme, Solution
from .system import System
from .with_clarabel import solve_with_clarabel


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
    solution = solve(
        Programme(base, system, prior, options.bounds, options.pull, options.entropy), options.solver
    )
    values = base.base_of(solution.standard)
    if essential is not None:
        values = np.where(np.isin(np.arange(len(values)), essential), values, 0.0)
    return Estimate(values, solution.standard, unconstrained, system, prior, solution)


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
