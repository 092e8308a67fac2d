"""Give the programme to Clarabel directly, in residual form: the hot path.

Variables are x = (phi / scale, auxiliary, r) with r = R G phi - z as equalities, so that the objective is
diagonal and the factor is never squared. Where rounding stops the solver, each parameter is measured by how
far it moves the objective instead: beside a light tip the columns of that factor differ by eight decades.
Source: Goulart & Chen, Clarabel, 2024.
"""

from dataclasses import dataclass
from typing import Any

import clarabel
import numpy as np
from scipy import sparse

from ..arrays import Vector
from .cones import ConstraintRows, constraint_rows
from .programme import Programme, Solution, refusal

_FINE, _COARSE = 1e-9, 1e-7
"""Gaps and residuals asked for, the second where rounding stops the solver before the first. Both are
relative to an objective near one half, so either is far below what noise does to it."""
_REFINED = 0.1 * _FINE
"""Residual to which every step's linear equations are solved, relative and absolute: below what is asked for.
Clarabel's own value, 1e-13, costs a quarter of the time and changes no answer."""
_BOLD, _CAREFUL = 0.99, 0.9
"""Largest share of the way to a cone's edge that a step goes; shorter ones are rounded less."""
_ATTEMPTS = (
    (False, _FINE, _BOLD),
    (False, _COARSE, _CAREFUL),
    (True, _FINE, _BOLD),
    (True, _COARSE, _CAREFUL),
)
"""Ways tried until one succeeds: whether columns are normalised, accuracy, largest step."""
_COARSE_ATTEMPTS = ((True, _COARSE, _BOLD), (True, _COARSE, _CAREFUL))
"""The same where many programmes are compared."""
_PATIENCE, _COARSE_PATIENCE = 200, 60
"""Iterations after which an attempt is given up, in the second case too: normalised programmes of measured
arms took at most 36."""
_SHORT_OF_ACCURACY = ("AlmostSolved", "InsufficientProgress", "NumericalError", "MaxIterations")
_KINDS = {
    "PrimalInfeasible": "infeasible",
    "AlmostPrimalInfeasible": "infeasible",
    "DualInfeasible": "unbounded",
    "AlmostDualInfeasible": "unbounded",
    "AlmostSolved": "inaccurate",
    "InsufficientProgress": "inaccurate",
}


def solve_with_clarabel(programme: Programme, *, coarse: bool = False) -> Solution:
    """Solve the programme; coarsely where many are compared, and one that is hard to solve is no loss.

    Raises
    ------
    SolverError
        If Clarabel does not report an optimum to full accuracy.
    """
    cones = constraint_rows(programme.base.model, programme.prior, programme.bounds)
    statement = _state(programme, cones)
    answer, unit = _first_solved(statement, coarse=coarse)
    status = str(answer.status)
    if status != "Solved":
        raise refusal(
            _KINDS.get(status, "stopped"), status=status, solver="clarabel", iterations=int(answer.iterations)
        )
    scale = programme.prior.scale
    standard = (np.array(answer.x) * unit)[: len(scale)] * scale
    return Solution(standard, "optimal", int(answer.iterations), "clarabel", programme.bounds.margin)


@dataclass(frozen=True, eq=False)
class _Statement:
    """Hold a programme as the solver takes it, and the norm of every variable's column of the misfit."""

    rows: sparse.csc_matrix
    right: np.ndarray
    kinds: list[object]
    quadratic: Vector
    linear: Vector
    norms: Vector


def _state(programme: Programme, cones: ConstraintRows) -> _Statement:
    """Put the misfit's equations above the constraints."""
    misfit, target = programme.scaled_rows
    (equations, parameters), constrained = misfit.shape, cones.entries.shape[1]
    row, column = np.nonzero(misfit)
    own, asked = np.arange(equations), cones.entries
    values = np.concatenate([misfit[row, column], asked.data, np.full(equations, -1.0)])
    places = (
        np.concatenate([row, asked.row + equations, own]),
        np.concatenate([column, asked.col, own + constrained]),
    )
    pull = np.full(parameters, programme.scaled_pull)
    others = np.zeros(constrained - parameters)
    pulled = -pull * programme.prior.centre / programme.prior.scale
    return _Statement(
        sparse.csc_matrix((values, places), (equations + asked.shape[0], constrained + equations)),
        np.concatenate([target, cones.right]),
        [clarabel.ZeroConeT(equations), *cones.kinds],
        np.concatenate([pull, others, np.ones(equations)]),
        np.concatenate([pulled, others, np.zeros(equations)]),
        np.concatenate([np.sqrt((misfit**2).sum(axis=0) + pull), others + 1.0, np.ones(equations)]),
    )


def _first_solved(statement: _Statement, *, coarse: bool) -> tuple[Any, Vector]:
    """Try one way after the other; give the last answer and the units of its variables."""
    *attempts, last = _COARSE_ATTEMPTS if coarse else _ATTEMPTS
    patience = _COARSE_PATIENCE if coarse else _PATIENCE

    def attempt(normalised: bool, tolerance: float, step: float) -> tuple[Any, Vector]:  # noqa: FBT001  (a row of a table)
        unit = 1.0 / statement.norms if normalised else np.ones(len(statement.norms))
        solver = clarabel.DefaultSolver(
            sparse.diags(statement.quadratic * unit**2, format="csc"),
            statement.linear * unit,
            statement.rows @ sparse.diags(unit, format="csc") if normalised else statement.rows,
            statement.right,
            statement.kinds,
            _settings(tolerance, step, patience),
        )
        return solver.solve(), unit

    for way in attempts:
        answer, unit = attempt(*way)
        if str(answer.status) not in _SHORT_OF_ACCURACY:
            return answer, unit
    return attempt(*last)


def _settings(tolerance: float, step: float, patience: int) -> object:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    settings.iterative_refinement_reltol = settings.iterative_refinement_abstol = _REFINED
    settings.max_step_fraction = step
    settings.max_iter = patience
    settings.max_threads = 1
    return settings
