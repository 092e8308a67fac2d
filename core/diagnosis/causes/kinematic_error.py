"""Suspect that one entry of the robot's table is wrong."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.kinematic_error import ENTRY_UNITS, EntryName, link_of, with_entry
from ...dynamics.terms.kinematic_error import KinematicError as KinematicErrorTerm
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Numbers, Quantity, Scalars, Site
from .repairs import CorrectsRobot
from .shared.common import OwnJointCause, named, rounded, shown
from .traits import SearchTraits

ENTRIES: tuple[EntryName, ...] = ("alpha", "d", "r")
LARGEST = 0.3
"""In rad and in m: beyond it the table is another robot's."""


@dataclass(frozen=True)
class KinematicError(OwnJointCause, CorrectsRobot):
    """Suspect one entry (alpha, d or r) of a link's modified DH row, by its place in `ENTRIES`."""

    id = "kinematic_error"
    title = "An entry of the kinematic table is wrong"
    cure = "robot"
    units = (("error", "rad or m"), ("alpha", "rad"), ("d", "m"), ("r", "m"))
    experiment = "quick motion of all joints at once: lengths show in products of velocities"
    coordinate = "position"
    traits = SearchTraits(discrete=("entry",))

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List the joints whose link has a row."""
        del operating_point
        joints = range(1, dataset.joints + 1)
        return [(joint,) for joint in joints if link_of(dataset.robot, joint).row is not None]

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """List the entries that are neither the joint's own stroke nor a shift of the whole robot."""
        del operating_point
        link = link_of(dataset.robot, site[0])
        kept = {
            "alpha": True,
            "d": link.antecedent > 0,
            "r": link.antecedent > 0 and link.kind == "revolute",
        }
        return [{"entry": float(code)} for code, entry in enumerate(ENTRIES) if kept[entry]]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del dataset
        return KinematicErrorTerm(site[0], operating_point, _entry(scalars))

    def admissible(self, solved: FittedCause) -> bool:
        """Want an error that a first-order column can stand for."""
        return bool(abs(solved.values[0]) < LARGEST)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the error, and once more under the name of its entry."""
        entry = _entry(solved.scalars)
        value, deviation = float(solved.values[0]), float(solved.covariance[0, 0]) ** 0.5
        return tuple(
            Quantity(name, solved.site[0], ENTRY_UNITS[entry], value, deviation) for name in ("error", entry)
        )

    def statement(self, solved: FittedCause) -> str:
        """Say which entry is off by how much."""
        found = named(self.quantities(solved))["error"]
        entry = _entry(solved.scalars)
        way, size = ("grow" if found.value > 0.0 else "shrink"), replace(found, value=abs(found.value))
        return f"Joint {solved.site[0]}'s {entry} in the kinematic table has to {way} by {shown(size)}"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say what the entry becomes."""
        entry = _reported(numbers)
        row = link_of(robot, joints[0]).row
        before = 0.0 if row is None else float(getattr(row, entry))
        after = rounded(before + numbers["error"], 4)
        return (
            f"Joint {joints[0]}'s {entry} in the kinematic table goes from {rounded(before, 4)} to "
            f"{after} {ENTRY_UNITS[entry]}"
        )

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Let the entry grow by the error."""
        return with_entry(robot, joints[0], _reported(numbers), numbers["error"])


def _reported(numbers: Numbers) -> EntryName:
    return next(entry for entry in ENTRIES if entry in numbers)


def _entry(scalars: Scalars) -> EntryName:
    return ENTRIES[round(scalars["entry"])]
