"""Suspect that a joint's friction or offset is not the reference's any more: wear, grease, cold, service."""

from dataclasses import dataclass

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.coulomb import Coulomb
from ...dynamics.terms.friction_change import FrictionChange as FrictionChangeTerm
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import OwnJointCause, shown

WORDS = {"delta_viscous": "viscous friction", "delta_coulomb": "Coulomb friction", "delta_offset": "offset"}


@dataclass(frozen=True)
class FrictionChange(OwnJointCause):
    """Suspect friction that has changed since the reference."""

    id = "friction_change"
    title = "Friction has changed since the reference"
    units = (("delta_viscous", "N m s/rad"), ("delta_coulomb", "N m"), ("delta_offset", "N m"))
    experiment = "constant-speed moves of this joint at three speeds or more, each in both directions"

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns, smoothed as the believed model's are."""
        del dataset, scalars
        widths = next((one.widths for one in operating_point.model.terms if isinstance(one, Coulomb)), ())
        return FrictionChangeTerm(site[0], widths[site[0] - 1] if widths else 0.0)

    def statement(self, solved: FittedCause) -> str:
        """Say what has changed by how much; what hardly has is not worth a word."""
        found = self.quantities(solved)
        clear = [one for one in found if abs(one.value) > 2.0 * one.standard_deviation]
        told = clear or [max(found, key=lambda one: abs(one.value) / max(one.standard_deviation, 1e-300))]
        changes = " and ".join(f"{WORDS[one.name]} by {shown(one)}" for one in told)
        return f"Joint {solved.site[0]}'s friction differs from the reference's: {changes}"
