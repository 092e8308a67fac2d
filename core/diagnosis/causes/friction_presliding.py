"""Suspect that friction builds up over a distance after each reversal instead of jumping."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.presliding import Presliding
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import OwnJointCause, named, shown, spread


@dataclass(frozen=True)
class FrictionPresliding(OwnJointCause):
    """Suspect presliding friction (Dahl)."""

    id = "friction_presliding"
    title = "Friction builds up over a distance after each reversal"
    units = (("coulomb_level", "N m"), ("presliding_distance", "rad"))
    experiment = "many slow reversals, each followed by a move of some degrees"
    coordinate = "travel"

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the distance from 1 / 5000 to a sixth of the joint's range of motion."""
        del operating_point
        span = max(float(np.ptp(dataset.state.position[:, site[0] - 1])), 1e-6)
        return [{"presliding_distance": value} for value in spread(2e-4 * span, 0.16 * span, 11)]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del dataset, operating_point
        return Presliding(site[0], scalars["presliding_distance"])

    def admissible(self, solved: FittedCause) -> bool:
        """Want friction that builds up, not one that falls."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def statement(self, solved: FittedCause) -> str:
        """Say over which distance how much friction builds up."""
        found = named(self.quantities(solved))
        return (
            f"Joint {solved.site[0]}'s friction of {shown(found['coulomb_level'])} builds up over "
            f"{shown(found['presliding_distance'])} after each reversal"
        )
