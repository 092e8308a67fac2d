"""Share what most causes have in common, so that a cause's file holds only what is its own."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ....dynamics.prediction import Prediction
from ....robot.model import RobotModel
from ...dataset.dataset import Dataset
from ..protocol import Cure, FittedCause, Numbers, Quantity, Scalars, Site
from ..traits import SearchTraits

NOTHING: tuple[Scalars, ...] = ({},)
"""The grid of a cause that has nothing to scan."""
MOTOR_SHARES = (0.0, 0.45, 0.9, 0.94)
"""Of the least inertia that a joint has in the motion, what may turn with its motor.

One that is refined ends a step farther, at 0.98.
"""


@dataclass(frozen=True)
class OwnJointCause:
    """Share the habits of causes that act on one joint each, and take its linear parameters as they come."""

    id: ClassVar[str]
    title: ClassVar[str]
    units: ClassVar[tuple[tuple[str, str], ...]]
    """Unit of every number that is reported, by name and in order: linear parameters and scanned scalars."""
    cure: ClassVar[Cure] = "term"
    experiment: ClassVar[str] = ""
    coordinate: ClassVar[str] = "velocity"
    traits: ClassVar[SearchTraits] = SearchTraits()

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List every joint."""
        del operating_point
        return [(joint,) for joint in range(1, dataset.joints + 1)]

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan nothing."""
        del dataset, operating_point, site
        return NOTHING

    def admissible(self, solved: FittedCause) -> bool:
        """Allow any finite value, and a rotor, if any, that is heavy."""
        return bool(np.isfinite(solved.values).all()) and solved.scalars.get("motor_inertia", 0.0) >= 0.0

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the linear parameters in order, then those scalars that were scanned."""
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

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the reported numbers."""
        del dataset
        return {one.name: one.value for one in self.quantities(solved)}

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say that its term is all the repair there is."""
        del robot, joints, numbers
        return "The model has its torque as a further term; the description and the log stay as they are"


def motor_inertias(dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
    """Scan the inertia that turns with a joint's motor, where the fit cannot tell it from the link's."""
    if operating_point.rotor(site[0]) != 0.0:
        return NOTHING
    least = float(operating_point.slopes(dataset.state, site[0] - 1)[2][:, site[0] - 1].min())
    return [{"motor_inertia": share * least} for share in MOTOR_SHARES] if least > 0.0 else NOTHING


def spread(low: float, high: float, count: int) -> list[float]:
    """Give values in equal ratios from low to high."""
    return [float(value) for value in np.geomspace(low, high, count)]


def named(quantities: Sequence[Quantity]) -> dict[str, Quantity]:
    """Look quantities up by name."""
    return {one.name: one for one in quantities}


def before_the_gear(found: Mapping[str, Quantity]) -> str:
    """Say what turns with a joint's motor, where that was searched for and is more than nothing."""
    rotor = found.get("motor_inertia")
    if rotor is None or rotor.value <= 2.0 * rotor.standard_deviation:
        return ""
    return f"; of its inertia {shown(rotor)} turns with the motor, before the gear"


def shown(quantity: Quantity) -> str:
    """Write a quantity with its unit and uncertainty."""
    unit = "" if quantity.unit == "1" else f" {quantity.unit}"
    return f"{rounded(quantity.value, 3)} ± {rounded(quantity.standard_deviation)}{unit}"


def rounded(value: float, digits: int = 1) -> str:
    """Write a number with so many digits that count, as people write it.

    Examples
    --------
    >>> rounded(0.0123), rounded(12.3), rounded(1234.5, 3)
    ('0.01', '10', '1230')
    """
    return f"{float(f'{value:.{digits}g}'):g}"
