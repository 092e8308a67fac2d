"""Suspect play in a joint's transmission, between the motor's encoder and the link."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.backlash import Backlash as BacklashTerm
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import (
    OwnJointCause,
    before_the_gear,
    motor_inertias,
    named,
    shown,
    spread,
)
from .shared.sites import revolute_joints
from .traits import SearchTraits

NARROWEST, WIDEST, STEPS = 1e-4, 3e-2, 13
"""Half widths in rad, evenly spread on a logarithmic scale: half as wide again is another motion."""
NARROWER, WIDER = 8.0, 5.0
"""By how much the width may seem less or more than that which the crossings were computed for.

Both are set by hand: in simulated play the best crossings are those of a wider gap, and seem too small a one.
"""
SMOOTHING_OVER_BAND = 1.5


@dataclass(frozen=True)
class Backlash(OwnJointCause):
    """Suspect play between a motor and its link."""

    id = "backlash"
    title = "The transmission has play"
    units = (("half_width", "rad"), ("motor_inertia", "kg m2"))
    experiment = "slow motion through postures where the load on this joint changes its sign"
    coordinate = "load"
    traits = SearchTraits(linearisation_error=0.15)

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List the joints that turn."""
        del operating_point
        return [(joint,) for joint in revolute_joints(dataset.robot)]

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the width of the gap, of which the time of crossing is the cube root."""
        return [
            {"around": value, **rotor}
            for rotor in motor_inertias(dataset, operating_point, site)
            for value in spread(NARROWEST, WIDEST, STEPS)
        ]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        band = SMOOTHING_OVER_BAND * dataset.band_hz
        return BacklashTerm(
            site[0], operating_point, scalars["around"], band, scalars.get("motor_inertia", 0.0)
        )

    def admissible(self, solved: FittedCause) -> bool:
        """Want a gap of about the width that the crossings were computed for."""
        around = solved.scalars["around"]
        return super().admissible(solved) and bool(around / NARROWER < solved.values[0] < WIDER * around)

    def statement(self, solved: FittedCause) -> str:
        """Say how wide the gap is."""
        found = named(self.quantities(solved))
        return (
            f"Joint {solved.site[0]}'s transmission has play: the link lags or leads its motor by "
            f"{shown(found['half_width'])}, on the side from which the load presses{before_the_gear(found)}"
        )
