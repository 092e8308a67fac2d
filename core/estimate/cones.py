"""Write what is asked of bodies and parameters as rows of cones, s = b - A x in the cone, for a solver.

Triangles of matrices are column by column, with off-diagonals times sqrt(2). Source: Goulart & Chen,
Clarabel, 2024.
"""

from dataclasses import dataclass, field
from functools import lru_cache

import clarabel
import numpy as np
from scipy import sparse

from ..arrays import Matrix, Vector
from ..dynamics.model import DynamicModel
from ..robot.inertia import PSEUDO_INERTIA_BASIS
from .constraints import Bounds, CentreBox, Prior, congruence, link_columns, lower_bounds
from .plausibility import LinkBound, density_unit, link_bounds

_UPPER = np.triu_indices(4)
_BY_COLUMN = np.lexsort((_UPPER[0], _UPPER[1]))
_ROW, _COLUMN = _UPPER[0][_BY_COLUMN], _UPPER[1][_BY_COLUMN]
_ROOT = np.where(_ROW == _COLUMN, 1.0, np.sqrt(2.0))
AUXILIARY = 3
"""Variables by which the density bound of one link is stated."""
SVEC_IDENTITY = np.where(_ROW == _COLUMN, 1.0, 0.0)
"""The 4x4 identity in the solver's triangle order."""
_KEPT = 4
"""Sets of constraints that are kept: a bootstrap solves hundreds of programmes under one."""


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


@dataclass(frozen=True, eq=False)
class ConstraintRows:
    """Hold what is asked of the variables (phi / scale, auxiliary)."""

    entries: sparse.coo_matrix
    """Rows of A that are not zero, m x variables."""
    right: Vector
    kinds: tuple[object, ...]


@lru_cache(maxsize=_KEPT)
def constraint_rows(model: DynamicModel, prior: Prior, bounds: Bounds) -> ConstraintRows:
    """State the constraints of a programme; they do not depend on the log."""
    links, parameters = link_bounds(model, bounds, prior), len(prior.scale)
    cones = Cones(parameters + AUXILIARY * len(links))
    add_links(cones, prior, links, parameters, bounds.margin)
    _add_signs(cones, model, prior)
    _add_masses(cones, model, prior, bounds)
    _add_centres(cones, model, prior, bounds)
    rows = np.vstack([np.zeros((0, cones.width)), *cones.rows])
    return ConstraintRows(
        sparse.coo_matrix(rows), np.concatenate([np.zeros(0), *cones.right]), tuple(cones.kinds)
    )


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
            add_power(cones, first + AUXILIARY * place, columns[9])
        cones.add(clarabel.PSDTriangleConeT(4), rows, -margin * SVEC_IDENTITY)
        cones.links.append(cones.rows[-1])
        if link.extent is not None:
            size = np.zeros((1, cones.width))
            size[0, columns] = -link.row * prior.scale[columns] / prior.scale[columns[0]]
            cones.add(clarabel.NonnegativeConeT(1), size, np.zeros(1))


def add_power(cones: Cones, first: int, mass: int) -> None:
    """Add u >= m^(5/3), u the variable `first`, by m^2 <= a b, a^2 <= m u and b^2 <= a.

    Of logarithms these are 2 m <= a + b, 2 a <= m + u, 2 b <= a: so 2 m <= 3 (m + u) / 4, and 5 m / 3 <= u.
    """
    u, a, b = range(first, first + AUXILIARY)
    for root, left, right in ((mass, a, b), (a, mass, u), (b, a, None)):
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


def _add_signs(cones: Cones, model: DynamicModel, prior: Prior) -> None:
    lower = lower_bounds(model)
    bounded = np.flatnonzero(np.isfinite(lower))
    if len(bounded):
        rows = -np.eye(len(lower))[bounded]
        cones.add(clarabel.NonnegativeConeT(len(bounded)), rows, -lower[bounded] / prior.scale[bounded])


def _add_masses(cones: Cones, model: DynamicModel, prior: Prior, bounds: Bounds) -> None:
    scale, links = prior.scale, link_columns(model)
    ranges = [([links[link - 1][9]], low, high) for link, low, high in bounds.mass]
    if bounds.total_mass is not None:
        ranges.append(([columns[9] for columns in links], *bounds.total_mass))
    for masses, low, high in ranges:
        sums = np.zeros(len(scale))
        sums[masses] = scale[masses]
        unit = scale[masses[0]]
        rows, right = np.array([-sums, sums]) / unit, np.array([-low, high]) / unit
        finite = np.isfinite(right)
        cones.add(clarabel.NonnegativeConeT(int(finite.sum())), rows[finite], right[finite])


def _add_centres(cones: Cones, model: DynamicModel, prior: Prior, bounds: Bounds) -> None:
    scale, links = prior.scale, link_columns(model)
    for region in bounds.centres:
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
