"""Suspect that friction bends with speed: a power of it beside the linear viscous friction."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.nonlinear_viscous import NonlinearViscous
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import OwnJointCause, named, shown

EXPONENTS = (0.3, 0.5, 0.7, 0.85, 1.2, 1.5, 2.0, 2.5, 3.0)
"""A power of zero is Coulomb friction, of one viscous friction: the model has both."""
APART = 0.1
"""A power this near to either takes away what the model's own friction adds, and may be of any size."""


@dataclass(frozen=True)
class FrictionViscousNonlinear(OwnJointCause):
    """Suspect friction that is not linear in speed."""

    id = "friction_viscous_nonlinear"
    title = "Friction is not linear in speed"
    units = (("coefficient", "N m (s/rad)^p"), ("exponent", "1"))
    experiment = "constant-speed moves from 5 % to 100 % of the joint's speed, in both directions"

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the power."""
        del dataset, operating_point, site
        return [{"exponent": value} for value in EXPONENTS]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del dataset, operating_point
        return NonlinearViscous(site[0], scalars["exponent"])

    def admissible(self, solved: FittedCause) -> bool:
        """Want a power that is neither Coulomb nor viscous friction."""
        power = solved.scalars["exponent"]
        return super().admissible(solved) and power >= APART and abs(power - 1.0) >= APART

    def statement(self, solved: FittedCause) -> str:
        """Say how friction grows with which power."""
        found = named(self.quantities(solved))
        grows = "grows" if solved.values[0] > 0.0 else "falls"
        return (
            f"Beside its viscous part, joint {solved.site[0]}'s friction {grows} with speed to the power "
            f"{shown(found['exponent'])}: coefficient {shown(found['coefficient'])}"
        )
