"""State the semidefinite programme once: what is minimised, over what, under which constraints.

    minimise    ||R G phi - z||^2 / (2 n)  +  pull ||(phi - prior) / scale||^2 / (2 n)
                +  entropy / n  sum_k d(J_k, J_k of the prior)
    subject to  D (J_k(phi) - t_k diag(1, 1, 1, 0)) D >= margin E,  t_k >= k m_k^(5/3)  for every link k,
                phi_i >= lower_i,  bounds on masses, mass centres, sizes and densities

phi are the standard parameters, G groups them into base parameters, R and z are the weighted factor of the
log with n rows. The size does not depend on the log's length. Sources: Sousa & Cortesao 2014; Wensing, Kim &
Slotine 2018; Lee, Wensing & Park 2020.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Matrix, Parameters, Vector
from ..errors import SolverError
from ..reduction.base import BaseModel
from .constraints import Bounds, Prior
from .options import PULL
from .system import System


@dataclass(frozen=True, eq=False)
class Programme:
    """Hold one semidefinite least-squares problem."""

    base: BaseModel
    """Grouping of the standard parameters and the robot."""
    system: System
    """The weighted equations over the base parameters."""
    prior: Prior
    bounds: Bounds
    """The prior of the standard parameters, and what is allowed."""
    pull: float = PULL
    """Weight of the squared distance to the prior."""
    entropy: float = 0.0
    """Weight of the entropic distance to the prior's bodies, 0 for none."""

    @property
    def scaled_pull(self) -> float:
        """Give the pull's weight beside the misfit per equation."""
        return self.pull / self.system.rows

    @property
    def scaled_rows(self) -> tuple[Matrix, Vector]:
        """Give misfit rows over phi / scale and their target, divided by the root of the number of rows."""
        size = np.sqrt(self.system.rows)
        return self.system.triangle @ self.base.grouping * self.prior.scale / size, self.system.target / size

    def cost(self, solution: "Solution") -> float:
        """Give the weighted sum of squared residuals of a solution."""
        return self.system.cost(self.base.base_of(solution.standard))


@dataclass(frozen=True, eq=False)
class Solution:
    """Hold an optimum."""

    standard: Parameters
    """The optimal standard parameters."""
    status: str
    iterations: int
    """How the solver ended, and after how many iterations."""
    solver: str
    """Which solver said it."""
    margin: float
    """The least eigenvalue that every scaled pseudo-inertia was given."""


_REMEDY = "ask for the other solver (option solver), give a prior, or raise the pull towards the prior"
_MEANINGS = {
    "infeasible": (
        "no robot satisfies the bounds on masses, mass centres and sizes",
        "widen the bounds, lower the margin or declare bounds.size; check that units are kg and m",
    ),
    "unbounded": ("the optimum lies at infinity", "use a pull towards a prior greater than zero"),
    "inaccurate": ("the solver stopped before it reached its accuracy", _REMEDY),
    "stopped": ("the solver stopped without an optimum", _REMEDY),
}


def refusal(kind: str, *, status: str, solver: str, iterations: int) -> SolverError:
    """Translate a solver's status into cause and remedy; everything but an optimum is refused."""
    cause, remedy = _MEANINGS[kind]
    return SolverError(
        cause, evidence={"status": status, "solver": solver, "iterations": iterations}, remedy=remedy
    )
