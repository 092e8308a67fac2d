"""Read URDF text into plain records, refusing everything that is not a plain, expanded, self-contained URDF.

The text comes from outside: it is parsed by defusedxml, with document types and entities forbidden. What the
records mean together, whether they form a tree for instance, is decided in `core.robot.urdf`. Source: the ROS
URDF XML specification.
"""

from collections import Counter
from dataclasses import dataclass
from xml.etree.ElementTree import Element, ParseError

import numpy as np
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import fromstring

from ..arrays import LinkParameters, Rotation, Vector, Vector3
from ..errors import RobotError
from ..fields import LARGEST_NUMBER, LONGEST_NAME
from .frames import rotation_rpy
from .inertia import from_mass_properties
from .model import Limits

MOST_BYTES = 5_000_000
MOVING_KINDS = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}
_EXPAND = "expand it first: xacro robot.urdf.xacro > robot.urdf"


@dataclass(frozen=True)
class Mimic:
    """State that a joint's coordinate is ratio times another joint's plus offset (rad or m)."""

    joint: str
    ratio: float
    offset: float


@dataclass(frozen=True, eq=False)
class UrdfJoint:
    """Hold one joint element: the child's pose on its parent at zero coordinate, and how it moves there."""

    name: str
    kind: str
    parent: str
    child: str
    rotation: Rotation
    translation: Vector3
    axis: Vector3
    limits: Limits
    mimic: Mimic | None


@dataclass(frozen=True, eq=False)
class UrdfDocument:
    """Hold a URDF's links, each with its body about the link's origin (None without one), and its joints."""

    name: str
    links: dict[str, LinkParameters | None]
    joints: tuple[UrdfJoint, ...]


def read_urdf_document(text: bytes | str) -> UrdfDocument:
    """Read the elements of a URDF.

    Raises
    ------
    RobotError
        If the text is too large, malformed, holds entities or xacro, or an element lacks what it must hold.
    """
    size = len(text)
    if size > MOST_BYTES:
        raise RobotError(
            "the URDF is too large",
            evidence={"bytes": size, "limit": MOST_BYTES},
            remedy="leave meshes and textures out; they are not read",
        )
    root = _parse(text)
    links = [element for element in root if _tag(element) == "link"]
    joints = [element for element in root if _tag(element) == "joint"]
    _refuse_twins(links, "link")
    _refuse_twins(joints, "joint")
    return UrdfDocument(
        name=_attribute(root, "name", "the document"),
        links={_attribute(element, "name", "link"): _body(element) for element in links},
        joints=tuple(_joint(element) for element in joints),
    )


def _refuse_twins(elements: list[Element], kind: str) -> None:
    names = [_attribute(element, "name", kind) for element in elements]
    twins = [name for name, count in Counter(names).items() if count > 1]
    if twins:
        raise RobotError(
            f"two {kind}s have the same name",
            evidence={kind: twins[:5]},
            remedy=f"give every {kind} its own name",
        )


def _parse(text: bytes | str) -> Element:
    try:
        root: Element = fromstring(text, forbid_dtd=True)
    except DefusedXmlException as error:
        raise RobotError(
            "the URDF holds a document type or entities, which are not read",
            evidence={"found": type(error).__name__},
            remedy="remove the DOCTYPE and write the values out",
        ) from error
    except (ParseError, ValueError, LookupError) as error:
        if (b"xacro:" if isinstance(text, bytes) else "xacro:") in text:  # type: ignore[operator]  # both are of one kind
            _refuse_xacro("an undeclared xacro prefix")
        raise RobotError(
            "the URDF is not well-formed XML",
            evidence={"parser": _excerpt(str(error))},
            remedy="send one XML document",
        ) from error
    _refuse_xacro_inside(root)
    if _tag(root) != "robot":
        raise RobotError(
            "the document is not a URDF: its root element is not robot",
            evidence={"root": _excerpt(_tag(root))},
            remedy="send a document that starts with <robot name=...>",
        )
    return root


def _refuse_xacro_inside(root: Element) -> None:
    for element in root.iter():
        if element.tag.startswith("{") and "xacro" in element.tag.partition("}")[0]:
            _refuse_xacro(f"the element xacro:{_tag(element)}")
        for value in element.attrib.values():
            if "${" in value or "$(" in value:
                _refuse_xacro(value)


def _refuse_xacro(found: str) -> None:
    raise RobotError(
        "the document is a xacro, not a URDF", evidence={"found": _excerpt(found)}, remedy=_EXPAND
    ) from None


