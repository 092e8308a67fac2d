"""Say what makes a robot physically consistent, and what makes it plausible, as data for any solver.

Consistent: every link's pseudo-inertia is positive definite, rotor inertias and frictions are not negative.
Plausible: bounds on masses and mass centres, and a pull towards a prior in the directions that the motion
leaves open. Consistency alone lets links of tonnes pass, whose effect on the torque cancels. Sources: Sousa &
Cortesao 2014; Wensing, Kim & Slotine 2018.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import JointVector, Parameters, Vector
from ..dynamics.model import DynamicModel
from ..errors import OptionError
from ..robot.inertia import from_mass_properties
from ..robot.joint_units import largest_of_kind, prismatic_joints
from ..robot.model import INERTIAL_SYMBOLS

LARGEST_MARGIN = 0.1
"""A margin is a share of an ordinary link's pseudo-inertia; more than a tenth would shape the answer."""

DEFAULT_MARGIN, LIGHT_MARGIN = 1e-4, 1e-7
"""The margin of an ordinary link, and the one of a robot of which a link is much lighter: least eigenvalue of
every scaled pseudo-inertia."""


@dataclass(frozen=True)
class CentreBox:
    """Keep a link's mass centre between two corners, m, in the link's frame."""

    link: int
    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @property
    def is_empty(self) -> bool:
        """Tell whether no mass centre fits in."""
        return any(low > high for low, high in zip(self.low, self.high, strict=True))


@dataclass(frozen=True)
class CentreEllipsoid:
    """Keep a link's mass centre in an ellipsoid whose semi-axes lie along the link frame's axes, m."""

    link: int
    centre: tuple[float, float, float]
    semi_axes: tuple[float, float, float]

    @property
    def is_empty(self) -> bool:
        """Tell whether no mass centre fits in."""
        return any(axis <= 0 for axis in self.semi_axes)


@dataclass(frozen=True)
class LinkSize:
    """Keep all of a link's mass in a ball, m, in the link's frame."""

    link: int
    centre: tuple[float, float, float]
    radius: float

    @property
    def is_empty(self) -> bool:
        """Tell whether no body fits in."""
        return self.radius <= 0.0


@dataclass(frozen=True)
class Bounds:
    """Ask for a plausible robot."""

    mass: tuple[tuple[int, float, float], ...] = ()
    """Per link number, smallest and largest mass in kg."""
    total_mass: tuple[float, float] | None = None
    """Smallest and largest mass of all links together, kg."""
    centres: tuple[CentreBox | CentreEllipsoid, ...] = ()
    """Where mass centres may lie."""
    sizes: tuple[LinkSize, ...] = ()
    """Where all of a link's mass lies, as declared."""
    plausible: bool = True
    """Whether bodies that are not declared have the size that follows from the robot's description, and no
    body is denser than metal."""
    exempt: tuple[int, ...] = ()
    """Links whose size and density are not bounded, to measure what their bounds cost."""
    margin: float = DEFAULT_MARGIN
    """Least eigenvalue of every scaled pseudo-inertia; keeps the mass matrix off singularity."""

    def __post_init__(self) -> None:
        """Refuse empty ranges."""
        masses_fit = self._allows_masses() and 0.0 <= self.margin <= LARGEST_MARGIN
        if not masses_fit or any(region.is_empty for region in (*self.centres, *self.sizes)):
            raise OptionError(
                "the bounds contradict each other",
                evidence={
                    "mass_kg": list(map(list, self.mass)),
                    "total_mass_kg": list(self.total_mass or ()),
                    "margin": self.margin,
                },
                remedy="give lower bounds from 0 to the upper ones, a total mass with room for the least "
                "masses of the links, positive semi-axes and radii, a margin from 0 to 0.1",
            )

    def _allows_masses(self) -> bool:
        """Tell whether no range of masses is empty and the total has room for the links' least masses."""
        masses = list(_masses_by_link(self.mass).values())
        least = sum(low for low, _ in masses)
        total = self.total_mass or (least, np.inf)
        impossible = any(low > high or low < 0.0 or high <= 0.0 for low, high in [*masses, total])
        return not (impossible or total[1] < least)


def _masses_by_link(rows: tuple[tuple[int, float, float], ...]) -> dict[int, tuple[float, float]]:
    """Give what all rows leave of each link's mass."""
    left = dict[int, tuple[float, float]]()
    for link, low, high in rows:
        least, most = left.get(link, (low, high))
        left[link] = max(low, least), min(high, most)
    return left


