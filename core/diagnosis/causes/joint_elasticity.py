"""Candidate cause: joint elasticity between the motor encoder and the link."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.joint_elasticity import Elasticity
from ..thresholds.causes import ADMISSIBLE, LINEARISATION
from ..thresholds.dataset import BAND
from .protocol import FittedCause, Quantity, Scalars, SearchTraits, Setting
from .shared.own_joint import OwnJointCause, geometric_grid, motor_inertias, rotor_text

LOWEST, HIGHEST, POINTS = 1.8, 4.0, 8
DAMPING_RATIOS = (0.02, 0.2)
"""Refined from 0.002 on. Taken for more damped than it is, a spring leaves a torque that leads."""


@dataclass(frozen=True)
class JointElasticity(OwnJointCause):
    """Candidate cause: joint elasticity."""

    id = "joint_elasticity"
    title = "Joint elasticity"
    units = (("stiffness", "N m/rad"), ("damping", "N m s/rad"), ("motor_inertia", "kg m2"))
    experiment = "motion with large accelerations, up to a third of the expected resonance"
    coordinate = "load_jerk"
    traits = SearchTraits(linearisation_error=LINEARISATION.transmission, like_position_noise=True)

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan resonance, from a few times the motion's bandwidth to beyond the data set's, and damping."""
        ends = (LOWEST * at.dataset.motion_band_hz, HIGHEST * at.dataset.band_hz)
        return [
            {"resonance_hz": frequency, "damping_ratio": ratio, **rotor}
            for rotor in motor_inertias(at)
            for frequency in geometric_grid(*ends, POINTS)
            for ratio in DAMPING_RATIOS
        ]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        response = (at.scalars["resonance_hz"], at.scalars["damping_ratio"])
        # A load is as smooth as the positions are: a lower limit would weaken the column at a low resonance.
        smooth_hz = BAND.position * at.dataset.band_hz
        return Elasticity(
            at.joint, at.operating_point, smooth_hz, *response, at.scalars.get("motor_inertia", 0.0)
        )

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a positive compliance, with a resonance: without its peak a spring would be a mere lag."""
        resonates = solved.scalars["damping_ratio"] < ADMISSIBLE.damping_ratio
        return super().admissible(solved) and resonates and bool(solved.values[0] > 0.0)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report stiffness (with the compliance's relative deviation), damping and, if any, rotor inertia."""
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
            *(rotor for rotor in super().quantities(solved) if rotor.name == "motor_inertia"),
        )

    def statement(self, solved: FittedCause) -> str:
        """State the stiffness."""
        found = self.by_name(solved)
        return (
            f"Joint elasticity on joint {solved.site[0]}: stiffness {found['stiffness'].text} "
            f"between the motor encoder and the link{rotor_text(found)}"
        )
