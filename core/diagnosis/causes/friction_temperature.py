"""Suspect that friction follows the joint's warmth: as logged, or as a warm-up over the time of the log."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.temperature_friction import TemperatureFriction, WarmUpFriction
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Quantity, Scalars, Site
from .shared.common import NOTHING, OwnJointCause, named, shown

SHARES = (0.05, 0.12, 0.3, 0.7, 3.0)
"""Time constants of a warm-up, as shares of the time looked at."""
SLOPES = (("coulomb_slope", "N m"), ("viscous_slope", "N m s/rad"))


@dataclass(frozen=True)
class FrictionTemperature(OwnJointCause):
    """Suspect friction that changes with temperature."""

    id = "friction_temperature"
    title = "Friction changes with temperature"
    units = (
        ("coulomb_slope", "N m or N m/K"),
        ("viscous_slope", "N m s/rad or N m s/rad/K"),
        ("time_constant", "s"),
    )
    experiment = "the same motion cold and after half an hour of work, the joints' temperatures logged"
    coordinate = "time"

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the warm-up's time constant where no temperature is logged."""
        del operating_point, site
        if dataset.state.temperature is not None:
            return NOTHING
        return [{"time_constant": share * float(np.ptp(dataset.time))} for share in SHARES]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del operating_point
        temperature = dataset.state.temperature
        if temperature is not None:
            return TemperatureFriction(site[0], float(temperature[:, site[0] - 1].mean()))
        return WarmUpFriction(site[0], float(dataset.time.min()), scalars["time_constant"])

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the slopes: per kelvin with a sensor, over the whole warm-up without one."""
        per = "" if "time_constant" in solved.scalars else "/K"
        deviations = np.sqrt(np.maximum(np.diag(solved.covariance), 0.0))
        slopes = tuple(
            Quantity(name, solved.site[0], solved.unit(unit) + per, float(value), float(deviation))
            for (name, unit), value, deviation in zip(SLOPES, solved.values, deviations, strict=True)
        )
        return slopes + tuple(
            Quantity(name, solved.site[0], "s", value, solved.deviations.get(name, 0.0))
            for name, value in solved.scalars.items()
        )

    def statement(self, solved: FittedCause) -> str:
        """Say by how much friction changes, per kelvin or over which time."""
        found = named(self.quantities(solved))
        changes = (
            f"Joint {solved.site[0]}'s Coulomb friction changes by {shown(found['coulomb_slope'])} and its "
            f"viscous friction by {shown(found['viscous_slope'])}"
        )
        if "time_constant" not in found:
            return f"{changes} of its temperature"
        return f"{changes} as it warms up with a time constant of {shown(found['time_constant'])}"
