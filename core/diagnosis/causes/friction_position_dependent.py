"""Candidate cause: a Coulomb friction that is periodic in the joint's angle."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.friction_position_dependent import PositionFriction
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Quantity, Scalars, SearchTraits, Setting
from .shared.harmonics import harmonics, wave_quantities
from .shared.own_joint import OwnJointCause

MOST = 12


@dataclass(frozen=True)
class FrictionPositionDependent(OwnJointCause):
    """Candidate cause: friction that varies with the angle."""

    id = "friction_position_dependent"
    title = "Position-dependent Coulomb friction"
    units = (("amplitude", "N m"), ("harmonic", "1"), ("phase", "rad"))
    experiment = "slow moves at constant speed over the joint's whole range, in both directions"
    coordinate = "position"
    traits = SearchTraits(discrete=("centre",))

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the cycles per revolution from one upwards."""
        angle = at.dataset.state.position[:, at.joint - 1]
        return harmonics(angle, lowest=1.0, highest=float("inf"), most=MOST)

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return PositionFriction(at.joint, at.scalars["harmonic"], at.scalars["centre"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a level that is the same after a turn: the amplitude of a longer wave is extrapolated."""
        return super().admissible(solved) and solved.scalars["harmonic"] >= ADMISSIBLE.friction_harmonic

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the wave: amplitude cos(harmonic q + phase) is added to the Coulomb level."""
        return wave_quantities(solved, "N m")

    def statement(self, solved: FittedCause) -> str:
        """State amplitude and cycles per revolution."""
        found = self.by_name(solved)
        return (
            f"Position-dependent Coulomb friction on joint {solved.site[0]}: amplitude "
            f"{found['amplitude'].text}, {found['harmonic'].text} cycles per revolution"
        )
