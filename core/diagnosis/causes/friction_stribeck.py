"""Suspect that friction falls as a joint gets under way (Stribeck): the excess over the Coulomb level."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.stribeck import Stribeck
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import OwnJointCause, named, shown, spread


@dataclass(frozen=True)
class FrictionStribeck(OwnJointCause):
    """Suspect Stribeck friction."""

    id = "friction_stribeck"
    title = "Friction falls with speed near standstill"
    units = (("excess_torque", "N m"), ("stribeck_velocity", "rad/s"))
    experiment = "slow constant-speed moves, 1 % to 20 % of the joint's speed, in both directions"

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the Stribeck velocity from 3 % of the RMS speed to the RMS speed."""
        del operating_point
        speed = max(float(dataset.speed[site[0] - 1]), 1e-6)
        return [{"stribeck_velocity": value} for value in spread(0.03 * speed, 1.0 * speed, 9)]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del dataset, operating_point
        return Stribeck(site[0], scalars["stribeck_velocity"])

    def admissible(self, solved: FittedCause) -> bool:
        """Want an excess, not a lack."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def statement(self, solved: FittedCause) -> str:
        """Say how much friction is lost at which speed."""
        found = named(self.quantities(solved))
        return (
            f"Joint {solved.site[0]} has {shown(found['excess_torque'])} more friction near standstill than "
            f"its Coulomb level; it is lost over {shown(found['stribeck_velocity'])}"
        )
