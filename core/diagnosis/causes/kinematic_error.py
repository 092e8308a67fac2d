"""Candidate cause: a wrong entry of the kinematic table."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...dynamics.term import Term
from ...dynamics.terms.kinematic_error import ENTRY_UNITS, EntryName, link_of, with_entry
from ...dynamics.terms.kinematic_error import KinematicError as KinematicErrorTerm
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Quantity, Scalars, SearchTraits, Setting, Site, number_text
from .repairs import CorrectsRobot
from .shared.own_joint import OwnJointCause

ENTRIES: tuple[EntryName, ...] = ("alpha", "d", "r")


@dataclass(frozen=True)
class KinematicError(OwnJointCause, CorrectsRobot):
    """Candidate cause: an error of alpha, d or r in a link's modified DH row (scalar: place in `ENTRIES`)."""

    id = "kinematic_error"
    title = "Kinematic table error"
    cure = "robot"
    units = (("error", "rad or m"), ("alpha", "rad"), ("d", "m"), ("r", "m"))
    experiment = "fast motion of all joints at once: lengths appear in products of velocities"
    coordinate = "position"
    traits = SearchTraits(discrete=("entry",), largest=ADMISSIBLE.kinematic_error)

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List the joints whose link has a row."""
        joints = range(1, dataset.joints + 1)
        return [(joint,) for joint in joints if link_of(dataset.robot, joint).row is not None]

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """List the entries that are neither the joint's own stroke nor a shift of the whole robot."""
        link = link_of(at.dataset.robot, at.joint)
        kept = {"alpha": True, "d": link.antecedent > 0, "r": link.antecedent > 0 and link.kind == "revolute"}
        return [{"entry": float(code)} for code, entry in enumerate(ENTRIES) if kept[entry]]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return KinematicErrorTerm(at.joint, at.operating_point, _entry(at.scalars))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit an error that a first-order column can represent."""
        return bool(abs(solved.values[0]) < ADMISSIBLE.kinematic_error)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the error, and once more under the name of its entry."""
        entry = _entry(solved.scalars)
        value, deviation = float(solved.values[0]), float(solved.covariance[0, 0]) ** 0.5
        return tuple(
            Quantity(name, solved.site[0], ENTRY_UNITS[entry], value, deviation) for name in ("error", entry)
        )

    def statement(self, solved: FittedCause) -> str:
        """State the entry and its error."""
        found = self.by_name(solved)["error"]
        entry = _entry(solved.scalars)
        way, size = ("larger" if found.value > 0.0 else "smaller"), replace(found, value=abs(found.value))
        return f"Kinematic table error on joint {solved.site[0]}: {entry} has to be {way} by {size.text}"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State the entry before and after."""
        entry = _reported(numbers)
        row = link_of(robot, joints[0]).row
        before = 0.0 if row is None else float(getattr(row, entry))
        after = number_text(before + numbers["error"], 4)
        return (
            f"Joint {joints[0]}'s {entry} in the kinematic table goes from {number_text(before, 4)} to "
            f"{after} {ENTRY_UNITS[entry]}"
        )

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Add the error to the entry."""
        return with_entry(robot, joints[0], _reported(numbers), numbers["error"])


def _reported(numbers: Numbers) -> EntryName:
    return next(entry for entry in ENTRIES if entry in numbers)


def _entry(scalars: Scalars) -> EntryName:
    return ENTRIES[round(scalars["entry"])]
