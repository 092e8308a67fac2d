"""Turn a URDF into a `RobotModel`: any axis, fixed joints merged, mimic joints kept, inertials as the prior.

Each moving link's frame is turned by the smallest angle that brings z onto the joint's axis; bodies are
expressed in the turned frame. A body welded to a moving link is added to it, one welded to the base moves
nothing and is dropped. Links are numbered depth first in document order, so that a serial arm is numbered
from base to tip. Which joints that are, `core.robot.urdf.part` decides.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast
from xml.etree.ElementTree import Element

import numpy as np

from ...arrays import LinkParameters, LinkTable, Rotation, Vector3
from ...errors import RobotError
from ...fields import LARGEST_NUMBER
from ..description import LEVEL_GRAVITY, MOST_JOINTS
from ..frames import nearest_rotation, rotation_to
from ..inertia import transform_body
from ..link_data import MOST_FRAMES
from ..model import Ball, Joint, JointKind, Link, NamedFrame, RobotModel
from .document import MOVING_KINDS, UrdfDocument, UrdfJoint, read_urdf_document
from .elements import child
from .part import Part, choose_part
from .remarks import urdf_remarks
from .shapes import Placement, link_ball

NAMELESS = "robot"
"""What a robot is called whose name is empty."""


@dataclass(frozen=True, eq=False)
class _Placed:
    """Hold where a URDF link ended up: the moving link it belongs to (0: the base) and its pose there."""

    number: int
    rotation: Rotation
    translation: Vector3


@dataclass(frozen=True)
class _Drive:
    """Hold what moves a link: a joint's own coordinate times ratio plus offset (rad or m)."""

    joint: str
    ratio: float = 1.0
    offset: float = 0.0


def robot_from_urdf(
    text: bytes | str,
    *,
    base_link: str | None = None,
    tip_link: str | Sequence[str] | None = None,
    gravity: Sequence[float] = LEVEL_GRAVITY,
) -> RobotModel:
    """Read a robot from a URDF.

    Parameters
    ----------
    text
        The expanded URDF (no xacro), at most 5 MB.
    base_link
        Link that stands still; the root link by default. What does not descend from it is left out, and not
        judged.
    tip_link
        Link at which a chain ends, or several (a text separates them by commas); the whole tree by default.
        Joints beside the chains are frozen at zero, so that the chains go on carrying their bodies.
    gravity
        Acceleration of gravity in the base link's frame, m/s2.

    Raises
    ------
    RobotError
        If the text is no URDF, the joints of the chosen part form no tree, or nothing in it moves.
    """
    document = read_urdf_document(text)
    down = np.array(gravity, dtype=float)
    if down.shape != (3,) or not (np.abs(down) <= LARGEST_NUMBER).all():
        raise RobotError(
            f"gravity is not three finite numbers of at most {LARGEST_NUMBER:g}",
            evidence={"gravity": str(gravity)[:80]},
            remedy="give the acceleration of gravity in the base frame, e.g. 0,0,-9.81",
        )
    part = choose_part(document, base_link, _tips(document, tip_link))
    return _assemble(document, part, down)


def _tips(document: UrdfDocument, tip_link: str | Sequence[str] | None) -> tuple[str, ...]:
    """List the chosen tips; a text with commas is one link only where a link is called so."""
    if not isinstance(tip_link, str):
        return tuple(tip_link or ())
    if tip_link in document.links:
        return (tip_link,)
    return tuple(name.strip() for name in tip_link.split(","))


def _drivers(part: Part) -> dict[str, UrdfJoint]:
    moving = {joint.name: joint for joint, moves in part if moves}
    if not 1 <= len(moving) <= MOST_JOINTS:
        raise RobotError(
            "too many joints move" if moving else "no joint moves",
            evidence={"moving": len(moving), "fixed": len(part) - len(moving), "limit": MOST_JOINTS},
            remedy="choose a chain of 1 to 64 moving joints with base_link and tip_link",
        )
    for joint in moving.values():
        joint.check_kind()
    return moving


