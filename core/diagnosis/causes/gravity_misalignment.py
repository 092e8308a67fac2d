"""Suspect that the base is tilted: gravity does not point where the robot's description has it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.tilt import Tilt, tilt_axes
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Numbers, Quantity, Scalars, Site
from .repairs import CorrectsRobot
from .shared.common import OwnJointCause, rounded, shown

LARGEST = 0.5


@dataclass(frozen=True)
class GravityMisalignment(OwnJointCause, CorrectsRobot):
    """Suspect a tilted base."""

    id = "gravity_misalignment"
    title = "The base is tilted against the description"
    cure = "robot"
    units = (("tilt_x", "rad"), ("tilt_y", "rad"))
    experiment = "the same slow motion with the first joint at four angles, a quarter of a turn apart"
    coordinate = "position"

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """Act on the whole robot, where it has weight."""
        del operating_point
        return [()] if np.any(dataset.robot.gravity) else []

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del dataset, site, scalars
        return Tilt(0, operating_point)

    def admissible(self, solved: FittedCause) -> bool:
        """Want a tilt that a first-order column can stand for."""
        return bool(np.hypot(*solved.values) < LARGEST)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the axes about which a tilt shows: a planar arm sees one only."""
        return tuple(one for one in super().quantities(solved) if one.standard_deviation < LARGEST)

    def statement(self, solved: FittedCause) -> str:
        """Say about which axes gravity is turned."""
        turns = " and ".join(
            f"by {shown(one)} about the base's {one.name[-1]} axis" for one in self.quantities(solved)
        )
        return f"Gravity is turned against the description {turns}, as if the base were tilted the other way"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say where gravity points now."""
        after = self.corrected_robot(robot, joints, numbers)
        old, new = (", ".join(rounded(one, 4) for one in arm.gravity) for arm in (robot, after))
        return f"Gravity in the base frame goes from ({old}) to ({new}) m/s2"

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Turn gravity; about an axis whose tilt does not show it stays as it is."""
        del joints
        about_x, about_y = tilt_axes(np.asarray(robot.gravity, dtype=float))
        turn = numbers.get("tilt_x", 0.0) * about_x + numbers.get("tilt_y", 0.0) * about_y
        return replace(robot, gravity=Rotation.from_rotvec(turn).apply(robot.gravity))
