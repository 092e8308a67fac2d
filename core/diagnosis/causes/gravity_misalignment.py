"""Candidate cause: a tilted base, so that gravity has another direction than in the robot's description."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ...dynamics.term import Term
from ...dynamics.terms.gravity_misalignment import Tilt, tilt_axes
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Quantity, SearchTraits, Setting, Site, number_text
from .repairs import CorrectsRobot
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class GravityMisalignment(OwnJointCause, CorrectsRobot):
    """Candidate cause: a tilted base."""

    id = "gravity_misalignment"
    title = "Base tilt"
    cure = "robot"
    units = (("tilt_x", "rad"), ("tilt_y", "rad"))
    experiment = "the same slow motion with the first joint at four angles, a quarter of a revolution apart"
    coordinate = "position"
    traits = SearchTraits(largest=ADMISSIBLE.gravity_tilt)

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """Act on the whole robot, where there is gravity."""
        return [()] if np.any(dataset.robot.gravity) else []

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return Tilt(0, at.operating_point)

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a tilt that a first-order column can represent."""
        return bool(np.hypot(*solved.values) < ADMISSIBLE.gravity_tilt)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the axes about which a tilt is observable: for a planar arm only one."""
        return tuple(
            tilt for tilt in super().quantities(solved) if tilt.standard_deviation < ADMISSIBLE.gravity_tilt
        )

    def statement(self, solved: FittedCause) -> str:
        """State the rotation of gravity about each axis."""
        turns = " and ".join(
            f"by {tilt.text} about the base's {tilt.name[-1]} axis" for tilt in self.quantities(solved)
        )
        return (
            f"Base tilt: gravity is rotated {turns} against the description, as by a base tilted the other "
            "way"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State gravity before and after."""
        after = self.corrected_robot(robot, joints, numbers)
        old, new = (
            ", ".join(number_text(component, 4) for component in arm.gravity) for arm in (robot, after)
        )
        return f"Gravity in the base frame goes from ({old}) to ({new}) m/s2"

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Rotate gravity; not about an axis whose tilt is not observable."""
        del joints
        about_x, about_y = tilt_axes(np.asarray(robot.gravity, dtype=float))
        turn = numbers.get("tilt_x", 0.0) * about_x + numbers.get("tilt_y", 0.0) * about_y
        return replace(robot, gravity=Rotation.from_rotvec(turn).apply(robot.gravity))
