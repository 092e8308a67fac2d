"""Read how large the links of a URDF are, from their boxes, cylinders and spheres; meshes are not read.

Only the size matters here, so a shape that cannot be read is not known, and refuses nothing.
"""

from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np

from ...arrays import Rotation, Vector3
from ...errors import RobotError
from ..model import Ball
from .document import pose
from .elements import child, children, number, numbers

Placement = tuple[Rotation, Vector3]


def link_ball(links: Sequence[tuple[Element, Placement]]) -> Ball | None:
    """Give a ball that holds the links of a URDF that move together, in the frame they are placed in.

    None where one of them has a mass and no shape that is read, or where none has a shape.
    """
    balls: list[Ball] = []
    for link, (rotation, translation) in links:
        own = _shapes(link)
        if not own and (child(link, "inertial") is not None or _is_drawn(link)):
            return None
        balls += [_moved(ball, rotation, translation) for ball in own]
    return Ball.joined(balls) if balls else None


def _moved(ball: Ball, rotation: Rotation, translation: Vector3) -> Ball:
    x, y, z = map(float, translation + rotation @ np.array(ball.centre))
    return Ball((x, y, z), ball.radius)


def _is_drawn(link: Element) -> bool:
    return bool(children(link, "collision") or children(link, "visual"))


def _shapes(link: Element) -> list[Ball]:
    """List the shapes for collisions, or else the drawn ones; none where one of them is a mesh."""
    for kind in ("collision", "visual"):
        try:
            balls = [_shape(element) for element in children(link, kind)]
        except RobotError:
            continue
        known = [ball for ball in balls if ball is not None]
        if known and len(known) == len(balls):
            return known
    return []


def _shape(element: Element) -> Ball | None:
    """Give the ball about one shape; None where it is none that is read."""
    where, geometry = "the shape", child(element, "geometry")
    _, centre = pose(element, where)
    x, y, z = map(float, centre)
    if geometry is None:
        return None
    if (box := child(geometry, "box")) is not None:
        return Ball((x, y, z), 0.5 * float(np.linalg.norm(numbers(box, "size", where, (0.0, 0.0, 0.0)))))
    if (cylinder := child(geometry, "cylinder")) is not None:
        half = 0.5 * number(cylinder, "length", where)
        return Ball((x, y, z), float(np.hypot(number(cylinder, "radius", where), half)))
    if (sphere := child(geometry, "sphere")) is not None:
        return Ball((x, y, z), abs(number(sphere, "radius", where)))
    return None
