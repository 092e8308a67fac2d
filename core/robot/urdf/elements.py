"""Read the XML of a URDF safely: one parser, and elements whose attributes are asked for by name.

The text comes from outside: it is parsed by defusedxml, with document types and entities forbidden. Two slips
that change nothing are corrected: blank lines before the declaration, and undeclared prefixes.
"""

import re
from xml.etree.ElementTree import Element, ParseError
from xml.parsers.expat import errors

import numpy as np
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import fromstring

from ...arrays import Vector, Vector3
from ...errors import RobotError
from ...fields import LARGEST_NUMBER, LONGEST_NAME

MOST_BYTES = 5_000_000
_EXPAND = "expand it first: xacro robot.urdf.xacro > robot.urdf"
_PREFIX = re.compile(rb"[<\s/]([A-Za-z_][\w.-]*):[A-Za-z_]")
_MOST_PREFIXES = 50
"""More than a robot's file uses; each is looked for in the whole text."""
_ROOT_OR_COMMENT = re.compile(rb"<!--.*?-->|<robot(?=[\s/>])", re.DOTALL)
_OTHERS = {
    "mujoco": (
        "an MJCF, MuJoCo's format",
        (
            "convert it to a URDF, for instance in Python: pip install mjcf-urdf-simple-converter, then "
            "mjcf_urdf_simple_converter.convert('robot.xml', 'robot.urdf'); or describe the robot as JSON"
        ),
    ),
    "sdf": (
        "an SDF, Gazebo's format",
        (
            "convert it to a URDF, for instance in ROS: rosrun pysdf sdf2urdf.py robot.sdf robot.urdf; often "
            "the SDF was itself made from a URDF, which can be sent as it is; or describe the robot as JSON"
        ),
    ),
}


def parse_urdf(text: bytes | str) -> Element:
    """Parse a URDF and give its root element.

    Raises
    ------
    RobotError
        If the text is too large, malformed, holds entities or xacro, or is another kind of document.
    """
    if len(text) > MOST_BYTES:
        raise RobotError(
            "the URDF is too large",
            evidence={"bytes": len(text), "limit": MOST_BYTES},
            remedy="leave meshes and textures out; they are not read",
        )
    root = _parse(without_blank_start(text))
    _refuse_xacro_inside(root)
    if tag_of(root) != "robot":
        kind, remedy = _OTHERS.get(tag_of(root), ("", "send a document that starts with <robot name=...>"))
        raise RobotError(
            f"the document is {kind or 'not a URDF'}: its root element is not robot",
            evidence={"root": excerpt(tag_of(root))},
            remedy=remedy,
        )
    return root


def without_blank_start(text: bytes | str) -> bytes | str:
    """Leave out blanks and a byte order mark before the first tag; XML allows none before a declaration.

    Examples
    --------
    >>> without_blank_start(" <robot/>"), without_blank_start(b"<robot/>")
    ('<robot/>', b'<robot/>')
    """
    if isinstance(text, str):
        return text.lstrip("\ufeff \t\r\n")
    return text.removeprefix(b"\xef\xbb\xbf").lstrip(b" \t\r\n")


def _parse(text: bytes | str) -> Element:
    try:
        return _parse_mending_prefixes(text)
    except DefusedXmlException as error:
        raise RobotError(
            "the URDF holds a document type or entities, which are not read",
            evidence={"found": type(error).__name__},
            remedy="remove the DOCTYPE and write the values out",
        ) from error
    except (ParseError, ValueError, LookupError) as error:
        if b"xacro:" in _bytes(text):
            _refuse_xacro("an undeclared xacro prefix")
        raise RobotError(
            "the URDF is not well-formed XML",
            evidence={"parser": excerpt(str(error))},
            remedy="send one XML document: expanded, with one <robot> element and every tag closed",
        ) from error


def _parse_mending_prefixes(text: bytes | str) -> Element:
    try:
        root: Element = fromstring(text, forbid_dtd=True)
    except ParseError as error:
        if error.code != errors.codes[errors.XML_ERROR_UNBOUND_PREFIX]:
            raise
        root = fromstring(_with_prefixes_declared(text), forbid_dtd=True)
    return root


def _with_prefixes_declared(text: bytes | str) -> bytes:
    """Declare the prefixes that are used (``drake:acceleration``) but xacro's, which has to be expanded."""
    written = _bytes(text)
    used = {name for name in _PREFIX.findall(written) if name not in (b"xacro", b"xml", b"xmlns")}
    new = (name for name in sorted(used)[:_MOST_PREFIXES] if b"xmlns:" + name not in written)
    declared = b"".join(b' xmlns:%s="urn:undeclared:%s"' % (name, name) for name in new)
    root = next((found for found in _ROOT_OR_COMMENT.finditer(written) if found[0] == b"<robot"), None)
    return written if root is None else written[: root.end()] + declared + written[root.end() :]


