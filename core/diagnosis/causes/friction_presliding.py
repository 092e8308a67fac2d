"""Candidate cause: presliding friction, which builds up over a distance after each reversal (Dahl)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.friction_presliding import Presliding
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Scalars, Setting
from .shared.own_joint import OwnJointCause, geometric_grid

NARROWEST, WIDEST, STEPS = 2e-4, 0.16, 11
"""Distances as shares of the joint's range, on a logarithmic scale."""


@dataclass(frozen=True)
class FrictionPresliding(OwnJointCause):
    """Candidate cause: presliding friction (Dahl)."""

    id = "friction_presliding"
    title = "Presliding friction"
    units = (("coulomb_level", "N m"), ("presliding_distance", "rad"))
    experiment = "many slow reversals, each followed by a move of some degrees"
    coordinate = "travel"

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the distance from 1 / 5000 to a sixth of the joint's range, as far as a gear can have it."""
        span = max(float(np.ptp(at.dataset.state.position[:, at.joint - 1])), 1e-6)
        distances = geometric_grid(NARROWEST * span, WIDEST * span, STEPS)
        return [
            {"presliding_distance": distance}
            for distance in distances
            if distance <= ADMISSIBLE.presliding_distance
        ]

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return Presliding(at.joint, at.scalars["presliding_distance"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit friction that builds up over a distance that a gear can have."""
        near = solved.scalars["presliding_distance"] <= ADMISSIBLE.presliding_distance
        return super().admissible(solved) and near and bool(solved.values[0] > 0.0)

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Doubt a level that may as well be Coulomb friction, which the model has."""
        del at
        level = self.by_name(solved)["coulomb_level"]
        return level.value >= ADMISSIBLE.level_deviations * level.standard_deviation

    def statement(self, solved: FittedCause) -> str:
        """State level and presliding distance."""
        found = self.by_name(solved)
        return (
            f"Presliding friction on joint {solved.site[0]}: {found['coulomb_level'].text} builds "
            f"up over {found['presliding_distance'].text} after each reversal"
        )
