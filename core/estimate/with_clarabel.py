"""Give the programme to Clarabel directly, in residual form: the hot path.

Variables are x = (phi / scale, r) with r = R G phi - z as equalities, so that the objective is diagonal and
the factor is never squared. Where rounding stops the solver, each parameter is measured by how far it moves
the objective instead: beside a light tip the columns of that factor differ by eight decades. Cones are
written as s = b - A x in the cone, triangles of matrices column by column with off-diagonals times sqrt(2).
Source: Goulart & Chen, Clarabel, 2024.
"""

from dataclasses import dataclass, field
from typing import Any

import clarabel
import numpy as np
from scipy import sparse

from ..arrays import Matrix, Vector
from ..robot.inertia import PSEUDO_INERTIA_BASIS
from .constraints import CentreBox, Prior, congruence, link_columns, lower_bounds
from .plausibility import LinkBound, density_unit, link_bounds
from .programme import Programme, Solution, refusal

_UPPER = np.triu_indices(4)
_BY_COLUMN = np.lexsort((_UPPER[0], _UPPER[1]))
_ROW, _COLUMN = _UPPER[0][_BY_COLUMN], _UPPER[1][_BY_COLUMN]
_ROOT = np.where(_ROW == _COLUMN, 1.0, np.sqrt(2.0))
AUXILIARY = 5
"""Variables by which the density bound of one link is stated."""
SVEC_IDENTITY = np.where(_ROW == _COLUMN, 1.0, 0.0)
"""The 4x4 identity in the solver's triangle order."""
_FINE, _COARSE = 1e-9, 1e-7
"""Gaps and residuals asked for, the second where rounding stops the solver before the first. Both are
relative to an objective near one half, so either is far below what noise does to it."""
_BOLD, _CAREFUL = 0.99, 0.9
"""Largest share of the way to a cone's edge that a step goes; shorter ones are rounded less."""
_ATTEMPTS = (
    (False, _FINE, _BOLD),
    (False, _COARSE, _CAREFUL),
    (True, _FINE, _BOLD),
    (True, _COARSE, _CAREFUL),
)
"""Statements tried until one is solved: whether columns are normalised, accuracy, largest step."""
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


@dataclass
class Cones:
    """Collect rows of A x + s = b, cone by cone."""

    width: int
    """Number of variables."""
    rows: list[Matrix] = field(default_factory=list)
    right: list[Vector] = field(default_factory=list)
    kinds: list[object] = field(default_factory=list)
    links: list[Matrix] = field(default_factory=list)
    """The rows of the links' pseudo-inertias."""

    def add(self, kind: object, rows: Matrix, right: Vector) -> None:
        """Add a cone; variables that its rows do not reach have no share in it."""
        wide = np.zeros((len(rows), self.width))
        wide[:, : rows.shape[1]] = rows
        self.rows.append(wide)
        self.right.append(right)
        self.kinds.append(kind)


def solve_with_clarabel(programme: Programme, *, coarse: bool = False) -> Solution:
    """Solve the programme; coarsely where many are compared, and one that is hard to solve is no loss.

    Raises
    ------
    SolverError
        If Clarabel does not report an optimum to full accuracy.
    """
    misfit, target = programme.scaled_rows
    equations, parameters = misfit.shape
    links = link_bounds(programme.base.model, programme.bounds, programme.prior)
    dense = AUXILIARY * len(links)
    cones = Cones(parameters + equations + dense)
    cones.add(clarabel.ZeroConeT(equations), np.hstack([misfit, -np.eye(equations)]), target)
    add_links(cones, programme.prior, links, parameters + equations, programme.bounds.margin)
    _add_signs(cones, programme)
    _add_masses(cones, programme)
    _add_centres(cones, programme)
    pull = np.full(parameters, programme.scaled_pull)
    quadratic = np.concatenate([pull, np.ones(equations), np.zeros(dense)])
    pulled = -pull * programme.prior.centre / programme.prior.scale
    linear = np.concatenate([pulled, np.zeros(equations + dense)])
    norms = np.append(np.sqrt((misfit**2).sum(axis=0) + pull), np.ones(equations + dense))
    answer, unit = _first_solved(cones, quadratic, linear, norms, coarse=coarse)
    status = str(answer.status)
    if status != "Solved":
        raise refusal(
            _KINDS.get(status, "stopped"), status=status, solver="clarabel", iterations=int(answer.iterations)
        )
    standard = (np.array(answer.x) * unit)[:parameters] * programme.prior.scale
    return Solution(standard, "optimal", int(answer.iterations), "clarabel", programme.bounds.margin)


def _first_solved(
    cones: Cones, quadratic: Vector, linear: Vector, norms: Vector, *, coarse: bool
) -> tuple[Any, Vector]:
    """Try one statement after the other; give the last answer and the units of its variables."""
    rows, right = np.vstack(cones.rows), np.concatenate(cones.right)
    *attempts, last = _COARSE_ATTEMPTS if coarse else _ATTEMPTS
    patience = _COARSE_PATIENCE if coarse else _PATIENCE

    def attempt(normalised: bool, tolerance: float, step: float) -> tuple[Any, Vector]:  # noqa: FBT001  (a row of a table)
        unit = 1.0 / norms if normalised else np.ones(len(norms))
        solver = clarabel.DefaultSolver(
            sparse.diags(quadratic * unit**2, format="csc"),
            linear * unit,
            sparse.csc_matrix(rows * unit),
            right,
            cones.kinds,
            _settings(tolerance, step, patience),
        )
        return solver.solve(), unit

    for statement in attempts:
        answer, unit = attempt(*statement)
        if str(answer.status) not in _SHORT_OF_ACCURACY:
            return answer, unit
    return attempt(*last)


