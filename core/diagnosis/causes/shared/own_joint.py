"""Define what causes of one joint have in common: sites, grids, admissibility, quantities, words.

A cause's own file holds only what differs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ....robot.model import RobotModel
from ...dataset.dataset import Dataset
from ...thresholds.causes import ADMISSIBLE
from ..protocol import Cure, FittedCause, Numbers, Quantity, Scalars, SearchTraits, Setting, Site

NOTHING: tuple[Scalars, ...] = ({},)
"""The grid of a cause without nonlinear scalars."""
MOTOR_SHARES = (0.0, 0.45, 0.9, 0.94)
"""Motor-side shares of the least inertia that a joint has in the motion; refined, up to 0.98."""


@dataclass(frozen=True)
class OwnJointCause:
    """Define the defaults of causes that act on one joint each."""

    id: ClassVar[str]
    title: ClassVar[str]
    units: ClassVar[tuple[tuple[str, str], ...]]
    """Unit of every number that is reported, by name and in order: linear parameters and scanned scalars."""
    cure: ClassVar[Cure] = "term"
    experiment: ClassVar[str] = ""
    coordinate: ClassVar[str] = "velocity"
    traits: ClassVar[SearchTraits] = SearchTraits()
    revolute_only: ClassVar[bool] = False
    """Whether it acts on revolute joints only."""

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List every joint that it may act on."""
        joints = revolute_joints(dataset.robot) if self.revolute_only else range(1, dataset.joints + 1)
        return [(joint,) for joint in joints]

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan nothing."""
        del at
        return NOTHING

    def admissible(self, solved: FittedCause) -> bool:
        """Admit any finite value, and no negative rotor inertia."""
        return bool(np.isfinite(solved.values).all()) and solved.scalars.get("motor_inertia", 0.0) >= 0.0

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Take every size as represented."""
        del at, solved
        return True

    def contradicted(self, at: Setting, solved: FittedCause) -> bool:
        """Know of nothing in the motion that contradicts it."""
        del at, solved
        return False

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the linear parameters in order, then the scanned scalars."""
        joint = solved.site[0] if solved.site else None
        names = [name for name, _ in self.units if name not in solved.scalars][: len(solved.values)]
        deviations = np.sqrt(np.maximum(np.diag(solved.covariance), 0.0))
        linear = {
            name: (float(value), float(deviation))
            for name, value, deviation in zip(names, solved.values, deviations, strict=True)
        }
        scanned = {name: (value, solved.deviations.get(name, 0.0)) for name, value in solved.scalars.items()}
        both = linear | scanned
        return tuple(
            Quantity(name, joint, solved.unit(unit), *both[name]) for name, unit in self.units if name in both
        )

    def by_name(self, solved: FittedCause) -> dict[str, Quantity]:
        """Give the reported numbers by their names."""
        return {quantity.name: quantity for quantity in self.quantities(solved)}

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the reported numbers."""
        del dataset
        return {quantity.name: quantity.value for quantity in self.quantities(solved)}

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State that the term is the repair."""
        del robot, joints, numbers
        return "The model has the torque as a further term; description and log stay as they are"


def motor_inertias(at: Setting) -> Sequence[Scalars]:
    """Scan the motor-side inertia of a joint, where the fit cannot separate it from the link's."""
    if at.operating_point.rotor(at.joint) != 0.0:
        return NOTHING
    least = float(at.operating_point.slopes(at.dataset.state, at.joint - 1)[2][:, at.joint - 1].min())
    return [{"motor_inertia": share * least} for share in MOTOR_SHARES] if least > 0.0 else NOTHING


def geometric_grid(low: float, high: float, count: int) -> list[float]:
    """List values in equal ratios from low to high."""
    return [float(value) for value in np.geomspace(low, high, count)]


def revolute_joints(robot: RobotModel) -> tuple[int, ...]:
    """List the revolute joints (from 1); where a joint moves several links, its first one decides."""
    kinds = {link.joint: link.kind for link in reversed(robot.links)}
    return tuple(joint for joint in sorted(kinds) if kinds[joint] == "revolute")


def end_links(robot: RobotModel) -> dict[int, int]:
    """Give the links (from 1) that carry no other and follow their joint one to one, by their joint."""
    carriers = {link.antecedent for link in robot.links}
    return {
        link.joint: number
        for number, link in enumerate(robot.links, start=1)
        if number not in carriers and link.ratio == 1.0
    }


def links_by_joint(robot: RobotModel) -> dict[int, int]:
    """Give the first link (from 1) of every joint that it follows one to one, by the joint."""
    numbered = list(enumerate(robot.links, start=1))
    return {link.joint: number for number, link in reversed(numbered) if link.ratio == 1.0}


def rotor_text(found: Mapping[str, Quantity]) -> str:
    """Write the motor-side inertia of a joint, where it was scanned and is significant."""
    rotor = found.get("motor_inertia")
    if rotor is None or rotor.value <= ADMISSIBLE.significant * rotor.standard_deviation:
        return ""
    return f"; motor-side inertia {rotor.text}"
