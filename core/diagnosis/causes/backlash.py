"""Candidate cause: backlash in a joint's transmission, between the motor encoder and the link."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.backlash import Backlash as BacklashTerm
from ..thresholds.causes import ADMISSIBLE, LINEARISATION
from .protocol import FittedCause, Scalars, SearchTraits, Setting
from .shared.own_joint import OwnJointCause, geometric_grid, motor_inertias, rotor_text

NARROWEST, WIDEST, STEPS = 1e-4, 3e-2, 13
"""Half widths in rad, on a logarithmic scale: half as wide again is another motion."""
SMOOTHING_OVER_BAND = 1.5


@dataclass(frozen=True)
class Backlash(OwnJointCause):
    """Candidate cause: backlash between motor and link."""

    id = "backlash"
    title = "Backlash in the transmission"
    units = (("half_width", "rad"), ("motor_inertia", "kg m2"))
    experiment = "slow motion through postures where the load on this joint changes its sign"
    coordinate = "load"
    traits = SearchTraits(linearisation_error=LINEARISATION.transmission)
    revolute_only = True

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the width of the gap; the time of crossing is its cube root."""
        return [
            {"around": value, **rotor}
            for rotor in motor_inertias(at)
            for value in geometric_grid(NARROWEST, WIDEST, STEPS)
        ]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        band = SMOOTHING_OVER_BAND * at.dataset.band_hz
        return BacklashTerm(
            at.joint, at.operating_point, at.scalars["around"], band, at.scalars.get("motor_inertia", 0.0)
        )

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a gap of about the width that the crossings were computed for."""
        around = solved.scalars["around"]
        return super().admissible(solved) and bool(
            around / ADMISSIBLE.backlash_narrower < solved.values[0] < ADMISSIBLE.backlash_wider * around
        )

    def statement(self, solved: FittedCause) -> str:
        """State the half width of the gap."""
        found = self.by_name(solved)
        return (
            f"Backlash on joint {solved.site[0]}: the link lags or leads the motor by "
            f"{found['half_width'].text}, on the side that the load selects{rotor_text(found)}"
        )
