"""Candidate cause: friction that grows with the torque that the transmission carries.

Where a fit cannot separate a rotor's inertia from its link's, this friction can: only the link's is
transmitted.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.friction_load_dependent import LoadFriction
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Scalars, Setting
from .shared.own_joint import OwnJointCause, motor_inertias, rotor_text


@dataclass(frozen=True)
class FrictionLoadDependent(OwnJointCause):
    """Candidate cause: load-dependent friction."""

    id = "friction_load_dependent"
    title = "Load-dependent friction"
    units = (("load_coefficient", "1"), ("motor_inertia", "kg m2"))
    experiment = "slow moves in both directions through postures of low and of high gravity torque"
    coordinate = "load"

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the motor-side inertia where the fit cannot separate it from the link's."""
        return motor_inertias(at)

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return LoadFriction(at.joint, at.operating_point, at.scalars.get("motor_inertia", 0.0))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit friction that brakes, and less than all of the load."""
        return super().admissible(solved) and bool(0.0 < solved.values[0] < 1.0)

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Doubt a gear that locks itself: the torque then is not all of the load, or not in its unit."""
        del at
        return bool(solved.values[0] <= ADMISSIBLE.load_friction)

    def statement(self, solved: FittedCause) -> str:
        """State friction per unit of load."""
        found, unit = self.by_name(solved), solved.unit("N m")
        return (
            f"Load-dependent friction on joint {solved.site[0]}: {found['load_coefficient'].text} "
            f"{unit} per {unit} of transmitted {'force' if solved.slides else 'torque'}{rotor_text(found)}"
        )
