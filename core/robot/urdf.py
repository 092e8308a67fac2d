"""Turn a URDF into a `RobotModel`: any axis, fixed joints merged, mimic joints kept, inertials as the prior.

Each moving link's frame is turned by the smallest angle that brings z onto the joint's axis; bodies are
expressed in the turned frame. A body welded to a moving link is added to it, one welded to the base moves
nothing and is dropped. Links are numbered depth first in document order, so that a serial arm is numbered
from base to tip.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import cast

import numpy as np

from ..arrays import LinkParameters, LinkTable, Rotation, Vector3
from ..errors import RobotError
from ..fields import LARGEST_NUMBER
from .description import LEVEL_GRAVITY, MOST_JOINTS
from .frames import rotation_to
from .inertia import transform_body
from .model import Joint, JointKind, Link, RobotModel
from .urdf_document import MOVING_KINDS, UrdfDocument, UrdfJoint, read_urdf_document


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
    tip_link: str | None = None,
    gravity: Sequence[float] = LEVEL_GRAVITY,
) -> RobotModel:
    """Read a robot from a URDF.

    Parameters
    ----------
    text
        The expanded URDF (no xacro), at most 5 MB.
    base_link
        Link that stands still; the root link by default. What does not hang on it is left out.
    tip_link
        Link at which a chain ends; the whole tree by default. Joints beside the chain are frozen at zero, so
        that the chain goes on carrying their bodies.
    gravity
        Acceleration of gravity in the base link's frame, m/s2.

    Raises
    ------
    RobotError
        If the text is no URDF, its joints form no tree, or nothing in it moves.
    """
    document = read_urdf_document(text)
    down = np.array(gravity, dtype=float)
    if down.shape != (3,) or not (np.abs(down) <= LARGEST_NUMBER).all():
        raise RobotError(
            f"gravity is not three finite numbers of at most {LARGEST_NUMBER:g}",
            evidence={"gravity": str(gravity)[:80]},
            remedy="give the acceleration of gravity in the base frame, e.g. 0,0,-9.81",
        )
    return _assemble(document, _order(document, base_link, tip_link), down)


def _order(
    document: UrdfDocument, base_link: str | None, tip_link: str | None
) -> list[tuple[UrdfJoint, bool]]:
    """List the joints from the base outwards, depth first in document order, each with whether it moves."""
    children = _children(document)
    base = base_link or _only_root(document)
    for link in (base, tip_link or base):
        if link not in document.links:
            raise RobotError(
                "a chosen link does not exist",
                evidence={"link": link[:80], "links": list(document.links)[:20]},
                remedy="choose base_link and tip_link among the URDF's links",
            )
    joints = _depth_first(children, base)
    chain = set(map(attrgetter("name"), joints)) if tip_link is None else _chain(joints, base, tip_link)
    return [(joint, joint.kind != "fixed" and joint.name in chain) for joint in joints]


def _depth_first(children: Mapping[str, Sequence[UrdfJoint]], base: str) -> list[UrdfJoint]:
    """List all joints from a link outwards, depth first."""
    joints: list[UrdfJoint] = []
    waiting = list(reversed(children[base]))
    while waiting:
        joint = waiting.pop()
        joints.append(joint)
        waiting += reversed(children[joint.child])
    return joints


def _children(document: UrdfDocument) -> dict[str, list[UrdfJoint]]:
    children: dict[str, list[UrdfJoint]] = defaultdict(list)
    parent_of: dict[str, UrdfJoint] = {}
    for joint in document.joints:
        for role, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in document.links:
                raise RobotError(
                    f"joint {joint.name} names a {role} link that does not exist",
                    evidence={"link": link[:80], "links": list(document.links)[:20]},
                    remedy="name a link of the same URDF",
                )
        if joint.child in parent_of:
            raise RobotError(
                f"link {joint.child} hangs on two joints",
                evidence={"joints": [parent_of[joint.child].name, joint.name]},
                remedy="a URDF is a tree: cut the loop at one joint",
            )
        parent_of[joint.child] = joint
        children[joint.parent].append(joint)
    _refuse_cycles(parent_of)
    return children


def _refuse_cycles(parent_of: dict[str, UrdfJoint]) -> None:
    rooted: set[str] = set()
    for start in parent_of:
        path: dict[str, None] = {}
        link = start
        while link in parent_of and link not in rooted:
            if link in path:
                raise RobotError(
                    "the joints run in a circle",
                    evidence={"links": list(path)[:20]},
                    remedy="a URDF is a tree: cut the loop at one joint",
                )
            path[link] = None
            link = parent_of[link].parent
        rooted.update(path)


def _only_root(document: UrdfDocument) -> str:
    carried = {joint.child for joint in document.joints}
    roots = [link for link in document.links if link not in carried]
    if len(roots) != 1:
        raise RobotError(
            "the URDF has no link" if not roots else "the URDF has several root links",
            evidence={"roots": roots[:20]},
            remedy="join them by fixed joints, or choose one with base_link"
            if roots
            else "describe links and joints",
        )
    return roots[0]


def _chain(joints: list[UrdfJoint], base: str, tip: str) -> set[str]:
    above = {joint.child: joint for joint in joints}
    chain: set[str] = set()
    link = tip
    while link != base:
        if link not in above:
            raise RobotError(
                "tip_link does not hang on base_link",
                evidence={"base_link": base, "tip_link": tip},
                remedy="choose a tip that the base carries",
            )
        chain.add(above[link].name)
        link = above[link].parent
    return chain


def _drivers(order: list[tuple[UrdfJoint, bool]]) -> dict[str, UrdfJoint]:
    moving = {joint.name: joint for joint, moves in order if moves}
    if not 1 <= len(moving) <= MOST_JOINTS:
        raise RobotError(
            "too many joints move" if moving else "no joint moves",
            evidence={"moving": len(moving), "fixed": len(order) - len(moving), "limit": MOST_JOINTS},
            remedy="choose a chain of 1 to 64 moving joints with base_link and tip_link",
        )
    return moving


def _assemble(document: UrdfDocument, order: list[tuple[UrdfJoint, bool]], gravity: Vector3) -> RobotModel:
    by_name = _drivers(order)
    joints = tuple(Joint(joint.name, joint.limits) for joint in by_name.values() if joint.mimic is None)
    numbers = {joint.name: number for number, joint in enumerate(joints, start=1)}
    links: list[Link] = []
    bodies: list[LinkParameters] = []
    placed: dict[str, _Placed] = {}
    for joint, moves in order:
        parent = placed.get(joint.parent, _Placed(0, np.eye(3), np.zeros(3)))
        rotation = parent.rotation @ joint.rotation
        translation = parent.translation + parent.rotation @ joint.translation
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
            frame = _Placed(len(links), turn.T, np.zeros(3))
        placed[joint.child] = frame
        body = document.links[joint.child]
        if body is not None and frame.number:
            bodies[frame.number - 1] += transform_body(body, frame.rotation, frame.translation)
    return RobotModel(
        name=document.name,
        links=tuple(links),
        joints=joints,
        gravity=gravity,
        prior=_prior(document, order, bodies),
    )


def _prior(
    document: UrdfDocument, order: list[tuple[UrdfJoint, bool]], bodies: list[LinkParameters]
) -> LinkTable | None:
    """Give the links' bodies as a table; None where the document describes none."""
    known = any(document.links[joint.child] is not None for joint, _ in order)
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
        "mimic joints follow each other in a circle",
        evidence={"joint": joint.name},
        remedy="let one of them have a coordinate of its own",
    )
