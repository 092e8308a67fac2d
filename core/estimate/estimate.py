"""Estimate the parameters: one function for every estimator, one result for everything that follows.

The default is the semidefinite programme on equations weighted per joint; the unconstrained optimum of the
same equations is always reported beside it, because the difference is the price of feasibility.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from core.arrays import BaseParameters, Indices, Parameters
from core.errors import OptionError
from core.estimate.constraints import Bounds, Prior, check_links
from core.estimate.programme import PULL, Programme, Solution
from core.estimate.system import System
from core.estimate.with_clarabel import solve_with_clarabel
from core.reduction.base import BaseModel

ESTIMATORS = ("sdp", "ols", "wls", "irls")
SOLVERS = ("clarabel", "cvxpy")


@dataclass(frozen=True)
class EstimateOptions:
    """Choose how to estimate.

    Attributes
    ----------
    estimator
        ``sdp`` feasible and weighted; ``ols`` plain; ``wls`` weighted per joint; ``irls`` weighted per joint
        and row (Huber).
    solver
        ``clarabel`` called directly, or ``cvxpy``.
    robust
        Weigh rows with Huber's function under the semidefinite programme too.
    pull, entropy
        Weights of the squared and of the entropic distance to the prior.
    """

    estimator: str = "sdp"
    solver: str = "clarabel"
    robust: bool = False
    pull: float = PULL
    entropy: float = 0.0
    bounds: Bounds = field(default_factory=Bounds)

    def __post_init__(self) -> None:
        """Refuse unknown names and impossible weights."""
        if self.estimator not in ESTIMATORS or self.solver not in SOLVERS:
            raise OptionError(
                "the estimator or solver is not known",
                evidence={
                    "estimator": self.estimator,
                    "known": list(ESTIMATORS),
                    "solver": self.solver,
                    "solvers": list(SOLVERS),
                },
                remedy="choose one of the known names",
            )
        without_effect = [
            name
            for name, asked in (("bounds", self.bounds != Bounds()), ("entropy", self.entropy > 0.0))
            if asked and self.estimator != "sdp"
        ] + (["robust"] if self.robust and self.estimator == "ols" else [])
        if without_effect:
            raise OptionError(
                f"{' and '.join(without_effect)} would have no effect on this estimator",
                evidence={"estimator": self.estimator, "without_effect": without_effect},
                remedy="ask for estimator sdp, or leave these options out",
            )
        if not 0.0 < self.pull <= 1e6 or not 0.0 <= self.entropy <= 1e6:
            raise OptionError(
                "the weights of the prior make no sense",
                evidence={"pull": self.pull, "entropy": self.entropy},
                remedy="give a pull above 0 and up to 1e6, and an entropy from 0 to 1e6",
            )
        if self.entropy > 0.0 and self.solver != "cvxpy":
            raise OptionError(
                "the entropic prior is stated in cvxpy only",
                evidence={"entropy": self.entropy, "solver": self.solver},
                remedy="ask for solver cvxpy together with entropy",
            )


@dataclass(frozen=True, eq=False)
class Estimate:
    """Hold an estimate.

    Attributes
    ----------
    base
        Base parameters.
    standard
        A robot with these base parameters: of the many, the feasible one nearest the prior (`sdp`), or just
        the nearest.
    unconstrained
        The optimum of the same equations without constraints.
    solution
        What the solver said; None where none was needed.
    """

    base: BaseParameters
    standard: Parameters
    unconstrained: BaseParameters
    system: System
    prior: Prior
    solution: Solution | None

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
        system = _restricted(system, essential)
    unconstrained = system.solved()
    if options.estimator != "sdp":
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
    from core.estimate.with_cvxpy import solve_with_cvxpy  # takes as long to load as all the rest together

    return solve_with_cvxpy(programme)


def _restricted(system: System, kept: Indices) -> System:
    triangle = np.zeros_like(system.triangle)
    triangle[:, kept] = system.triangle[:, kept]
    return replace(system, triangle=triangle)


def nearest(base: BaseModel, values: BaseParameters, prior: Prior) -> Parameters:
    """Give the standard parameters nearest a prior that group into these base parameters."""
    scaled = base.grouping * prior.scale
    step, *_ = np.linalg.lstsq(scaled, values - base.base_of(prior.centre), rcond=1e-12)
    return np.asarray(prior.centre + prior.scale * step)
