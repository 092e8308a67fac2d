"""Choose the part of a URDF that is wanted: what descends from a base link, up to the tips.

Only joints of this part are judged. A floating base above the chosen one, or a loop elsewhere, does no harm.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from itertools import chain
from operator import attrgetter

from ...errors import RobotError
from .document import UrdfDocument, UrdfJoint

Part = list[tuple[UrdfJoint, bool]]
"""Joints from the base outwards, depth first in document order, each with whether it moves."""


def choose_part(document: UrdfDocument, base_link: str | None, tips: Sequence[str]) -> Part:
    """List the joints of the chosen part.

    Parameters
    ----------
    base_link
        Link that stands still; None for the only root.
    tips
        Links at which chains end; none for the whole tree.

    Raises
    ------
    RobotError
        If a link does not exist, a tip does not descend from the base, or the part is no tree.
    """
    for link in (base_link, *tips):
        if link is not None and link not in document.links:
            raise RobotError(
                "a chosen link does not exist",
                evidence={"link": link[:80], "links": list(document.links)[:20]},
                remedy="choose base_link and tip_link among the URDF's links",
            )
    carried = _hanging_on(document, base_link)
    _check_tree(document, carried)
    base = base_link or _only_root(document)
    joints = _depth_first(carried, base)
    moving = set(map(attrgetter("name"), joints))
    if tips:
        moving = set(chain(*map(partial(_chain, joints, base), tips)))
    return [(joint, joint.kind != "fixed" and joint.name in moving) for joint in joints]


def _hanging_on(document: UrdfDocument, base_link: str | None) -> list[UrdfJoint]:
    """List the joints that hang on a link, in document order; all of them where none is chosen."""
    if base_link is None:
        return list(document.joints)
    children = _by_parent(document.joints)
    reached, waiting = {base_link}, [base_link]
    while waiting:
        new = {joint.child for joint in children.get(waiting.pop(), ())} - reached
        reached |= new
        waiting += new
    return [joint for joint in document.joints if joint.parent in reached]


def _by_parent(joints: Iterable[UrdfJoint]) -> Mapping[str, list[UrdfJoint]]:
    children: dict[str, list[UrdfJoint]] = defaultdict(list)
    for joint in joints:
        children[joint.parent].append(joint)
    return children


def _depth_first(joints: Sequence[UrdfJoint], base: str) -> list[UrdfJoint]:
    """List joints from a link outwards, depth first."""
    children = _by_parent(joints)
    found: list[UrdfJoint] = []
    waiting = list(reversed(children.get(base, ())))
    while waiting:
        joint = waiting.pop()
        found.append(joint)
        waiting += reversed(children.get(joint.child, ()))
    return found


def _check_tree(document: UrdfDocument, joints: Sequence[UrdfJoint]) -> None:
    parent_of: dict[str, UrdfJoint] = {}
    for joint in joints:
        for role, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in document.links:
                raise RobotError(
                    f"joint {joint.name} names a {role} link that does not exist",
                    evidence={"link": link[:80], "links": list(document.links)[:20]},
                    remedy="name a link of the same URDF",
                )
        if joint.child in parent_of:
            raise RobotError(
                f"link {joint.child} has two parent joints",
                evidence={"joints": [parent_of[joint.child].name, joint.name]},
                remedy="a URDF is a tree: cut the loop at one joint",
            )
        parent_of[joint.child] = joint
    _refuse_cycles(parent_of)


def _refuse_cycles(parent_of: dict[str, UrdfJoint]) -> None:
    rooted: set[str] = set()
    for start in parent_of:
        path: dict[str, None] = {}
        link = start
        while link in parent_of and link not in rooted:
            if link in path:
                raise RobotError(
                    "the joints form a loop",
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
                "tip_link does not descend from base_link",
                evidence={"base_link": base, "tip_link": tip},
                remedy="choose a tip that the base carries",
            )
        chain.add(above[link].name)
        link = above[link].parent
    return chain
