"""Check described bodies without a log: against what bodies can be, their links' size, and each other."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import LinkTable, Vector
from ..robot.inertia import mass_properties, pseudo_inertia
from ..robot.model import RobotModel
from .thresholds import DESCRIPTION

ROUNDING = 1e-9
"""An eigenvalue above minus this share of the largest one is rounding."""
UNITS = {
    1e3: "grams instead of kilograms, or millimetres instead of metres",
    1e6: "kg mm2 instead of kg m2",
    1e9: "g mm2 instead of kg m2",
}
SIDES = (("left", "right"), ("Left", "Right"), ("l_", "r_"), ("L_", "R_"), ("_l", "_r"), ("_L", "_R"))


@dataclass(frozen=True)
class Remark:
    """State what is odd about a body."""

    check: str
    """Name of the check."""
    link: int | None
    """Number of the link, from 1; None where it concerns the robot."""
    entry: str
    """``mass``, ``centre`` or ``inertia``."""
    statement: str
    remedy: str


@dataclass(frozen=True, eq=False)
class _Body:
    """Hold a described body with the size of its link."""

    number: int
    name: str
    mass: float
    centre: Vector
    inertia: np.ndarray
    eigenvalues: Vector
    """Of the pseudo-inertia, ascending."""
    middle: Vector
    radius: float
    """The ball that holds the link, m; infinite where nothing says how large it is."""

    @property
    def principal(self) -> Vector:
        """Give the principal moments of inertia, kg m2, ascending."""
        return np.asarray(np.linalg.eigvalsh(self.inertia))

    @property
    def gyration(self) -> float:
        """Give the radius of gyration, m."""
        return float(np.sqrt(max(0.5 * np.trace(self.inertia), 0.0) / self.mass)) if self.mass > 0.0 else 0.0

    @property
    def label(self) -> str:
        """Name the link."""
        return f"link {self.number} ({self.name})"


def description_remarks(robot: RobotModel, makers_mass: float | None = None) -> tuple[Remark, ...]:
    """List what is odd about a robot's described bodies; nothing where it describes none.

    Parameters
    ----------
    makers_mass
        Mass of the robot by its data sheet, kg; None where it is not known.
    """
    if robot.prior is None:
        return ()
    bodies = _bodies(robot, robot.prior)
    found = [remark for body in bodies for remark in _of_body(body)]
    found += [*_of_units(bodies), *_of_sides(bodies)]
    if makers_mass is not None:
        found += _of_total(sum(body.mass for body in bodies), makers_mass)
    return tuple(found)


def _bodies(robot: RobotModel, table: LinkTable) -> list[_Body]:
    lengths = [float(np.linalg.norm(link.translation)) for link in robot.links if link.antecedent]
    reach, longest = sum(lengths), max(lengths, default=0.0)
    found = []
    for index, (link, body) in enumerate(zip(robot.links, table, strict=True)):
        ends = [other.translation for other in robot.links if other.antecedent == index + 1]
        tip = 0.0 if ends else DESCRIPTION.tip * longest
        beyond = DESCRIPTION.beyond_metres + DESCRIPTION.beyond_share * reach + tip
        middle, radius = _ball([np.zeros(3), *ends], beyond if longest else float("inf"))
        eigenvalues = np.linalg.eigvalsh(pseudo_inertia(body))
        found.append(_Body(index + 1, link.name, *mass_properties(body), eigenvalues, middle, radius))
    return found


def _ball(axes: list[Vector], beyond: float) -> tuple[Vector, float]:
    """Give the middle of some points, and the radius of the ball that reaches so far beyond them, m."""
    points = np.array(axes)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return middle, float(np.linalg.norm(points - middle, axis=1).max()) + beyond


def _of_body(body: _Body) -> Iterator[Remark]:
    if body.mass < DESCRIPTION.light_kg:
        yield Remark(
            "mass",
            body.number,
            "mass",
            f"{body.label} has a mass of {body.mass:.3g} kg",
            "give its mass in kg, or fix the joint that moves it",
        )
        return
    principal = body.principal
    if principal[0] < -ROUNDING * abs(principal[2]):
        yield Remark(
            "negative_inertia",
            body.number,
            "inertia",
            f"{body.label}: the principal moments {_listed(principal)} kg m2 are not all positive",
            "take the inertia about the mass centre, with the signs of products as of matrix elements",
        )
    elif principal[0] + principal[1] < (1.0 - 1e-6) * principal[2]:
        yield Remark(
            "triangle_inequality",
            body.number,
            "inertia",
            f"{body.label}: the principal moments {_listed(principal)} kg m2 violate the triangle "
            "inequality: two together are less than the third",
            "take the inertia about the mass centre, and check its order and the signs of its products",
        )
    elif body.eigenvalues[0] < -ROUNDING * body.eigenvalues[-1]:
        yield Remark(
            "inconsistent",
            body.number,
            "inertia",
            f"{body.label}: its pseudo-inertia has the negative eigenvalue {body.eigenvalues[0]:.3g}",
            "take the inertia about the mass centre",
        )
    yield from _of_size(body)


def _of_size(body: _Body) -> Iterator[Remark]:
    if not np.isfinite(body.radius):
        return
    away = float(np.linalg.norm(body.centre - body.middle))
    if away > body.radius:
        yield Remark(
            "centre_outside",
            body.number,
            "centre",
            f"{body.label}: its mass centre lies {away:.3g} m from the middle of the link, which reaches "
            f"{body.radius:.3g} m",
            "give the mass centre in m in the link's frame",
        )
    if body.gyration > body.radius:
        yield Remark(
            "inertia_too_large",
            body.number,
            "inertia",
            f"{body.label}: its radius of gyration is {body.gyration:.3g} m, "
            f"the link reaches {body.radius:.3g} m",
            "give the inertia about the mass centre in kg m2, and check the mass",
        )
    if body.gyration < DESCRIPTION.compact * body.radius:
        yield Remark(
            "inertia_too_small",
            body.number,
            "inertia",
            f"{body.label}: its radius of gyration is {body.gyration:.3g} m for {body.mass:.3g} kg; a body "
            "of that size would be a needle or a point",
            "give the inertia in kg m2; leave out the element inertial where it is not known",
        )
    if body.mass > DESCRIPTION.heavy_kg_per_m * body.radius:
        yield Remark(
            "mass_too_large",
            body.number,
            "mass",
            f"{body.label}: {body.mass:.4g} kg in a link that reaches {body.radius:.3g} m",
            "give the mass in kg",
        )


def _typical_ratio(bodies: list[_Body]) -> float:
    """Give how many times larger inertias over masses typically are than of links; 0 where none tells."""
    sized = (body for body in bodies if np.isfinite(body.radius) and body.gyration > 0.0)
    ratios = [body.gyration / (DESCRIPTION.usual * body.radius) for body in sized]
    return float(np.median(ratios)) ** 2 if ratios else 0.0


def _of_units(bodies: list[_Body]) -> list[Remark]:
    """Find a unit that all inertias share: their radii of gyration are off by the root of one factor."""
    typical = _typical_ratio(bodies)
    for factor, words in UNITS.items():
        for value, what in ((factor, "large"), (1.0 / factor, "small")):
            if 1.0 / DESCRIPTION.unit_spread < typical / value < DESCRIPTION.unit_spread:
                return [
                    Remark(
                        "unit",
                        None,
                        "inertia",
                        f"inertias over masses are typically {typical:.3g} times those expected from the "
                        f"links' sizes, too {what} by about {factor:g}, as with {words}",
                        "give masses in kg, lengths in m and inertias in kg m2",
                    )
                ]
    return []


def _of_sides(bodies: list[_Body]) -> Iterator[Remark]:
    """Compare left and right links: mirroring keeps mass, principal moments and distances from the axis."""
    by_name = {body.name: body for body in bodies}
    for body in bodies:
        for left, right in SIDES:
            other = by_name.get(body.name.replace(left, right)) if left in body.name else None
            if other is not None and other is not body:
                yield from _compared(body, other)
                break


def _compared(left: _Body, right: _Body) -> Iterator[Remark]:
    share = DESCRIPTION.mirrored_share
    pair = f"link {left.number} ({left.name}) and link {right.number} ({right.name})"
    remedy = "compare both with the maker's drawing: one of them was probably edited alone"
    if abs(left.mass - right.mass) > share * max(left.mass, right.mass):
        statement = f"{pair} weigh {left.mass:.4g} and {right.mass:.4g} kg"
        yield Remark("mirrored", left.number, "mass", statement, remedy)
    places = [np.array([np.hypot(*body.centre[:2]), abs(body.centre[2])]) for body in (left, right)]
    if np.abs(places[0] - places[1]).max() > DESCRIPTION.mirrored_metres:
        statement = (
            f"{pair}: their mass centres lie {places[0][0]:.4g} and {places[1][0]:.4g} m from the axis, "
            f"{places[0][1]:.4g} and {places[1][1]:.4g} m along it"
        )
        yield Remark("mirrored", left.number, "centre", statement, remedy)
    moments = left.principal, right.principal
    if np.abs(moments[0] - moments[1]).max() > share * max(abs(moments[0][2]), abs(moments[1][2])):
        statement = (
            f"{pair}: their principal moments are {_listed(moments[0])} and {_listed(moments[1])} kg m2"
        )
        yield Remark("mirrored", left.number, "inertia", statement, remedy)


def _of_total(described: float, makers: float) -> list[Remark]:
    low, high = DESCRIPTION.least_share * makers, (1.0 + DESCRIPTION.total_share) * makers
    if low <= described <= high:
        return []
    return [
        Remark(
            "total_mass",
            None,
            "mass",
            f"the moving links weigh {described:.4g} kg together, the robot {makers:.4g} kg by its maker",
            f"expected are {low:.3g} to {high:.3g} kg: the base is not among the moving links",
        )
    ]


def _listed(values: Vector) -> str:
    return ", ".join(f"{value:.3g}" for value in values)
