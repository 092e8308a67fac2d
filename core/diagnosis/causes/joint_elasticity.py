"""Suspect a compliant gear between the motor's encoder and the link."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.elasticity import Elasticity
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Quantity, Scalars, Site
from .shared.common import (
    OwnJointCause,
    before_the_gear,
    motor_inertias,
    named,
    shown,
    spread,
)
from .traits import SearchTraits

LOWEST, HIGHEST, POINTS = 2.5, 4.0, 7
DAMPING_RATIOS = (0.05, 0.2)


@dataclass(frozen=True)
class JointElasticity(OwnJointCause):
    """Suspect joint elasticity."""

    id = "joint_elasticity"
    title = "The gear is compliant"
    units = (("stiffness", "N m/rad"), ("damping", "N m s/rad"), ("motor_inertia", "kg m2"))
    experiment = "motion with large accelerations, up to a third of the expected resonance"
    coordinate = "load_jerk"
    traits = SearchTraits(linearisation_error=0.15, like_position_noise=True)

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the resonance from a few times the motion's band to beyond the look's, and the damping."""
        ends = (LOWEST * dataset.motion_band_hz, HIGHEST * dataset.band_hz)
        return [
            {"resonance_hz": frequency, "damping_ratio": ratio, **rotor}
            for rotor in motor_inertias(dataset, operating_point, site)
            for frequency in spread(*ends, POINTS)
            for ratio in DAMPING_RATIOS
        ]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        response = (scalars["resonance_hz"], scalars["damping_ratio"])
        return Elasticity(
            site[0], operating_point, dataset.band_hz, *response, scalars.get("motor_inertia", 0.0)
        )

    def admissible(self, solved: FittedCause) -> bool:
        """Want a spring that gives way."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the stiffness, of the compliance's relative deviation, the damping, and the rotor if any."""
        compliance, deviation = float(solved.values[0]), float(solved.covariance[0, 0] ** 0.5)
        joint, angular = solved.site[0], 2.0 * np.pi * solved.scalars["resonance_hz"]
        damping = 2.0 * solved.scalars["damping_ratio"] / (angular * compliance)
        doubts = [deviation / compliance]
        doubts += [
            solved.deviations.get(name, 0.0) / solved.scalars[name]
            for name in ("resonance_hz", "damping_ratio")
        ]
        doubt = float(np.linalg.norm(doubts))
        return (
            Quantity("stiffness", joint, solved.unit("N m/rad"), 1.0 / compliance, deviation / compliance**2),
            Quantity("damping", joint, solved.unit("N m s/rad"), damping, damping * doubt),
            *(one for one in super().quantities(solved) if one.name == "motor_inertia"),
        )

    def statement(self, solved: FittedCause) -> str:
        """Say how stiff the gear is."""
        found = named(self.quantities(solved))
        return (
            f"Joint {solved.site[0]}'s gear gives way under load: stiffness {shown(found['stiffness'])} "
            f"between the motor's encoder and the link{before_the_gear(found)}"
        )
