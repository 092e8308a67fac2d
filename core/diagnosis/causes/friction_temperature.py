"""Candidate cause: friction that depends on the joint's temperature: logged, or a warm-up over the log."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.friction_temperature import TemperatureFriction, WarmUpFriction
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Quantity, Scalars, Setting
from .shared.own_joint import NOTHING, OwnJointCause

SHARES = (0.05, 0.12, 0.3, 0.7, 3.0)
"""Time constants of a warm-up, as shares of the data set's duration."""
SLOPES = (("coulomb_slope", "N m"), ("viscous_slope", "N m s/rad"))


@dataclass(frozen=True)
class FrictionTemperature(OwnJointCause):
    """Candidate cause: temperature-dependent friction."""

    id = "friction_temperature"
    title = "Temperature-dependent friction"
    units = (
        ("coulomb_slope", "N m or N m/K"),
        ("viscous_slope", "N m s/rad or N m s/rad/K"),
        ("time_constant", "s"),
    )
    experiment = "the same motion cold and after half an hour of work, the joints' temperatures logged"
    coordinate = "time"

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the warm-up's time constant where no temperature is logged."""
        if at.dataset.state.temperature is not None:
            return NOTHING
        seconds = float(np.ptp(at.dataset.time))
        constants = dict.fromkeys(max(share * seconds, ADMISSIBLE.least_warm_up) for share in SHARES)
        return [{"time_constant": constant} for constant in constants]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        temperature = at.dataset.state.temperature
        if temperature is not None:
            return TemperatureFriction(at.joint, float(temperature[:, at.joint - 1].mean()))
        return WarmUpFriction(at.joint, float(at.dataset.time.min()), at.scalars["time_constant"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a warm-up that takes seconds."""
        warm_up = solved.scalars.get("time_constant", ADMISSIBLE.least_warm_up)
        return super().admissible(solved) and warm_up >= ADMISSIBLE.least_warm_up

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
        """State the changes of friction, per kelvin or over the warm-up."""
        found = self.by_name(solved)
        changes = (
            f"Temperature-dependent friction on joint {solved.site[0]}: Coulomb friction changes by "
            f"{found['coulomb_slope'].text}, viscous friction by "
            f"{found['viscous_slope'].text}"
        )
        if "time_constant" not in found:
            return changes
        return f"{changes} during a warm-up with a time constant of {found['time_constant'].text}"
