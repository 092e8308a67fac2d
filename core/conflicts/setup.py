"""Hold what is assumed of how a robot and its logs belong together, as one value that can be changed."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import JointMarks, Vector3
from ..log.columns.assignment import Assignment, Channels
from ..robot.model import Link, RobotModel

Part = tuple[str, int]
"""A part of a set-up: gravity, or the link, the position or the torque of a number, from 0."""


@dataclass(frozen=True, eq=False)
class Setup:
    """Hold a robot's description and the assignment of the measured channels to its joints."""

    robot: RobotModel
    assignment: Assignment

    @property
    def joints(self) -> int:
        """Count the joints."""
        return len(self.robot.joints)

    @property
    def uses_torque(self) -> JointMarks:
        """Mark the joints whose torque is used: those of the others are multiplied by zero."""
        return np.asarray(np.array(self.assignment.torque.factor) != 0.0)

    def with_position(self, channels: Channels) -> "Setup":
        """Assign the position channels in another way."""
        return replace(self, assignment=replace(self.assignment, position=channels))

    def with_torque(self, channels: Channels) -> "Setup":
        """Assign the torque channels in another way."""
        return replace(self, assignment=replace(self.assignment, torque=channels))

    def with_gravity(self, gravity: Vector3) -> "Setup":
        """Mount the robot in another way; gravity in the base frame, m/s2."""
        return replace(self, robot=replace(self.robot, gravity=gravity))

    def with_links(self, links: tuple[Link, ...]) -> "Setup":
        """Read the table in another way."""
        return replace(self, robot=replace(self.robot, links=links))

    def with_clock(self, factor: float) -> "Setup":
        """Multiply all stamps by a factor."""
        return replace(self, assignment=replace(self.assignment, time_factor=factor))

    def revolute(self) -> tuple[int, ...]:
        """List the joints, from 0, that only revolute links have."""
        prismatic = {link.joint - 1 for link in self.robot.links if link.kind == "prismatic"}
        return tuple(joint for joint in range(self.joints) if joint not in prismatic)

    def differing(self, other: "Setup") -> frozenset[Part]:
        """List the parts in which two set-ups differ."""
        own, others = self.parts, other.parts
        return frozenset(part for part, value in own.items() if value != others[part])

    def taking(self, parts: frozenset[Part], other: "Setup") -> "Setup":
        """Take some parts of another set-up."""
        own = {part: (other if part in parts else self) for part in self.parts}
        links = tuple(own["link", place].robot.links[place] for place in range(len(self.robot.links)))
        changed = self.with_gravity(own["gravity", 0].robot.gravity).with_links(links)
        joints = range(self.joints)
        positions, torques = (
            Channels.picked([getattr(own[kind, joint].assignment, kind) for joint in joints])
            for kind in ("position", "torque")
        )
        return changed.with_position(positions).with_torque(torques)

    @property
    def parts(self) -> dict[Part, object]:
        """Give every part."""
        links = {("link", place): link for place, link in enumerate(self.robot.links)}
        channels = {
            (kind, joint): whole.of_joint(joint)
            for kind, whole in (("position", self.assignment.position), ("torque", self.assignment.torque))
            for joint in range(self.joints)
        }
        return {("gravity", 0): tuple(self.robot.gravity), **links, **channels}
