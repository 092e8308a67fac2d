"""Candidate cause: a joint's zero that differs from the robot's description."""

from dataclasses import dataclass, replace

from ...dynamics.term import Term
from ...dynamics.terms.encoder_error import EncoderOffset as EncoderOffsetTerm
from ...dynamics.terms.kinematic_error import link_of
from ...robot.model import Link, RobotModel
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, SearchTraits, Setting, Site, number_text
from .repairs import CorrectsRobot
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class EncoderOffset(OwnJointCause, CorrectsRobot):
    """Candidate cause: a constant zero error of one encoder.

    The description is corrected, not the log: a zero error is in every log of the robot.
    """

    id = "encoder_offset"
    title = "Encoder zero error"
    cure = "signal"
    units = (("offset", "rad"),)
    experiment = "motion of the joints beyond this one through their whole range, with this joint moving too"
    coordinate = "position"
    traits = SearchTraits(largest=ADMISSIBLE.encoder_offset)
    revolute_only = True

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return EncoderOffsetTerm(at.joint, at.operating_point)

    def admissible(self, solved: FittedCause) -> bool:
        """Admit an error that a first-order column can represent."""
        return bool(abs(solved.values[0]) < ADMISSIBLE.encoder_offset)

    def statement(self, solved: FittedCause) -> str:
        """State the zero error."""
        found = self.by_name(solved)["offset"]
        return (
            f"Encoder zero error on joint {solved.site[0]}: the reading is the described angle plus "
            f"{found.text}"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State the joint's zero before and after."""
        link = link_of(robot, joints[0])
        entry, before = ("offset", link.offset) if link.row is None else ("theta_offset", link.row.theta)
        after = number_text(before - link.ratio * numbers["offset"], 4)
        return f"Joint {joints[0]}'s {entry} goes from {number_text(before, 4)} to {after} rad"

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Turn the zero of every link that the joint moves back by the zero error."""
        (joint,) = joints
        links = (_rotated(link, -numbers["offset"]) if link.joint == joint else link for link in robot.links)
        return replace(robot, links=tuple(links))


def _rotated(link: Link, angle: float) -> Link:
    if link.row is None:
        return replace(link, offset=link.offset + link.ratio * angle)
    row = replace(link.row, theta=link.row.theta + link.ratio * angle)
    rotation, translation = row.placement()
    return replace(link, rotation=rotation, translation=translation, row=row)
