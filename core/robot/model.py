"""Hold a robot's kinematics in one form, whatever convention it was described in.

A robot is a tree of links. Frame j sits at a fixed placement on its antecedent and moves along or about its
own z axis. Joint coordinates and links are kept apart, because a mimic joint moves a link without having a
coordinate of its own. Every scalar of its dynamic model has a name and a unit.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from ..arrays import JointVector, LinkTable, Rotation, Vector3
from ..errors import RobotError
from .modified_dh import ModifiedDHRow

JointKind = Literal["revolute", "prismatic"]
FRICTION_KINDS = ("viscous", "coulomb", "offset")


@dataclass(frozen=True)
class Limits:
    """Bound a joint's position (rad or m), velocity (rad/s or m/s) and torque (N m or N); None: unknown."""

    position: tuple[float, float] | None = None
    velocity: float | None = None
    torque: float | None = None


@dataclass(frozen=True)
class Joint:
    """Describe one joint coordinate and its drive.

    `torque_constant` (N m/A, motor side) and `gear_ratio` turn a logged current into joint torque; None where
    undeclared. `rotor_inertia` and `friction` declare which of these the model has on this joint.
    """

    name: str
    limits: Limits = Limits()
    rotor_inertia: bool = True
    friction: tuple[str, ...] = FRICTION_KINDS
    torque_constant: float | None = None
    gear_ratio: float | None = None


@dataclass(frozen=True, eq=False)
class Link:
    """Place one moving body."""

    name: str
    """The body's name."""
    kind: JointKind
    """Revolute (about its z axis) or prismatic (along it)."""
    antecedent: int
    """Number of the link that carries it, 0 for the base."""
    joint: int
    """Number of the joint coordinate that moves it, counted from 1."""
    rotation: Rotation
    translation: Vector3
    """Rotation and translation (m): the pose of its frame on the antecedent at zero coordinate."""
    ratio: float = 1.0
    offset: float = 0.0
    """Its own angle or stroke is ``ratio * q[joint] + offset``; 1 and 0 unless it mimics another joint."""
    row: ModifiedDHRow | None = None
    """The modified DH row its placement was computed from; None where the placement itself was given."""


@dataclass(frozen=True)
class Ball:
    """Hold a ball in a link's frame, m."""

    centre: tuple[float, float, float]
    radius: float

    @staticmethod
    def around(points: Sequence[Vector3]) -> "Ball":
        """Give the ball about the middle of the points' bounding box that holds them all.

        Examples
        --------
        >>> Ball.around([np.zeros(3), np.array([0.4, 0.0, 0.0])])
        Ball(centre=(0.2, 0.0, 0.0), radius=0.2)
        """
        return Ball.joined([Ball((float(x), float(y), float(z)), 0.0) for x, y, z in points])

    @staticmethod
    def joined(balls: "Sequence[Ball]") -> "Ball":
        """Give a ball that holds several."""
        centres, radii = np.array([ball.centre for ball in balls]), np.array([ball.radius for ball in balls])
        low, high = (centres - radii[:, None]).min(axis=0), (centres + radii[:, None]).max(axis=0)
        middle = 0.5 * (low + high)
        x, y, z = map(float, middle)
        return Ball((x, y, z), float((np.linalg.norm(centres - middle, axis=1) + radii).max()))


