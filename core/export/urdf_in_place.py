"""Put identified inertials and friction into a URDF that somebody has, and leave every other byte as it is.

Meshes, comments, sensors and extensions stay, because the text is changed where a body or a friction stands
and nowhere else. A body welded to a moving link is part of the link's identified body: its own is taken out.
"""

import re
from collections.abc import Iterable, Sequence
from xml.etree import ElementTree as ET

import numpy as np

from ..document.model.caveats import caveats
from ..document.model.identified import IdentifiedRobot
from ..errors import RobotError
from ..robot.differences import differences
from ..robot.frames import rotation_to
from ..robot.inertia import transform_body
from ..robot.model import RobotModel
from ..robot.urdf.document import UrdfDocument, read_urdf_document
from ..robot.urdf.read import robot_from_urdf
from .elements import comment, text_of
from .urdf import left_out, write_inertial
from .urdf_spans import Element, Span, find_elements

Edit = tuple[Span, str]
"""Bytes from, up to, and what to put there."""


def urdf_with_inertials(
    text: bytes,
    identified: IdentifiedRobot,
    *,
    base_link: str | None = None,
    tip_link: str | Sequence[str] | None = None,
) -> bytes:
    """Put an identified robot's bodies and friction into its URDF.

    Parameters
    ----------
    text
        The URDF that the robot was made from.
    base_link, tip_link
        As they were given when the robot was made from it.

    Raises
    ------
    RobotError
        If the text is no URDF in UTF-8, or describes another robot than the identified one.
    OptionError
        If the model has no bodies, or one of them is physically inconsistent.
    """
    own = robot_from_urdf(text, base_link=base_link, tip_link=tip_link)
    _check_alike(own, identified.robot)
    if b"\0" in text:
        raise RobotError(
            "the URDF is not written in UTF-8",
            evidence={"starts": repr(text[:20])},
            remedy="save it as UTF-8",
        )
    document, elements = read_urdf_document(text), find_elements(text)
    names = [link.name for link in own.links]
    carriers = _carriers(document, set(names))
    edits = [
        (elements.root.inside, _header(identified)),
        *_bodies(document, elements.links, dict(zip(names, identified.bodies, strict=True)), carriers),
        *_drives(elements.joints, identified, own),
        *_fix_joints(document, elements.joints, carriers, set(names)),
    ]
    return _apply_edits(text, edits)


def _check_alike(own: RobotModel, identified: RobotModel) -> None:
    """Compare placements only: what drives the joints, and which way is down, a URDF cannot say."""
    bare = RobotModel(own.name, own.links, own.joints, np.zeros(3))
    differing = (
        differences(bare, RobotModel(identified.name, identified.links, own.joints, np.zeros(3)))
        if len(own.joints) == len(identified.joints)
        else ("the number of joints",)
    )
    if differing:
        raise RobotError(
            "the URDF describes another robot than the identified one",
            evidence={"differ": list(differing)[:10]},
            remedy="give the URDF, base_link and tip_link that the robot was made from; for a repaired robot "
            "take the URDF that is written anew",
        )


def _carriers(document: UrdfDocument, moving: set[str]) -> dict[str, str]:
    """Say for every link that rides on a moving one which that is."""
    above = {joint.child: joint.parent for joint in document.joints}
    carriers: dict[str, str] = {}
    for link in document.links:
        carrier = above.get(link)
        while link not in moving and carrier is not None and carrier not in moving:
            carrier = above.get(carrier)
        if link not in moving and carrier is not None:
            carriers[link] = carrier
    return carriers


def _bodies(
    document: UrdfDocument, links: dict[str, Element], bodies: dict[str, np.ndarray], carriers: dict[str, str]
) -> Iterable[Edit]:
    axes = {joint.child: joint.axis for joint in document.joints if joint.child in bodies}
    for name, element in links.items():
        if name in bodies:
            part = ET.Element("link")
            write_inertial(part, transform_body(bodies[name], rotation_to(axes[name]), np.zeros(3)))
            ET.indent(part, level=1)
            yield element.parts.get("inertial", element.inside), _inner_xml(part)
        elif name in carriers and "inertial" in element.parts:
            yield element.parts["inertial"], _comment(f"its body is part of link {carriers[name]}'s")


def _drives(joints: dict[str, Element], identified: IdentifiedRobot, own: RobotModel) -> Iterable[Edit]:
    """Write friction where the model has it; joints are the URDF's by number."""
    values = identified.values
    for number, joint in enumerate(own.joints, start=1):
        if f"FV{number}" in values or f"FC{number}" in values:
            viscous, coulomb = (values.get(f"{symbol}{number}", 0.0) for symbol in ("FV", "FC"))
            element = joints[joint.name]
            written = f'<dynamics damping="{text_of(viscous)}" friction="{text_of(coulomb)}"/>'
            yield element.parts.get("dynamics", element.inside), written


def _fix_joints(
    document: UrdfDocument, joints: dict[str, Element], carriers: dict[str, str], moving: set[str]
) -> Iterable[Edit]:
    """Fix joints beside a chosen chain: their links were identified at zero, with what carries them."""
    for joint in document.joints:
        if joint.kind != "fixed" and joint.child not in moving and joint.child in carriers:
            element = joints[joint.name]
            yield element.kind, "fixed"
            yield element.inside, _comment(f"was {joint.kind}: its links were identified at zero")


def _header(identified: IdentifiedRobot) -> str:
    part = ET.Element("robot")
    comment(part, (*caveats(identified), *left_out(identified, "URDF")))
    return _inner_xml(part)


def _inner_xml(part: ET.Element) -> str:
    """Write what an element holds."""
    return "\n  " + "".join(ET.tostring(child, encoding="unicode") for child in part).strip() + "\n  "


def _comment(sentence: str) -> str:
    return "<!-- " + re.sub("-(?=-)", "- ", sentence) + " -->"


def _apply_edits(text: bytes, edits: Iterable[Edit]) -> bytes:
    """Replace spans, the last one first; an empty element that is filled is opened."""
    for (start, stop), written in sorted(edits, reverse=True):
        new = written.encode("ascii", "xmlcharrefreplace")
        if text[start:stop] == b"/>":
            tag = re.match(rb"[^\s>/]+", text[text.rindex(b"<", 0, start) + 1 :])
            new = b">" + new + b"</" + (tag.group() if tag else b"") + b">"
        text = text[:start] + new + text[stop:]
    return text
