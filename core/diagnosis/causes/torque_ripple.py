"""Candidate cause: torque ripple, periodic in the angle of motor or transmission."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.torque_ripple import Ripple
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Quantity, Scalars, SearchTraits, Setting
from .shared.harmonics import harmonics, wave_quantities
from .shared.own_joint import OwnJointCause

MOST = 120
BAND_SHARE = 0.7
"""At the joint's RMS speed, cycles are scanned up to this share of the data set's bandwidth."""


@dataclass(frozen=True)
class TorqueRipple(OwnJointCause):
    """Candidate cause: torque ripple."""

    id = "torque_ripple"
    title = "Torque ripple"
    units = (("amplitude", "N m"), ("harmonic", "1"), ("phase", "rad"))
    experiment = "slow moves at constant speed over the joint's whole range"
    coordinate = "position"
    traits = SearchTraits(discrete=("centre",))

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the cycles per revolution from two to the bandwidth's limit."""
        own = at.joint - 1
        highest = BAND_SHARE * 2.0 * np.pi * at.dataset.band_hz / max(float(at.dataset.speed[own]), 1e-6)
        return harmonics(
            at.dataset.state.position[:, own], lowest=ADMISSIBLE.ripple_harmonic, highest=highest, most=MOST
        )

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return Ripple(at.joint, at.scalars["harmonic"], at.scalars["centre"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit more cycles per revolution than gravity has."""
        return super().admissible(solved) and solved.scalars["harmonic"] >= ADMISSIBLE.ripple_harmonic

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Doubt a wave of which the motion shows little more than one, or as slow as the slowest."""
        harmonic, doubt = solved.scalars["harmonic"], solved.deviations.get("harmonic", 0.0)
        turns = float(np.ptp(at.dataset.state.position[:, at.joint - 1])) / (2.0 * np.pi)
        slow = harmonic - ADMISSIBLE.significant * doubt <= ADMISSIBLE.ripple_harmonic
        return harmonic * turns >= ADMISSIBLE.ripple_waves and not slow

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the wave: the drive torque is larger by amplitude cos(harmonic q + phase)."""
        return wave_quantities(solved, "N m")

    def statement(self, solved: FittedCause) -> str:
        """State amplitude and cycles per revolution."""
        found = self.by_name(solved)
        return (
            f"Torque ripple on joint {solved.site[0]}: amplitude {found['amplitude'].text}, "
            f"{found['harmonic'].text} cycles per revolution"
        )
