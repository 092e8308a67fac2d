"""Candidate cause: a transmission coupling of two joints that the robot's description does not declare."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import count

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.joint_coupling import MissingCoupling
from ...robot.model import Coupling, RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Quantity, Scalars, SearchTraits, Setting, Site
from .repairs import CorrectsRobot
from .shared.own_joint import OwnJointCause

NAMES = (("Iam", "kg m2"), ("Fvm", "N m s/rad"), ("Fcm", "N m"))


@dataclass(frozen=True)
class JointCoupling(OwnJointCause, CorrectsRobot):
    """Candidate cause: an undeclared transmission coupling."""

    id = "joint_coupling"
    title = "Undeclared transmission coupling"
    cure = "robot"
    units = (("Fvm", "N m s/rad"), ("Fcm", "N m"), ("Iam", "kg m2"))
    experiment = "move each of the two joints alone, then both in the same and in opposite directions"
    coordinate = "other_velocity"
    traits = SearchTraits(discrete=("weight",))

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List pairs of revolute joints, at most two apart, that no declared coupling joins."""
        robot = dataset.robot
        turning = {link.joint for link in robot.links if link.kind == "revolute"}

        return [
            (first, second)
            for second in sorted(turning)
            for first in range(max(1, second - ADMISSIBLE.coupling_distance), second)
            if first in turning
            and not any({first, second}.issubset(coupling.joints) for coupling in robot.couplings)
        ]

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the sign with which the first joint turns the motor."""
        del at
        return [{"weight": 1.0}, {"weight": -1.0}]

    def term(self, at: Setting) -> Term:
        """Give the columns of the coupling."""
        weights = (at.scalars["weight"], 1.0)
        return MissingCoupling(Coupling("undeclared", at.site[1], (at.joint, at.site[1]), weights))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit inertia and friction: none significantly negative, one significantly positive."""
        size = solved.values / np.sqrt(np.maximum(np.diag(solved.covariance), 1e-300))
        return super().admissible(solved) and bool(
            size.min() > -ADMISSIBLE.significant and size.max() > ADMISSIBLE.significant
        )

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the motor's inertia and friction under the number of the joint that it drives."""
        deviations = np.sqrt(np.maximum(np.diag(solved.covariance), 0.0))
        found = {
            name: Quantity(name, solved.site[1], unit, float(value), float(deviation))
            for (name, unit), value, deviation in zip(NAMES, solved.values, deviations, strict=True)
        }
        return tuple(found[name] for name, _ in self.units)

    def statement(self, solved: FittedCause) -> str:
        """State the two joints, the motor's inertia and its friction."""
        found = self.by_name(solved)
        first, second = solved.site
        sums = "sum" if solved.scalars["weight"] >= 0.0 else "difference"
        return (
            f"Undeclared transmission coupling of joints {first} and {second}: a motor turns with their "
            f"{sums}, inertia {_significant(found['Iam'])}, viscous friction {_significant(found['Fvm'])}, "
            f"Coulomb friction {_significant(found['Fcm'])}"
        )

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the reported numbers, and the weight of the first joint in the motor's rotation."""
        return {**super().numbers(dataset, solved), "weight": solved.scalars["weight"]}

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State which coupling is declared."""
        first, second = joints
        sign = "plus" if numbers["weight"] >= 0.0 else "minus"
        return (
            f"The description's couplings go from {len(robot.couplings)} to {len(robot.couplings) + 1}: a "
            f"motor that turns with joint {second} {sign} joint {first}"
        )

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Declare the coupling, under the number of the joint that its motor drives or the next free one."""
        first, second = joints
        taken = {coupling.number for coupling in robot.couplings}
        number = next(free for free in count(second) if free not in taken)
        found = Coupling(f"joints {first} and {second}", number, (first, second), (numbers["weight"], 1.0))
        return replace(robot, couplings=(*robot.couplings, found))


def _significant(quantity: Quantity) -> str:
    """Write a quantity where it differs from zero: an inertia may belong to links or rotors as well."""
    if quantity.standard_deviation > abs(quantity.value):
        return "not distinguishable from zero"
    return quantity.text