def _joint(element: Element) -> UrdfJoint:
    name = _attribute(element, "name", "joint")
    where = f"joint {name}"
    kind = _attribute(element, "type", where)
    if kind not in MOVING_KINDS and kind != "fixed":
        raise RobotError(
            f"{where} is of a type that cannot be identified",
            evidence={"type": _excerpt(kind), "known": [*MOVING_KINDS, "fixed"]},
            remedy="use one of the known types; start a floating robot at a link that is fixed",
        )
    rotation, translation = _origin(element, where)
    axis = _numbers(_child(element, "axis"), "xyz", where, (1.0, 0.0, 0.0))
    length = float(np.linalg.norm(axis))
    if kind != "fixed" and not 1e-6 < length < 1e6:
        raise RobotError(
            f"{where} has an axis without a direction",
            evidence={"axis": [float(part) for part in axis]},
            remedy="give the axis as a unit vector in the joint's frame",
        )
    return UrdfJoint(
        name=name,
        kind=kind,
        parent=_attribute(_required(element, "parent", where), "link", where),
        child=_attribute(_required(element, "child", where), "link", where),
        rotation=rotation,
        translation=translation,
        axis=axis / length if kind != "fixed" else axis,
        limits=_limits(element, kind, where),
        mimic=_mimic(element, where),
    )


def _limits(element: Element, kind: str, where: str) -> Limits:
    """Read limits; URDF writes zero where nothing is known."""
    limit = _child(element, "limit")
    if limit is None:
        return Limits()
    lower, upper = (_number(limit, side, where, 0.0) for side in ("lower", "upper"))
    if lower > upper:
        raise RobotError(
            f"{where} has its lower limit above the upper one",
            evidence={"lower": lower, "upper": upper},
            remedy="swap them",
        )
    velocity, torque = (abs(_number(limit, side, where, 0.0)) or None for side in ("velocity", "effort"))
    position = (lower, upper) if lower < upper and kind != "continuous" else None
    return Limits(position, velocity, torque)


def _mimic(element: Element, where: str) -> Mimic | None:
    mimic = _child(element, "mimic")
    if mimic is None:
        return None
    ratio, offset = _number(mimic, "multiplier", where, 1.0), _number(mimic, "offset", where, 0.0)
    return Mimic(_attribute(mimic, "joint", where), ratio, offset)


def _body(element: Element) -> LinkParameters | None:
    inertial = _child(element, "inertial")
    if inertial is None:
        return None
    where = f"the inertial of link {element.get('name')}"
    rotation, centre = _origin(inertial, where)
    mass = _number(_required(inertial, "mass", where), "value", where)
    table = _required(inertial, "inertia", where)
    xx, xy, xz, yy, yz, zz = (
        _number(table, f"i{axes}", where) for axes in ("xx", "xy", "xz", "yy", "yz", "zz")
    )
    along = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return from_mass_properties(mass, centre, rotation @ along @ rotation.T)


def _origin(element: Element, where: str) -> tuple[Rotation, Vector3]:
    origin = _child(element, "origin")
    roll, pitch, yaw = _numbers(origin, "rpy", where, (0.0, 0.0, 0.0))
    return rotation_rpy(roll, pitch, yaw), _numbers(origin, "xyz", where, (0.0, 0.0, 0.0))


def _tag(element: Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _child(element: Element, tag: str) -> Element | None:
    return next((child for child in element if _tag(child) == tag), None)


def _required(element: Element, tag: str, where: str) -> Element:
    child = _child(element, tag)
    if child is None:
        raise RobotError(
            f"{where} has no {tag} element",
            evidence={"found": [_tag(child) for child in element][:10]},
            remedy=f"add the {tag} element",
        )
    return child


def _attribute(element: Element, name: str, where: str) -> str:
    value = element.get(name)
    if not value:
        raise RobotError(
            f"{where}: the element {_tag(element)} has no {name}",
            evidence={"attributes": list(element.attrib)[:10]},
            remedy=f"add the attribute {name}",
        )
    if name == "name" and (len(value) > LONGEST_NAME or not value.isprintable()):
        raise RobotError(
            f"the name of a {_tag(element)} is too long or cannot be printed",
            evidence={"name": _excerpt(value), "characters": len(value), "limit": LONGEST_NAME},
            remedy="give it a short name",
        )
    return value


def _number(element: Element, name: str, where: str, default: float | None = None) -> float:
    if default is not None and element.get(name) is None:
        return default
    return float(_values(_attribute(element, name, where), name, where, 1)[0])


def _numbers(element: Element | None, name: str, where: str, default: tuple[float, float, float]) -> Vector3:
    if element is None or element.get(name) is None:
        return np.array(default)
    return _values(_attribute(element, name, where), name, where, 3)


def _values(text: str, name: str, where: str, count: int) -> Vector:
    try:
        values = np.array([float(word) for word in text.split()])
    except ValueError:
        values = np.empty(0)
    if len(values) != count or not (np.abs(values) <= LARGEST_NUMBER).all():
        raise RobotError(
            f"{where}: {name} does not hold {count} finite number{'s' if count > 1 else ''}",
            evidence={name: _excerpt(text)},
            remedy="write decimal numbers, separated by blanks",
        )
    return values


def _excerpt(text: str) -> str:
    """Give at most eighty characters of a text, with escapes for what cannot be printed."""
    printable = text if text.isprintable() else repr(text)[1:-1]
    return printable if len(printable) <= 80 else printable[:77] + "..."
