"""Suspect that viscous friction differs between the two directions of motion."""

from dataclasses import dataclass

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.asymmetric_viscous import AsymmetricViscous
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import OwnJointCause, named, shown


@dataclass(frozen=True)
class FrictionAsymmetric(OwnJointCause):
    """Suspect viscous friction of two directions."""

    id = "friction_asymmetric"
    title = "Viscous friction differs between directions"
    units = (("delta_viscous", "N m s/rad"),)
    experiment = "constant-speed moves at three speeds or more, each in both directions"

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del dataset, operating_point, scalars
        return AsymmetricViscous(site[0])

    def statement(self, solved: FittedCause) -> str:
        """Say which direction is the harder one, and by how much."""
        found = named(self.quantities(solved))["delta_viscous"]
        more, less = ("forwards", "backwards") if found.value > 0.0 else ("backwards", "forwards")
        return (
            f"Joint {solved.site[0]} has more viscous friction {more} than {less}: {shown(found)} to "
            "either side of the mean"
        )
