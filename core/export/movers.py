"""Place every link as URDF, MJCF and SDF require it: a joint whose coordinate is the log's, about an axis.

Our links move about z by a ratio times a coordinate plus an offset. Those formats know the ratio only for a
joint that mimics another: here the offset of a joint with a coordinate of its own goes into the placement,
and a turned sign into the axis.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Rotation, Vector3
from ..errors import RobotError
from ..robot.frames import rotation_z
from ..robot.model import Joint, JointKind, Link, RobotModel


@dataclass(frozen=True)
class Following:
    """Say that a joint moves by ratio times another joint's coordinate plus offset (rad or m)."""

    master: str
    ratio: float
    offset: float


@dataclass(frozen=True, eq=False)
class Mover:
    """Place one link and the joint that moves it."""

    name: str
    """The joint's name, which no other mover has."""
    link: Link
    kind: JointKind
    parent: int
    """Number of the link that carries it, 0 for the base."""
    rotation: Rotation
    translation: Vector3
    """Rotation and translation (m): the pose on the carrier at zero coordinate."""
    sign: float
    """1 or -1: the axis is this times the link's z axis."""
    joint: Joint
    """The joint coordinate, with limits and drive; what mimics has none of its own."""
    following: Following | None

    @property
    def range(self) -> tuple[float, float] | None:
        """Give the limits of its own coordinate, rad or m; None where unknown."""
        limits = self.joint.limits.position
        if self.following is None or limits is None:
            return limits
        ends = sorted(self.following.ratio * end + self.following.offset for end in limits)
        return ends[0], ends[1]


def movers(robot: RobotModel) -> tuple[Mover, ...]:
    """Place all links.

    Raises
    ------
    RobotError
        If a joint turns none of its links by its own coordinate.
    """
    owners = {_owner(robot, number): joint for number, joint in enumerate(robot.joints, start=1)}
    taken = [joint.name for joint in robot.joints]
    placed: list[Mover] = []
    for index, link in enumerate(robot.links):
        if index in owners:
            placed.append(_own_mover(link, owners[index]))
        else:
            name = free_name(link.name, taken)
            taken.append(name)
            placed.append(_mimic_mover(link, robot.joints[link.joint - 1], name))
    return tuple(placed)


def free_name(wanted: str, taken: list[str]) -> str:
    """Give a name that nothing has yet.

    Examples
    --------
    >>> free_name("base", ["base", "arm"])
    'base_'
    """
    while wanted in taken:
        wanted += "_"
    return wanted


def _owner(robot: RobotModel, number: int) -> int:
    """Choose the link, counted from 0, that moves as the joint's coordinate does."""
    moved = [(index, link) for index, link in enumerate(robot.links) if link.joint == number]
    turned = [(index, link) for index, link in moved if abs(link.ratio) == 1.0]
    if not turned:
        joint = robot.joints[number - 1].name
        raise RobotError(
            f"no link moves by the coordinate of joint {joint}, and the format cannot scale a coordinate",
            evidence={"joint": joint, "ratios": [link.ratio for _, link in moved]},
            remedy="describe the joint by its own coordinate, and scale the log instead",
        )
    index, _ = min(turned, key=lambda pair: (pair[1].ratio, pair[1].offset) != (1.0, 0.0))
    return index


def _own_mover(link: Link, joint: Joint) -> Mover:
    rotation, translation = link.rotation, link.translation
    if link.offset and link.kind == "revolute":
        rotation = np.asarray(rotation @ rotation_z(link.offset))
    elif link.offset:
        translation = translation + link.offset * rotation[:, 2]
    return Mover(joint.name, link, link.kind, link.antecedent, rotation, translation, link.ratio, joint, None)


def _mimic_mover(link: Link, joint: Joint, name: str) -> Mover:
    following = Following(joint.name, link.ratio, link.offset)
    return Mover(
        name, link, link.kind, link.antecedent, link.rotation, link.translation, 1.0, joint, following
    )
