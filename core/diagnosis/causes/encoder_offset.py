"""Suspect that a joint's zero is not where the robot's description has it."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.diagnosis.cause import Confusion, Scalars, Site, Solved
from core.diagnosis.causes.common import OwnJointCause, named, shown
from core.diagnosis.causes.sites import revolute_joints
from core.diagnosis.look import Look
from core.dynamics.prediction import Prediction
from core.dynamics.term import Term
from core.dynamics.terms.encoder import EncoderOffset as EncoderOffsetTerm

LARGEST = 0.5


@dataclass(frozen=True)
class EncoderOffset(OwnJointCause):
    """Suspect a constant zero error of one encoder."""

    id = "encoder_offset"
    # What a first-order column leaves of a large angle looks like a small error of a length.
    excludes = ("kinematic_error",)
    title = "The joint's zero is off"
    cure = "signal"
    units = (("offset", "rad"),)
    confusions = (
        Confusion(
            "kinematic_error",
            "a zero error of the joint is the same as an error of theta in its row",
            "measure the tool's position against the joint angles: torque alone cannot separate the two",
        ),
        Confusion(
            "gravity_misalignment",
            "joints that carry the arm against gravity see a tilted base like a zero error",
            "turn the first joint by half a turn: the effect of a tilted base changes its sign",
        ),
    )
    experiment = "motion of the joints beyond this one through their whole range, with this joint moving too"
    coordinate = "position"

    def sites(self, look: Look, believed: Prediction) -> Sequence[Site]:
        """List the joints that turn."""
        del believed
        return [(joint,) for joint in revolute_joints(look.robot)]

    def term(self, look: Look, believed: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del look, scalars
        return EncoderOffsetTerm(site[0], believed)

    def possible(self, solved: Solved) -> bool:
        """Want an error that a first-order column can stand for."""
        return bool(abs(solved.values[0]) < LARGEST)

    def statement(self, solved: Solved) -> str:
        """Say by how much the reading is off."""
        found = named(self.quantities(solved))["offset"]
        return f"Joint {solved.site[0]}'s encoder reads the angle of the description plus {shown(found)}"
