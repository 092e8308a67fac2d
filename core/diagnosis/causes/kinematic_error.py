"""Suspect that one entry of the robot's table is wrong; one cause per entry, all under one name."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.diagnosis.cause import Confusion, Quantity, Scalars, Site, Solved
from core.diagnosis.causes.common import OwnJointCause, shown
from core.diagnosis.look import Look
from core.dynamics.prediction import Prediction
from core.dynamics.term import Term
from core.dynamics.terms.kinematic_error import ENTRY_UNITS, EntryName, link_of
from core.dynamics.terms.kinematic_error import KinematicError as KinematicErrorTerm

LARGEST = 0.3
"""In rad and in m: beyond it the table is another robot's."""


@dataclass(frozen=True)
class KinematicError(OwnJointCause):
    """Suspect one entry (alpha, d or r) of a link's modified DH row."""

    entry: EntryName = "alpha"
    id = "kinematic_error"
    title = "An entry of the kinematic table is wrong"
    cure = "robot"
    confusions = (
        Confusion(
            "encoder_offset",
            "an angle that is wrong in the table and one that is wrong in the encoder turn the same bodies",
            "measure the tool's position against the joint angles",
        ),
        Confusion(
            "gravity_misalignment",
            "an angle of the first links turns the whole arm, as a tilted base does",
            "measure the base with a level",
        ),
    )
    experiment = "quick motion of all joints at once: lengths show in products of velocities"
    coordinate = "position"

    def sites(self, look: Look, believed: Prediction) -> Sequence[Site]:
        """List the joints whose link has a row, where the entry is not its own stroke or a shift of all."""
        del believed
        found = []
        for joint in range(1, look.joints + 1):
            link = link_of(look.robot, joint)
            shifts_all = link.antecedent == 0 and self.entry != "alpha"
            own_stroke = link.kind == "prismatic" and self.entry == "r"
            if link.row is not None and not shifts_all and not own_stroke:
                found.append((joint,))
        return found

    def term(self, look: Look, believed: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del look, scalars
        return KinematicErrorTerm(site[0], believed, self.entry)

    def possible(self, solved: Solved) -> bool:
        """Want an error that a first-order column can stand for."""
        return bool(abs(solved.values[0]) < LARGEST)

    def quantities(self, solved: Solved) -> tuple[Quantity, ...]:
        """Report the error under its entry's name."""
        value, deviation = float(solved.values[0]), float(solved.covariance[0, 0]) ** 0.5
        return (Quantity(f"error_{self.entry}", solved.site[0], ENTRY_UNITS[self.entry], value, deviation),)

    def statement(self, solved: Solved) -> str:
        """Say which entry is off by how much."""
        (found,) = self.quantities(solved)
        return f"Joint {solved.site[0]}'s {self.entry} in the kinematic table is too small by {shown(found)}"


ENTRIES: tuple[EntryName, ...] = ("alpha", "d", "r")
"""The entries that are suspected, each by a cause of its own."""