@dataclass(frozen=True, eq=False)
class Prior:
    """Hold a prior of the standard parameters, towards which the programme pulls."""

    centre: Parameters
    """The expected standard parameters."""
    scale: Vector
    """What counts as one unit of deviation, per parameter."""
    source: str
    """Where it comes from: ``robot`` (CAD, URDF) or ``nominal`` (a plain body in proportion to the
    torques)."""


def link_columns(model: DynamicModel) -> tuple[tuple[int, ...], ...]:
    """Give the indices of every modelled link's ten parameters in `model.parameters`."""
    column_of = {parameter.name: column for column, parameter in enumerate(model.parameters)}
    return tuple(
        tuple(column_of[f"{symbol}{number}"] for symbol in INERTIAL_SYMBOLS)
        for number in range(1, len(model.robot.links) + 1)
        if f"M{number}" in column_of
    )


def check_links(bounds: Bounds, model: DynamicModel) -> None:
    """Refuse bounds on links that the model does not have.

    Raises
    ------
    OptionError
        If a bound names such a link, or any link of a model without rigid bodies.
    """
    links = len(link_columns(model))
    regions = (*bounds.centres, *bounds.sizes)
    named = [link for link, _, _ in bounds.mass] + [region.link for region in regions]
    unknown = sorted({link for link in named if not 1 <= link <= links})
    if unknown or (bounds.total_mass is not None and not links):
        raise OptionError(
            "a bound names a link that the model does not have",
            evidence={"links": unknown, "known": list(range(1, links + 1))},
            remedy="number the links from 1, and keep the term rigid_body",
        )


def default_prior(model: DynamicModel, torque_rms: Vector, sizes: Mapping[str, float] | None = None) -> Prior:
    """Take the robot's own prior; where it has none, small balls in proportion to torques and lengths.

    Parameters
    ----------
    sizes
        By name, what counts as one unit of deviation of parameters whose size is known otherwise.
    """
    length, mass, effort = _proportions(model, torque_rms)
    units = {"kg m2": mass * length**2, "kg m": mass * length, "kg": mass}
    known = sizes or {}
    scale = np.array(
        [
            known.get(parameter.name) or units.get(parameter.unit, effort[parameter.joint - 1])
            for parameter in model.parameters
        ]
    )
    centre = np.zeros(len(model.parameters))
    bodies = model.robot.prior
    ball = from_mass_properties(mass, np.zeros(3), 0.4 * mass * (0.3 * length) ** 2 * np.eye(3))
    for number, columns in enumerate(link_columns(model)):
        centre[list(columns)] = ball if bodies is None else bodies[number]
    return Prior(centre, scale, "nominal" if bodies is None else "robot")


def congruence(prior: Prior, columns: tuple[int, ...]) -> Vector:
    """Give the diagonal D for which D J D has entries near one, J a link's pseudo-inertia in SI units."""
    inertia, mass = prior.scale[columns[0]], prior.scale[columns[9]]
    return np.array([inertia**-0.5] * 3 + [mass**-0.5])


def lower_bounds(model: DynamicModel) -> Vector:
    """Give the physical lower bound per parameter outside the links, -inf where there is none."""
    linked = {column for columns in link_columns(model) for column in columns}
    return np.array(
        [
            -np.inf if parameter.lower is None or column in linked else parameter.lower
            for column, parameter in enumerate(model.parameters)
        ]
    )


def _proportions(model: DynamicModel, torque_rms: Vector) -> tuple[float, float, JointVector]:
    """Give an ordinary link's length (m) and mass (kg), and per joint the largest effort of its kind."""
    robot = model.robot
    lengths: list[float] = [float(np.linalg.norm(link.translation)) for link in robot.links]
    length = max(*lengths, 0.05)
    prismatic = prismatic_joints(robot)
    effort = np.maximum(largest_of_kind(torque_rms, prismatic), 1e-6)
    gravity = max(float(np.linalg.norm(robot.gravity)), 1.0)
    reach = max(sum(lengths), length)
    arm = np.where(prismatic, 1.0, reach)
    return length, max(float((2.0 * effort / (gravity * arm)).max()) / len(robot.links), 1e-3), effort
