"""Estimate the parameters: one function for every estimator, one result for everything that follows.

The default is the semidefinite programme on equations weighted per joint. The unconstrained optimum of the
same equations is always reported beside it: the difference is the cost of the consistency constraint.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BaseParameters, Indices, Parameters
from ..errors import SolverError
from ..reduction.base import BaseModel
from .constraints import DEFAULT_MARGIN, LIGHT_MARGIN, Prior, check_links
from .options import EstimateOptions
from .plausibility import LinkBound, link_bounds
from .programme import Programme, Solution
from .system import System
from .with_clarabel import solve_with_clarabel

BOUND_COST = 1.02
"""Factor on the squared error, 1 % of the RMS error, from which bounds on sizes and densities are said to
contradict a log. On four measured arms they cost 1.0003 to 1.011."""
MARGIN_COST = 1.05
"""Cost of the consistency constraint over least squares, from which it is asked whether the margin is why.
About 1.01 is usual; a light tip that has to keep the margin costs 1.5 to 60 times."""


@dataclass(frozen=True)
class CostlyBound:
    """Hold a link whose bound on size or density contradicts the log."""

    bound: LinkBound
    ratio: float
    """Factor by which the squared error falls when this link's bound is removed, too."""


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
    costly: tuple[CostlyBound, ...] = ()
    """Links whose bound on size or density contradicts the log. Assumed bounds are removed, and
    declared ones kept."""

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
    solution, costly = _solve_with_large_links(programme, options.solver, system.cost(unconstrained))
    values = base.base_of(solution.standard)
    if essential is not None:
        values = np.where(np.isin(np.arange(len(values)), essential), values, 0.0)
    return Estimate(values, solution.standard, unconstrained, system, prior, solution, costly)


def _solve_with_large_links(
    programme: Programme, solver: str, least: float
) -> tuple[Solution, tuple[CostlyBound, ...]]:
    """Solve a programme; remove assumed bounds on bodies that contradict the log, and list their links.

    Declared bounds are kept, and listed as well. `least` is the cost of the unconstrained optimum.
    """
    solution = _solve_with_light_links(programme, solver, least)
    costly = costly_bounds(programme, solution, solver, least)
    declared = {size.link for size in programme.bounds.sizes}
    larger = tuple(each.bound.link for each in costly if each.bound.link not in declared)
    if not larger:
        return solution, costly
    without = replace(programme, bounds=replace(programme.bounds, exempt=larger))
    return _solve_with_light_links(without, solver, least), costly


def costly_bounds(
    programme: Programme, solution: Solution, solver: str, least: float
) -> tuple[CostlyBound, ...]:
    """List the links whose size and density contradict the log, the costliest first.

    The bounds of one link after the other are removed, until those that remain cost less than `BOUND_COST`.
    None is listed where a programme without them has no accurate optimum.
    """
    bounds, now = programme.bounds, programme.cost(solution)
    if now < BOUND_COST * least:
        return ()
    held = _exhausted(programme, solution)
    if not held:
        return ()

    freed = replace(programme, bounds=replace(bounds, margin=solution.margin))
    floor = _cost_without(held, freed, solver)
    found: list[CostlyBound] = []
    removed: list[LinkBound] = []
    while now >= BOUND_COST * floor and held:
        costs = [_cost_without([*removed, link], freed, solver) for link in held]
        least_cost = min(costs)
        if not np.isfinite(least_cost):
            break
        removed.append(held.pop(costs.index(least_cost)))
        found.append(CostlyBound(removed[-1], now / least_cost))
        now = least_cost
    return tuple(found)


def _exhausted(programme: Programme, solution: Solution) -> list[LinkBound]:
    """List the links whose bodies are at one of their bounds."""
    links = link_bounds(programme.base.model, programme.bounds, programme.prior)
    return [link for link in links if any(link.exhausted(solution.standard))]


def _cost_without(links: Sequence[LinkBound], programme: Programme, solver: str) -> float:
    """Give the least cost where some links are not bounded; infinity where no accurate optimum is found."""
    fewer = replace(programme.bounds, exempt=tuple(link.link for link in links))
    try:
        answer = solve(replace(programme, bounds=fewer), solver)
    except SolverError:
        return np.inf
    return max(programme.cost(answer), np.finfo(float).tiny)


def _solve_with_light_links(programme: Programme, solver: str, least: float) -> Solution:
    """Solve a programme; where the default margin itself raises the cost, solve it with a smaller one.

    Notes
    -----
    `least` is the cost of the unconstrained optimum. The margin is a share of an ordinary link. A point mass
    or a light tip has less, and keeping it above contradicts the log. Where every consistent
    robot contradicts the log, or with less of it no accurate optimum is found, the margin is kept.
    """
    solution = solve(programme, solver)
    cost = programme.cost(solution)
    if programme.bounds.margin != DEFAULT_MARGIN or cost <= MARGIN_COST * least:
        return solution
    lighter = replace(programme, bounds=replace(programme.bounds, margin=LIGHT_MARGIN))
    try:
        answer = solve(lighter, solver)
    except SolverError:
        return solution
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
