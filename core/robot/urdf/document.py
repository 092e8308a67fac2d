"""Read URDF text into plain records; an element is judged when it is asked for, not before.

So only the chosen part of a robot is judged: a floating base above it, or a gripper beside it that cannot be
used, does no harm. What the records mean together, whether they form a tree for instance, is decided in
`core.robot.urdf.read`. Source: the ROS URDF XML specification.
"""

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from xml.etree.ElementTree import Element

import numpy as np

from ...arrays import LinkParameters, Rotation, Vector3
from ...errors import RobotError
from ..frames import rotation_rpy
from ..inertia import from_mass_properties
from ..model import Limits
from ..right_angles import meant_angle
from .elements import attribute, bound, child, children, excerpt, number, numbers, parse_urdf, required

MOVING_KINDS = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}


@dataclass(frozen=True)
class Mimic:
    """State that a joint's coordinate is ratio times another joint's plus offset (rad or m)."""

    joint: str
    ratio: float
    offset: float


@dataclass(frozen=True, eq=False)
class UrdfJoint:
    """Hold one joint element; its pose, axis and limits are read when they are asked for.

    Each of these raises `RobotError` where the element lacks what it must hold.
    """

    name: str
    kind: str
    parent: str
    child: str
    element: Element

    @property
    def where(self) -> str:
        """Give the words by which a refusal names the joint."""
        return f"joint {self.name}"

    @cached_property
    def angles(self) -> Vector3:
        """Give roll, pitch and yaw as written, rad."""
        return _angles(self.element, self.where)

    @cached_property
    def placement(self) -> tuple[Rotation, Vector3]:
        """Give the child's pose on its parent at zero coordinate: rotation and translation (m)."""
        return pose(self.element, self.where)

    @cached_property
    def axis(self) -> Vector3:
        """Give the unit vector along which or about which the joint moves."""
        axis = numbers(child(self.element, "axis"), "xyz", self.where, (1.0, 0.0, 0.0))
        length = float(np.linalg.norm(axis))
        if not 1e-6 < length < 1e6:
            raise RobotError(
                f"{self.where} has an axis without a direction",
                evidence={"axis": [float(part) for part in axis]},
                remedy="give the axis as a unit vector in the joint's frame",
            )
        return np.asarray(axis / length)

    @cached_property
    def stops(self) -> tuple[float, float]:
        """Give the lower and upper limit as written; 0 and 0 where either means none."""
        limit = child(self.element, "limit")
        if limit is None or self.kind == "continuous":
            return (0.0, 0.0)
        lower, upper = (bound(limit, side, self.where) for side in ("lower", "upper"))
        return (0.0, 0.0) if lower is None or upper is None else (lower, upper)

    @cached_property
    def limits(self) -> Limits:
        """Give the limits; URDF writes zeros, and some writers a lower limit above the upper, for none."""
        limit = child(self.element, "limit")
        if limit is None:
            return Limits()
        velocity, torque = (
            abs(bound(limit, side, self.where) or 0.0) or None for side in ("velocity", "effort")
        )
        return Limits(self.stops if self.stops[0] < self.stops[1] else None, velocity, torque)

    @cached_property
    def mimic(self) -> Mimic | None:
        """Say which joint it follows; None where it has a coordinate of its own."""
        mimic = child(self.element, "mimic")
        if mimic is None:
            return None
        ratio = number(mimic, "multiplier", self.where, 1.0)
        offset = number(mimic, "offset", self.where, 0.0)
        return Mimic(attribute(mimic, "joint", self.where), ratio, offset)

    @property
    def has_dynamics(self) -> bool:
        """Tell whether it declares a damping or friction that is not zero."""
        dynamics = child(self.element, "dynamics")
        written = [] if dynamics is None else [dynamics.get(name) for name in ("damping", "friction")]
        return any(value is not None and value.strip("0. \t\n") for value in written)

    def check_kind(self) -> None:
        """Refuse a joint that has more than one coordinate, or is of no known type.

        Raises
        ------
        RobotError
            If it is not revolute, continuous or prismatic.
        """
        if self.kind not in MOVING_KINDS:
            raise RobotError(
                f"{self.where} is of a type that cannot be identified",
                evidence={"type": excerpt(self.kind), "known": [*MOVING_KINDS, "fixed"]},
                remedy=f"start at the link that it carries: base_link={excerpt(self.child)} (--base-link in "
                "a terminal), with the gravity in that link's frame; or use one of the known types",
            )


@dataclass(frozen=True, eq=False)
class UrdfDocument:
    """Hold a URDF's links and joints."""

    name: str
    """The robot's name; may be empty."""
    links: dict[str, Element]
    joints: tuple[UrdfJoint, ...]

    def body(self, link: str) -> LinkParameters | None:
        """Give a link's body about the link's origin; None without one.

        Raises
        ------
        RobotError
            If its inertial lacks what it must hold.
        """
        inertial = child(self.links[link], "inertial")
        if inertial is None:
            return None
        where = f"the inertial of link {link}"
        rotation, centre = pose(inertial, where)
        mass = number(required(inertial, "mass", where), "value", where)
        table = required(inertial, "inertia", where)
        xx, xy, xz, yy, yz, zz = (
            number(table, f"i{axes}", where) for axes in ("xx", "xy", "xz", "yy", "yz", "zz")
        )
        along = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        return from_mass_properties(mass, centre, rotation @ along @ rotation.T)


def read_urdf_document(text: bytes | str) -> UrdfDocument:
    """Read the elements of a URDF.

    Raises
    ------
    RobotError
        If the text is too large, malformed, holds entities or xacro, or its links and joints are not named.
    """
    root = parse_urdf(text)
    links, joints = children(root, "link"), children(root, "joint")
    _refuse_twins(links, "link")
    _refuse_twins(joints, "joint")
    return UrdfDocument(
        name="" if root.get("name") == "" else attribute(root, "name", "the document"),
        links={attribute(element, "name", "link"): element for element in links},
        joints=tuple(_joint(element) for element in joints),
    )


def _refuse_twins(elements: list[Element], kind: str) -> None:
    names = [attribute(element, "name", f"{kind} {place}") for place, element in enumerate(elements, start=1)]
    twins = [name for name, count in Counter(names).items() if count > 1]
    if twins:
        raise RobotError(
            f"two {kind}s have the same name",
            evidence={kind: twins[:5]},
            remedy=f"give every {kind} its own name",
        )


def _joint(element: Element) -> UrdfJoint:
    name = attribute(element, "name", "joint")
    where = f"joint {name}"
    return UrdfJoint(
        name=name,
        kind=attribute(element, "type", where),
        parent=attribute(required(element, "parent", where), "link", where),
        child=attribute(required(element, "child", where), "link", where),
        element=element,
    )


def _angles(element: Element, where: str) -> Vector3:
    return numbers(child(element, "origin"), "rpy", where, (0.0, 0.0, 0.0))


def pose(element: Element, where: str) -> tuple[Rotation, Vector3]:
    """Read a pose; its right angles are taken for right angles however many digits they are written with."""
    roll, pitch, yaw = (meant_angle(float(angle)) for angle in _angles(element, where))
    return rotation_rpy(roll, pitch, yaw), numbers(child(element, "origin"), "xyz", where, (0.0, 0.0, 0.0))