@dataclass(frozen=True)
class Coupling:
    """Describe a motor whose angle is a weighted sum of joint positions (Staubli TX40, motor 6: q5 + q6).

    Its inertia, viscous and Coulomb friction act on that sum; by virtual work the torque on joint i is
    `weights[i]` times it.
    """

    name: str
    number: int
    joints: tuple[int, ...]
    weights: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class RobotModel:
    """Describe a robot as a tree of links that move about or along their z axes.

    Attributes
    ----------
    gravity
        Gravitational acceleration in the base frame, m/s2, pointing down.
    prior
        Ten inertial parameters per link, in each link's frame; None without a prior.
    shapes
        Per link, a ball that holds its shapes, in its frame; None where they are not known.
    remarks
        What its reader took otherwise than it is written, left out, or found odd, in sentences.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    gravity: Vector3
    couplings: tuple[Coupling, ...] = ()
    prior: LinkTable | None = field(default=None)
    remarks: tuple[str, ...] = ()
    shapes: tuple[Ball | None, ...] | None = None

    def __post_init__(self) -> None:
        """Refuse trees that are no trees and vectors of the wrong length."""
        if not self.links:
            raise RobotError(
                "the robot has no joints", evidence={"joints": 0}, remedy="describe at least one joint"
            )
        for number, link in enumerate(self.links, start=1):
            if not 0 <= link.antecedent < number:
                raise RobotError(
                    "a link must follow the link that carries it",
                    evidence={"link": number, "antecedent": link.antecedent},
                    remedy=f"give link {number} an antecedent from 0 (the base) to {number - 1}",
                )
            if not 1 <= link.joint <= len(self.joints):
                raise RobotError(
                    "a link is moved by a joint that does not exist",
                    evidence={"link": number, "joint": link.joint, "joints": len(self.joints)},
                    remedy="number the joints from 1",
                )
        self._check_joints()
        self._check_couplings()

    def _check_joints(self) -> None:
        idle = set(range(1, len(self.joints) + 1)) - {link.joint for link in self.links}
        if idle:
            raise RobotError(
                "a joint moves no link",
                evidence={"joints": sorted(idle)},
                remedy="leave it out, or name it as the joint of a link",
            )

    def _check_couplings(self) -> None:
        for coupling in self.couplings:
            wrong = [joint for joint in coupling.joints if not 1 <= joint <= len(self.joints)]
            if wrong or len(coupling.joints) != len(coupling.weights) or len(set(coupling.joints)) < 2:
                raise RobotError(
                    f"coupling {coupling.name} does not name two or more joints with one weight each",
                    evidence={"joints": list(coupling.joints), "weights": list(coupling.weights)},
                    remedy=f"name joints from 1 to {len(self.joints)}",
                )

    @cached_property
    def supports(self) -> tuple[tuple[int, ...], ...]:
        """List, for every link (counted from 0), its carriers and itself, from the base outwards."""
        chains: list[tuple[int, ...]] = []
        for index, link in enumerate(self.links):
            chains.append((*(chains[link.antecedent - 1] if link.antecedent else ()), index))
        return tuple(chains)

    @cached_property
    def lower_positions(self) -> JointVector:
        """Give the lower position limits, -pi (revolute) or -1 m (prismatic) where unknown."""
        return self._position_limits(0)

    @cached_property
    def upper_positions(self) -> JointVector:
        """Give the upper position limits, pi (revolute) or 1 m (prismatic) where unknown."""
        return self._position_limits(1)

    @cached_property
    def link_arrays(self) -> tuple[np.ndarray, ...]:
        """Give all links as contiguous arrays: prismatic, antecedent, joint from 0, ratio, offset, frame."""
        return (
            np.array([link.kind == "prismatic" for link in self.links]),
            np.array([link.antecedent for link in self.links]),
            np.array([link.joint - 1 for link in self.links]),
            np.array([link.ratio for link in self.links], dtype=float),
            np.array([link.offset for link in self.links], dtype=float),
            np.array([link.rotation for link in self.links], dtype=float),
            np.array([link.translation for link in self.links], dtype=float),
        )

    def _position_limits(self, side: int) -> JointVector:
        fallback = {"revolute": (-np.pi, np.pi), "prismatic": (-1.0, 1.0)}
        kinds = {link.joint: link.kind for link in reversed(self.links)}
        return np.array(
            [
                (joint.limits.position or fallback[kinds[number]])[side]
                for number, joint in enumerate(self.joints, start=1)
            ]
        )


INERTIAL_SYMBOLS = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
INERTIAL_UNITS = dict(zip(INERTIAL_SYMBOLS, ("kg m2",) * 6 + ("kg m",) * 3 + ("kg",), strict=True))


@dataclass(frozen=True)
class Parameter:
    """Name one scalar of the model; its place in a vector is no name, because orders differ between tools.

    Source of the symbols: Khalil & Dombre, Modeling, Identification and Control of Robots (2002), ch. 9, 12.

    Examples
    --------
    >>> Parameter("ZZ", 3, 3, "kg m2").name
    'ZZ3'
    """

    symbol: str
    """The field's letters, e.g. ``ZZ`` or ``FV``."""
    number: int
    """Joint or link number, counted from 1."""
    joint: int
    """The joint the parameter is reported under, counted from 1."""
    unit: str
    """SI unit as text."""
    lower: float | None = None
    """Physical lower bound, or None where any sign is possible."""

    @property
    def name(self) -> str:
        """Give the symbol with its number."""
        return f"{self.symbol}{self.number}"


def inertial_parameters(link: int, joint: int) -> tuple[Parameter, ...]:
    """Name the ten inertial parameters of a link in Khalil's order.

    Examples
    --------
    >>> [parameter.name for parameter in inertial_parameters(2, 2)][:4]
    ['XX2', 'XY2', 'XZ2', 'YY2']
    """
    return tuple(
        Parameter(symbol, link, joint, INERTIAL_UNITS[symbol], 0.0 if symbol == "M" else None)
        for symbol in INERTIAL_SYMBOLS
    )