def _settings(tolerance: float, step: float, patience: int) -> object:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    settings.max_step_fraction = step
    settings.max_iter = patience
    settings.max_threads = 1
    return settings


def add_links(
    cones: Cones, prior: Prior, links: tuple[LinkBound, ...], first: int, margin: float = 0.0
) -> None:
    """Add what is asked of the bodies; the variables of the density bounds stand from `first` on."""
    for place, link in enumerate(links):
        columns, weights = list(link.columns), congruence(prior, link.columns)
        rows = np.zeros((10, cones.width))
        rows[:, columns] = -svec_rows(weights) * prior.scale[columns]
        if link.density_bounded:
            rows[:, first + AUXILIARY * place] = density_column(prior, link.columns)
            _add_power(cones, first + AUXILIARY * place, columns[9])
        cones.add(clarabel.PSDTriangleConeT(4), rows, -margin * SVEC_IDENTITY)
        cones.links.append(cones.rows[-1])
        if link.extent is not None:
            size = np.zeros((1, cones.width))
            size[0, columns] = -link.row * prior.scale[columns] / prior.scale[columns[0]]
            cones.add(clarabel.NonnegativeConeT(1), size, np.zeros(1))


def _add_power(cones: Cones, first: int, mass: int) -> None:
    """Add u >= m^(5/3), u the variable `first`: m is at most the geometric mean of u u u 1 1 m m m.

    It is taken pair by pair, with a^2 <= u, b^2 <= m, c^2 <= u a, d^2 <= b m and m^2 <= c d.
    """
    u, a, b, c, d = range(first, first + AUXILIARY)
    for root, left, right in ((a, u, None), (b, mass, None), (c, u, a), (d, b, mass), (mass, c, d)):
        rows, constant = np.zeros((3, cones.width)), np.zeros(3)
        rows[0, left] = rows[2, left] = -1.0
        rows[1, root] = -2.0
        if right is None:
            constant[[0, 2]] = 1.0, -1.0
        else:
            rows[0, right], rows[2, right] = -1.0, 1.0
        cones.add(clarabel.SecondOrderConeT(3), rows, constant)


def density_column(prior: Prior, columns: tuple[int, ...]) -> Vector:
    """Write D diag(1, 1, 1, 0) D in the solver's triangle order, in the unit of the density bound."""
    weights, spatial = congruence(prior, columns), np.where((_ROW == _COLUMN) & (_ROW < 3), 1.0, 0.0)
    return np.asarray(density_unit(prior, columns) * weights[_ROW] ** 2 * spatial)


def svec_rows(weights: Vector) -> Matrix:
    """Write D J D in the solver's triangle order as rows over a link's ten parameters, D = diag(weights)."""
    return np.asarray((PSEUDO_INERTIA_BASIS[:, _ROW, _COLUMN] * (weights[_ROW] * weights[_COLUMN] * _ROOT)).T)


def _add_signs(cones: Cones, programme: Programme) -> None:
    lower = lower_bounds(programme.base.model)
    bounded = np.flatnonzero(np.isfinite(lower))
    if len(bounded):
        rows = -np.eye(len(lower))[bounded]
        cones.add(
            clarabel.NonnegativeConeT(len(bounded)), rows, -lower[bounded] / programme.prior.scale[bounded]
        )


def _add_masses(cones: Cones, programme: Programme) -> None:
    scale, links = programme.prior.scale, link_columns(programme.base.model)
    ranges = [([links[link - 1][9]], low, high) for link, low, high in programme.bounds.mass]
    if programme.bounds.total_mass is not None:
        ranges.append(([columns[9] for columns in links], *programme.bounds.total_mass))
    for masses, low, high in ranges:
        sums = np.zeros(len(scale))
        sums[masses] = scale[masses]
        unit = scale[masses[0]]
        rows, right = np.array([-sums, sums]) / unit, np.array([-low, high]) / unit
        finite = np.isfinite(right)
        cones.add(clarabel.NonnegativeConeT(int(finite.sum())), rows[finite], right[finite])


def _add_centres(cones: Cones, programme: Programme) -> None:
    scale, links = programme.prior.scale, link_columns(programme.base.model)
    for region in programme.bounds.centres:
        first, mass = np.array(links[region.link - 1][6:9]), links[region.link - 1][9]
        unit = scale[first[0]]
        picked = np.zeros((3, len(scale)))
        picked[range(3), first] = scale[first] / unit
        weight = np.zeros(len(scale))
        weight[mass] = scale[mass] / unit
        if isinstance(region, CentreBox):
            low, high = np.outer(region.low, weight), np.outer(region.high, weight)
            cones.add(clarabel.NonnegativeConeT(6), np.vstack([low - picked, picked - high]), np.zeros(6))
        else:
            offset = (picked - np.outer(region.centre, weight)) / np.array(region.semi_axes)[:, None]
            cones.add(clarabel.SecondOrderConeT(4), -np.vstack([weight, offset]), np.zeros(4))
