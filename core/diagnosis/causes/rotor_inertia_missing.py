"""Suspect that a joint has a rotor inertia which the robot's description leaves out."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.missing_rotor import MissingRotor
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Numbers, Scalars, Site
from .repairs import CorrectsRobot
from .shared.common import OwnJointCause, named, rounded, shown


@dataclass(frozen=True)
class RotorInertiaMissing(OwnJointCause, CorrectsRobot):
    """Suspect a rotor that nobody declared."""

    id = "rotor_inertia_missing"
    title = "A rotor inertia is missing from the model"
    cure = "robot"
    units = (("IA", "kg m2"),)
    experiment = "large accelerations of this joint in postures of different inertia beyond it"
    coordinate = "acceleration"

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List the joints without a declared rotor."""
        del operating_point
        return [
            (number,) for number, joint in enumerate(dataset.robot.joints, start=1) if not joint.rotor_inertia
        ]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del dataset, operating_point, scalars
        return MissingRotor(site[0])

    def admissible(self, solved: FittedCause) -> bool:
        """Want an inertia."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def statement(self, solved: FittedCause) -> str:
        """Say how much inertia is missing."""
        found = named(self.quantities(solved))
        return f"Joint {solved.site[0]}'s rotor is missing from the model: {shown(found['IA'])} at the joint"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say that the rotor is declared, and what an identification will find about."""
        del robot
        return (
            f"Joint {joints[0]}'s rotor_inertia goes from false to true; an identification finds about "
            f"{rounded(numbers['IA'], 4)} kg m2"
        )

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Declare the rotor."""
        del numbers
        declared = (
            replace(one, rotor_inertia=True) if number in joints else one
            for number, one in enumerate(robot.joints, start=1)
        )
        return replace(robot, joints=tuple(declared))