def _assemble(document: UrdfDocument, part: Part, gravity: Vector3) -> RobotModel:
    by_name = _drivers(part)
    joints = tuple(Joint(joint.name, joint.limits) for joint in by_name.values() if joint.mimic is None)
    numbers = {joint.name: number for number, joint in enumerate(joints, start=1)}
    links: list[Link] = []
    bodies: list[LinkParameters] = []
    placed: dict[str, _Placed] = {}
    welded: list[list[tuple[Element, Placement]]] = []
    for joint, moves in part:
        parent = placed.get(joint.parent, _Placed(0, np.eye(3), np.zeros(3)))
        turned, shifted = joint.placement
        rotation = parent.rotation @ turned
        translation = parent.translation + parent.rotation @ shifted
        frame = _Placed(parent.number, rotation, translation)
        if moves:
            turn, drive = rotation_to(joint.axis), _drive(joint, by_name)
            kind = cast("JointKind", MOVING_KINDS[joint.kind])
            number = numbers[drive.joint]
            links.append(
                Link(
                    joint.child,
                    kind,
                    parent.number,
                    number,
                    rotation @ turn,
                    translation,
                    drive.ratio,
                    drive.offset,
                )
            )
            bodies.append(np.zeros(10))
            welded.append([])
            frame = _Placed(len(links), turn.T, np.zeros(3))
        placed[joint.child] = frame
        if frame.number:
            element = document.links[joint.child]
            welded[frame.number - 1].append((element, (frame.rotation, frame.translation)))
        body = document.body(joint.child) if frame.number else None
        if body is not None:
            bodies[frame.number - 1] += transform_body(body, frame.rotation, frame.translation)
    return RobotModel(
        name=document.name or NAMELESS,
        links=tuple(links),
        joints=joints,
        gravity=gravity,
        prior=_prior(document, part, bodies),
        frames=_frames(links, placed),
        remarks=urdf_remarks(document, part),
        shapes=_balls(welded),
    )


def _frames(links: list[Link], placed: dict[str, _Placed]) -> tuple[NamedFrame, ...]:
    """Name the frames of URDF links that are not frames of the robot: turned ones, and those at the ends."""
    own = {link.name for link in links}
    carrying = {link.antecedent for link in links}
    named: list[NamedFrame] = []
    for name, at in placed.items():
        moved = not np.array_equal(at.rotation, np.eye(3)) or at.translation.any()
        if at.number and (moved if name in own else at.number not in carrying):
            named.append(NamedFrame(name, at.number, nearest_rotation(at.rotation), at.translation))
    return tuple(named[:MOST_FRAMES])


def _balls(welded: list[list[tuple[Element, Placement]]]) -> tuple[Ball | None, ...] | None:
    """Give a ball for each moving link; None where no shape of any link is read."""
    balls = tuple(map(link_ball, welded))
    return balls if any(ball is not None for ball in balls) else None


def _prior(document: UrdfDocument, part: Part, bodies: list[LinkParameters]) -> LinkTable | None:
    """Give the links' bodies as a table; None where the document describes none."""
    known = any(child(document.links[joint.child], "inertial") is not None for joint, _ in part)
    return np.array(bodies) if known else None


def _drive(joint: UrdfJoint, moving: dict[str, UrdfJoint]) -> _Drive:
    """Follow a mimic joint to the joint that has a coordinate, collecting ratios and offsets on the way."""
    ratio, offset = 1.0, 0.0
    follower = joint
    for _ in moving:
        if follower.mimic is None:
            return _Drive(follower.name, ratio, offset)
        offset += ratio * follower.mimic.offset
        ratio *= follower.mimic.ratio
        if follower.mimic.joint not in moving:
            raise RobotError(
                f"joint {follower.name} mimics a joint that does not move",
                evidence={"mimics": follower.mimic.joint[:80], "moving": list(moving)[:20]},
                remedy="name a moving joint of the chosen part of the robot",
            )
        follower = moving[follower.mimic.joint]
    raise RobotError(
        "mimic joints form a loop",
        evidence={"joint": joint.name},
        remedy="let one of them have a coordinate of its own",
    )
