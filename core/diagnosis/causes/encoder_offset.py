"""Suspect that a joint's zero is not where the robot's description has it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.encoder import EncoderOffset as EncoderOffsetTerm
from ...dynamics.terms.kinematic_error import link_of
from ...robot.model import Link, RobotModel
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Numbers, Scalars, Site
from .repairs import CorrectsRobot
from .shared.common import OwnJointCause, named, rounded, shown
from .shared.sites import revolute_joints

LARGEST = 0.5


@dataclass(frozen=True)
class EncoderOffset(OwnJointCause, CorrectsRobot):
    """Suspect a constant zero error of one encoder.

    The description is mended, not the log: a zero that is off is off in every log of the robot.
    """

    id = "encoder_offset"
    title = "The joint's zero is off"
    cure = "signal"
    units = (("offset", "rad"),)
    experiment = "motion of the joints beyond this one through their whole range, with this joint moving too"
    coordinate = "position"

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List the joints that turn."""
        del operating_point
        return [(joint,) for joint in revolute_joints(dataset.robot)]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del dataset, scalars
        return EncoderOffsetTerm(site[0], operating_point)

    def admissible(self, solved: FittedCause) -> bool:
        """Want an error that a first-order column can stand for."""
        return bool(abs(solved.values[0]) < LARGEST)

    def statement(self, solved: FittedCause) -> str:
        """Say by how much the reading is off."""
        found = named(self.quantities(solved))["offset"]
        return f"Joint {solved.site[0]}'s encoder reads the angle of the description plus {shown(found)}"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say where the description puts the joint's zero now."""
        link = link_of(robot, joints[0])
        entry, before = ("offset", link.offset) if link.row is None else ("theta_offset", link.row.theta)
        after = rounded(before - link.ratio * numbers["offset"], 4)
        return f"Joint {joints[0]}'s {entry} goes from {rounded(before, 4)} to {after} rad"

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Turn the zero of every link that the joint moves back by what the encoder reads too much."""
        (joint,) = joints
        links = (_turned(one, -numbers["offset"]) if one.joint == joint else one for one in robot.links)
        return replace(robot, links=tuple(links))


def _turned(link: Link, angle: float) -> Link:
    if link.row is None:
        return replace(link, offset=link.offset + link.ratio * angle)
    row = replace(link.row, theta=link.row.theta + link.ratio * angle)
    rotation, translation = row.placement()
    return replace(link, rotation=rotation, translation=translation, row=row)
