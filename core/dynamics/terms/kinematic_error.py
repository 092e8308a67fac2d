"""Give the effect of a wrong entry of the kinematic table: the true minus the described geometry's load.

The bodies stay as they are in their own frames; the frame of one link has another place on its antecedent.
The column is the change per unit of the entry. Source: Khalil & Dombre (2002), ch. 11.
"""

from dataclasses import dataclass, replace
from typing import Literal

from ...arrays import JointSeries
from ...robot.model import Link, RobotModel
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import AllJointsTerm, Symbol

EntryName = Literal["alpha", "d", "r"]
ENTRY_UNITS: dict[EntryName, str] = {"alpha": "rad", "d": "m", "r": "m"}
SMALL = 1e-5


@dataclass(frozen=True, eq=False)
class KinematicError(AllJointsTerm):
    """Model an entry (rad or m) of a link's modified DH row that is larger by `error` than described."""

    believed: Prediction
    entry: EntryName
    kind = "kinematic_error"
    loads = True

    @property
    def name(self) -> str:
        """Name the effect together with its entry and joint."""
        return f"{self.kind}_{self.entry}_{self.joint}"

    @property
    def symbols(self) -> tuple[Symbol, ...]:  # type: ignore[override]  # the unit is the entry's
        """Name the error with the unit of its entry."""
        return (("error", ENTRY_UNITS[self.entry], None),)

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of load per unit of the entry."""
        changed = with_entry(robot, self.joint, self.entry, SMALL)
        return [(self.believed.load(state, changed) - self.believed.load(state, robot)) / SMALL]


def with_entry(robot: RobotModel, joint: int, entry: EntryName, error: float) -> RobotModel:
    """Add an error (rad or m) to an entry of the row by which a joint's link is placed (joint from 1)."""
    wrong = link_of(robot, joint)
    links = tuple(_shift_entry(link, entry, error) if link is wrong else link for link in robot.links)
    return replace(robot, links=links)


def link_of(robot: RobotModel, joint: int) -> Link:
    """Give the first link that a joint (from 1) moves."""
    return next(link for link in robot.links if link.joint == joint)


def _shift_entry(link: Link, entry: EntryName, error: float) -> Link:
    if link.row is None:
        return link
    changes = {"alpha": link.row.alpha, "d": link.row.d, "r": link.row.r}
    row = replace(link.row, **{entry: changes[entry] + error})
    rotation, translation = row.placement()
    return replace(link, rotation=rotation, translation=translation, row=row)
