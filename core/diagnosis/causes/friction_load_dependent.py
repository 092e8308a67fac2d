"""Suspect that a joint's friction grows with the torque its gear transmits.

Where a fit cannot tell a rotor's inertia from its link's, this friction can: only the link's is transmitted.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.load_friction import LoadFriction
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import OwnJointCause, before_the_gear, motor_inertias, named, shown


@dataclass(frozen=True)
class FrictionLoadDependent(OwnJointCause):
    """Suspect load-dependent friction."""

    id = "friction_load_dependent"
    title = "Friction grows with the transmitted torque"
    units = (("load_coefficient", "1"), ("motor_inertia", "kg m2"))
    experiment = "slow moves in both directions through postures of little and of much gravity torque"
    coordinate = "load"

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the inertia that turns with the motor, where the fit cannot tell it from the link's."""
        return motor_inertias(dataset, operating_point, site)

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del dataset
        return LoadFriction(site[0], operating_point, scalars.get("motor_inertia", 0.0))

    def admissible(self, solved: FittedCause) -> bool:
        """Want friction that brakes, and less than all of the load."""
        return super().admissible(solved) and bool(0.0 < solved.values[0] < 1.0)

    def statement(self, solved: FittedCause) -> str:
        """Say which share of the load comes back as friction."""
        found, unit = named(self.quantities(solved)), solved.unit("N m")
        return (
            f"Joint {solved.site[0]}'s friction grows by {shown(found['load_coefficient'])} {unit} per "
            f"{unit} of transmitted {'force' if solved.slides else 'torque'}{before_the_gear(found)}"
        )