def _bytes(text: bytes | str) -> bytes:
    return text.encode(errors="replace") if isinstance(text, str) else text


def _refuse_xacro_inside(root: Element) -> None:
    for element in root.iter():
        if element.tag.startswith("{") and "xacro" in element.tag.partition("}")[0]:
            _refuse_xacro(f"the element xacro:{tag_of(element)}")
        for value in element.attrib.values():
            if "${" in value or "$(" in value:
                _refuse_xacro(value)


def _refuse_xacro(found: str) -> None:
    raise RobotError(
        "the document is a xacro, not a URDF", evidence={"found": excerpt(found)}, remedy=_EXPAND
    ) from None


def tag_of(element: Element) -> str:
    """Give an element's name without its namespace."""
    return str(element.tag).rpartition("}")[2]


def children(element: Element, tag: str) -> list[Element]:
    """List the children of one name in the element's own namespace; extensions have others."""
    space = str(element.tag).rpartition("}")[0]
    wanted = f"{space}}}{tag}" if space else tag
    return [part for part in element if part.tag == wanted]


def child(element: Element, tag: str) -> Element | None:
    """Give the first child of one name; None where there is none."""
    return next(iter(children(element, tag)), None)


def required(element: Element, tag: str, where: str) -> Element:
    """Give the first child of one name.

    Raises
    ------
    RobotError
        If there is none.
    """
    found = child(element, tag)
    if found is None:
        raise RobotError(
            f"{where} has no {tag} element",
            evidence={"found": [tag_of(part) for part in element][:10]},
            remedy=f"add the {tag} element",
        )
    return found


def attribute(element: Element, name: str, where: str) -> str:
    """Give an attribute's text.

    Raises
    ------
    RobotError
        If it is missing or empty, or a name that no table would print.
    """
    value = element.get(name)
    if not value:
        raise RobotError(
            f"{where}: the element {tag_of(element)} has no {name}",
            evidence={"attributes": list(element.attrib)[:10]},
            remedy=f"add the attribute {name}" if value is None else f"fill in the attribute {name}",
        )
    if name == "name" and (len(value) > LONGEST_NAME or not value.isprintable()):
        raise RobotError(
            f"the name of a {tag_of(element)} is too long or cannot be printed",
            evidence={"name": excerpt(value), "characters": len(value), "limit": LONGEST_NAME},
            remedy="give it a short name",
        )
    return value


def number(element: Element, name: str, where: str, default: float | None = None) -> float:
    """Give an attribute as a number; a default where it is missing.

    Raises
    ------
    RobotError
        If it is no finite number.
    """
    if default is not None and element.get(name) is None:
        return default
    return float(_values(attribute(element, name, where), name, where, 1)[0])


def bound(element: Element, name: str, where: str) -> float | None:
    """Give a limit as a number; None where it is empty, infinite or no number, which writers mean as none.

    A missing one is zero, as URDF says.

    Raises
    ------
    RobotError
        If it is a word.
    """
    text = element.get(name, "0").strip()
    try:
        value = float(text or "nan")
    except ValueError:
        return number(element, name, where)
    return value if abs(value) <= LARGEST_NUMBER else None


def numbers(element: Element | None, name: str, where: str, default: tuple[float, float, float]) -> Vector3:
    """Give an attribute as three numbers; a default where it is missing.

    Raises
    ------
    RobotError
        If it does not hold three finite numbers.
    """
    if element is None or element.get(name) is None:
        return np.array(default)
    return _values(attribute(element, name, where), name, where, 3)


def _values(text: str, name: str, where: str, count: int) -> Vector:
    try:
        values = np.array([float(word) for word in text.split()])
    except ValueError:
        values = np.empty(0)
    if len(values) != count or not (np.abs(values) <= LARGEST_NUMBER).all():
        raise RobotError(
            f"{where}: {name} does not hold {count} finite number{'s' if count > 1 else ''}",
            evidence={name: excerpt(text)},
            remedy="write decimal numbers, separated by blanks",
        )
    return values


def excerpt(text: str) -> str:
    """Give at most eighty characters of a text, with escapes for what cannot be printed."""
    printable = text if text.isprintable() else repr(text)[1:-1]
    return printable if len(printable) <= 80 else printable[:77] + "..."
