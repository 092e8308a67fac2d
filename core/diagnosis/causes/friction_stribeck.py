"""Candidate cause: Stribeck friction, an excess over the Coulomb level that decays with speed."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.friction_stribeck import Stribeck
from .protocol import FittedCause, Scalars, Setting
from .shared.own_joint import OwnJointCause, geometric_grid

SLOWEST, QUICKEST, STEPS = 0.03, 1.0, 9
"""Speeds as shares of the joint's RMS speed, on a logarithmic scale."""


@dataclass(frozen=True)
class FrictionStribeck(OwnJointCause):
    """Candidate cause: Stribeck friction."""

    id = "friction_stribeck"
    title = "Stribeck friction"
    units = (("excess_torque", "N m"), ("stribeck_velocity", "rad/s"))
    experiment = "slow constant-speed moves, 1 % to 20 % of the joint's speed, in both directions"

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the Stribeck velocity from 3 % of the RMS speed to the RMS speed."""
        speed = max(float(at.dataset.speed[at.joint - 1]), 1e-6)
        velocities = geometric_grid(SLOWEST * speed, QUICKEST * speed, STEPS)
        return [{"stribeck_velocity": velocity} for velocity in velocities]

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return Stribeck(at.joint, at.scalars["stribeck_velocity"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a positive excess."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def statement(self, solved: FittedCause) -> str:
        """State excess and Stribeck velocity."""
        found = self.by_name(solved)
        return (
            f"Stribeck friction on joint {solved.site[0]}: {found['excess_torque'].text} above the "
            f"Coulomb level near standstill, decaying over {found['stribeck_velocity'].text}"
        )
