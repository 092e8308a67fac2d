"""Suspect a torque that is periodic in the angle of motor or gear."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.ripple import Ripple
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Quantity, Scalars, Site
from .shared.common import OwnJointCause, named, shown
from .shared.harmonics import harmonics, wave_quantities
from .traits import SearchTraits

LOWEST = 2.0
"""One wave per turn is what gravity does."""
MOST = 120
BAND_SHARE = 0.7
"""At the joint's RMS speed, waves are looked for up to this share of the look's band."""


@dataclass(frozen=True)
class TorqueRipple(OwnJointCause):
    """Suspect torque ripple."""

    id = "torque_ripple"
    title = "The torque ripples along the angle"
    units = (("amplitude", "N m"), ("harmonic", "1"), ("phase", "rad"))
    experiment = "slow moves at constant speed over the joint's whole range"
    coordinate = "position"
    traits = SearchTraits(discrete=("centre",))

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the waves per turn from two up to what the band shows."""
        del operating_point
        own = site[0] - 1
        highest = BAND_SHARE * 2.0 * np.pi * dataset.band_hz / max(float(dataset.speed[own]), 1e-6)
        return harmonics(dataset.state.position[:, own], lowest=LOWEST, highest=highest, most=MOST)

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del dataset, operating_point
        return Ripple(site[0], scalars["harmonic"], scalars["centre"])

    def admissible(self, solved: FittedCause) -> bool:
        """Want more waves per turn than gravity has."""
        return super().admissible(solved) and solved.scalars["harmonic"] >= LOWEST

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the wave: the drive has to give amplitude cos(harmonic q + phase) more."""
        return wave_quantities(solved, "N m")

    def statement(self, solved: FittedCause) -> str:
        """Say how high the wave is, and how often it comes per turn."""
        found = named(self.quantities(solved))
        return (
            f"Joint {solved.site[0]}'s torque ripples by {shown(found['amplitude'])} to either side, "
            f"{shown(found['harmonic'])} times per turn of the joint"
        )
