"""Find the joints and links of a robot at which a cause makes sense."""

from ....robot.model import RobotModel


def revolute_joints(robot: RobotModel) -> tuple[int, ...]:
    """List the joints (from 1) that turn a link.

    Where a joint moves several links, its first one decides.
    """
    kinds = {link.joint: link.kind for link in reversed(robot.links)}
    return tuple(joint for joint in sorted(kinds) if kinds[joint] == "revolute")


def end_links(robot: RobotModel) -> dict[int, int]:
    """Give the links (from 1) that carry no other and follow their joint one to one, by their joint."""
    carriers = {link.antecedent for link in robot.links}
    return {
        link.joint: number
        for number, link in enumerate(robot.links, start=1)
        if number not in carriers and link.ratio == 1.0
    }


def links_by_joint(robot: RobotModel) -> dict[int, int]:
    """Give the first link (from 1) of every joint that it follows one to one, by the joint."""
    numbered = list(enumerate(robot.links, start=1))
    return {link.joint: number for number, link in reversed(numbered) if link.ratio == 1.0}
