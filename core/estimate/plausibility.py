"""State which bodies are plausible: none larger than its link, none denser than metal.

Size: all mass within a ball of centre c and radius r makes the mean square distance from c at most r^2, which
is tr(J E) >= 0 with E = -[[1, -c], [-c', c'c - r^2]]: linear in the parameters, and it holds the mass centre
inside too. Density: a ball of mass m is not smaller than a^3 = 3 m / (4 pi rho), with second moments m a^2/5
per axis; the second moments about the mass centre of a body whose equal ellipsoid has no half axis below a
are at least that. By the Schur complement this is J - t diag(1, 1, 1, 0) >= 0 with t >= k m^(5/3), which is
convex. Sources: Wensing, Kim & Slotine 2018; Boyd & Vandenberghe 2004, A.5.5.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Parameters, Vector
from ..dynamics.model import DynamicModel
from ..robot.extent import Extent, distance_square, link_extents
from ..robot.inertia import PSEUDO_INERTIA_BASIS, pseudo_inertia
from ..robot.model import Ball, RobotModel
from .constraints import Bounds, Prior, link_columns

DENSEST = 20_000.0
"""Density above which no link is, kg/m3: tungsten has 19,300, steel 7,850. Links are hollow, and 1,000 to
4,000 as ellipsoids; a tenth of this would exclude solid ones, ten times allows half axes of 4 mm."""
SMALLEST = 0.2 * (3.0 / (4.0 * np.pi * DENSEST)) ** (2.0 / 3.0)
"""k in t >= k m^(5/3): the second moment per axis of a ball of that density, kg m2 for 1 kg."""
ORDINARY = 0.018
"""Second moment per axis of the nominal body over its mass and length squared: a ball of 0.3 lengths."""
AT_BOUND = 1e-3
"""Share of a bound on size within which it is active."""
AT_DENSITY = 0.1
"""The same of the least second moment that a density allows."""


@dataclass(frozen=True, eq=False)
class LinkBound:
    """Hold the bounds on one link's body."""

    link: int
    columns: tuple[int, ...]
    """Places of its ten parameters."""
    extent: Extent | None
    """The ball in which it lies; None where nothing is known."""
    density_bounded: bool
    """Whether its density is bounded by that of metals."""

    @property
    def row(self) -> Vector:
        """Give the ten coefficients whose sum with the parameters is not negative: tr(J E), kg m2."""
        if self.extent is None:
            return np.zeros(10)
        ball = self.extent.ball
        square = -distance_square(ball.centre)
        square[3, 3] += ball.radius**2
        return np.asarray(np.einsum("kij,ij->k", PSEUDO_INERTIA_BASIS, square))

    def exhausted(self, standard: Parameters) -> Iterator[str]:
        """Name the active bounds."""
        body = standard[list(self.columns)]
        mass = float(body[9])
        if self.extent is not None and self.row @ body < AT_BOUND * mass * self.extent.ball.radius**2:
            yield f"size_{self.link}"
        if not self.density_bounded:
            return
        spread = np.linalg.eigvalsh(second_moments(body))[0]
        if spread < (1.0 + AT_DENSITY) * SMALLEST * max(mass, 0.0) ** (5.0 / 3.0):
            yield f"density_{self.link}"


def second_moments(body: Vector) -> np.ndarray:
    """Give the second moments of a body's mass about its mass centre, kg m2; zeros without mass."""
    pseudo = pseudo_inertia(body)
    if pseudo[3, 3] <= 0.0:
        return np.zeros((3, 3))
    return np.asarray(pseudo[:3, :3] - np.outer(pseudo[:3, 3], pseudo[:3, 3]) / pseudo[3, 3])


def link_bounds(model: DynamicModel, bounds: Bounds, prior: Prior) -> tuple[LinkBound, ...]:
    """Give the bounds on every modelled link's body; a declared place of its centre replaces its size.

    Where an ordinary link would be denser than metal, in proportion to torques and lengths, the torque is in
    another unit or its lengths are not the robot's: then density is not bounded.
    """
    extents = _extents(model.robot, bounds)
    found = []
    for number, columns in enumerate(link_columns(model), start=1):
        exempt = number in bounds.exempt
        extent = None if exempt else extents[number - 1]
        density = bounds.plausible and not exempt and _has_known_units(prior, columns)
        found.append(LinkBound(number, columns, extent, density_bounded=density))
    return tuple(found)


def _extents(robot: RobotModel, bounds: Bounds) -> list[Extent | None]:
    """Give each link's extent: declared, or assumed where no place of its centre is declared."""
    placed = {region.link for region in bounds.centres}
    declared = {size.link: Extent(Ball(size.centre, size.radius), "declared") for size in bounds.sizes}
    known = link_extents(robot) if bounds.plausible else (None,) * len(robot.links)
    return [
        declared.get(link) or (None if link in placed else extent)
        for link, extent in enumerate(known, start=1)
    ]


def _has_known_units(prior: Prior, columns: tuple[int, ...]) -> bool:
    return density_unit(prior, columns) < ORDINARY * float(prior.scale[columns[0]])


def density_unit(prior: Prior, columns: tuple[int, ...]) -> float:
    """Give the unit of t (kg m2) in which t >= k m^(5/3) reads u >= x^(5/3), x the mass over its scale."""
    return float(SMALLEST * prior.scale[columns[9]] ** (5.0 / 3.0))
