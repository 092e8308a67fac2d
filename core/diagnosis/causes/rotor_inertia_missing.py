"""Candidate cause: a rotor inertia that the robot's description does not declare."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...dynamics.term import Term
from ...dynamics.terms.rotor_inertia_missing import MissingRotor
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Numbers, Setting, Site, number_text
from .repairs import CorrectsRobot
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class RotorInertiaMissing(OwnJointCause, CorrectsRobot):
    """Candidate cause: an undeclared rotor."""

    id = "rotor_inertia_missing"
    title = "Rotor inertia missing from the model"
    cure = "robot"
    units = (("IA", "kg m2"),)
    experiment = "large accelerations of this joint in postures of different inertia beyond it"
    coordinate = "acceleration"

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List the joints without a declared rotor."""
        return [
            (number,) for number, joint in enumerate(dataset.robot.joints, start=1) if not joint.rotor_inertia
        ]

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return MissingRotor(at.joint)

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a positive inertia."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def statement(self, solved: FittedCause) -> str:
        """State the missing inertia."""
        found = self.by_name(solved)
        return (
            f"Rotor inertia of joint {solved.site[0]} missing from the model: {found['IA'].text} "
            "on the joint side"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State that the rotor is declared, and about which inertia an identification will find."""
        del robot
        return (
            f"Joint {joints[0]}'s rotor_inertia goes from false to true; an identification finds about "
            f"{number_text(numbers['IA'], 4)} kg m2"
        )

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Declare the rotor."""
        del numbers
        declared = (
            replace(joint, rotor_inertia=True) if number in joints else joint
            for number, joint in enumerate(robot.joints, start=1)
        )
        return replace(robot, joints=tuple(declared))
