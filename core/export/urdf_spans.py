"""Find where in a URDF's bytes its links and joints stand, so that they can be changed and nothing else."""

import re
from dataclasses import dataclass, field
from xml.parsers import expat

from ..robot.urdf.elements import without_blank_start

Span = tuple[int, int]
"""First byte and the one after the last."""
_TAG = re.compile(rb"<(?:\"[^\"]*\"|'[^']*'|[^\"'>])*>")
_TYPE = re.compile(rb"\stype\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")


@dataclass
class Element:
    """Hold where a link, a joint or the whole robot stands."""

    inside: Span
    """Where more can be put: an empty span after the start tag, or the ``/>`` of an element without
    content."""
    kind: Span = (0, 0)
    """The value of its attribute `type`, between the quotes."""
    parts: dict[str, Span] = field(default_factory=dict)
    """Its children `inertial` and `dynamics`, from ``<`` to ``>``."""


@dataclass
class Elements:
    """Hold the robot, its links and its joints by name."""

    root: Element = field(default_factory=lambda: Element((0, 0)))
    links: dict[str, Element] = field(default_factory=dict)
    joints: dict[str, Element] = field(default_factory=dict)


def find_elements(text: bytes) -> Elements:
    """Find the elements of a URDF that is known to be well-formed and free of document types."""
    found, open_tags = Elements(), list[tuple[str, int]]()
    current = found.root
    parser = expat.ParserCreate()
    whole = without_blank_start(text)
    skipped = len(text) - len(whole)

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal current
        begin = parser.CurrentByteIndex + skipped
        open_tags.append((tag, begin))
        if len(open_tags) == 1:
            found.root.inside = _inside(text, begin)
        elif len(open_tags) == 2 and tag in ("link", "joint"):
            current = Element(_inside(text, begin), _kind(text, begin))
            (found.links if tag == "link" else found.joints)[attributes["name"]] = current

    def end(tag: str) -> None:
        _, begin = open_tags.pop()
        if len(open_tags) == 2 and tag in ("inertial", "dynamics"):
            low, high = _inside(text, begin)
            stop = high if high > low else _after(text, parser.CurrentByteIndex + skipped)
            current.parts[tag] = (begin, stop)

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(whole, True)  # noqa: FBT003  (the signature of expat)
    return found


def _after(text: bytes, begin: int) -> int:
    """Give the byte after the tag that starts at a place."""
    tag = _TAG.match(text, begin)
    return tag.end() if tag else begin


def _inside(text: bytes, begin: int) -> Span:
    end = _after(text, begin)
    return (end - 2, end) if text[end - 2 : end] == b"/>" else (end, end)


def _kind(text: bytes, begin: int) -> Span:
    found = _TYPE.search(text, begin, _after(text, begin))
    return (0, 0) if found is None else found.span(1 if found.group(1) is not None else 2)
