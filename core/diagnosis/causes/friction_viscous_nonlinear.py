"""Candidate cause: nonlinear viscous friction, a power of the speed beside the linear one."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.friction_viscous_nonlinear import NonlinearViscous
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Scalars, Setting
from .shared.own_joint import OwnJointCause

EXPONENTS = (0.3, 0.5, 0.7, 0.85, 1.2, 1.5, 2.0, 2.5, 3.0)
"""A power of zero is Coulomb friction, of one viscous friction: the model has both."""


@dataclass(frozen=True)
class FrictionViscousNonlinear(OwnJointCause):
    """Candidate cause: friction that is not linear in speed."""

    id = "friction_viscous_nonlinear"
    title = "Nonlinear viscous friction"
    units = (("coefficient", "N m (s/rad)^p"), ("exponent", "1"))
    experiment = "constant-speed moves from 5 % to 100 % of the joint's speed, in both directions"

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the power."""
        del at
        return [{"exponent": value} for value in EXPONENTS]

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return NonlinearViscous(at.joint, at.scalars["exponent"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a power that is neither Coulomb nor viscous friction."""
        power = solved.scalars["exponent"]
        return (
            super().admissible(solved)
            and power >= ADMISSIBLE.power_distance
            and abs(power - 1.0) >= ADMISSIBLE.power_distance
        )

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Doubt a power near zero, and one that may be 0 or 1.

        Near zero it differs from Coulomb friction next to reversals only. Where it does not differ from 0 or
        from 1 significantly, it may as well be Coulomb or linear friction, and something else is left.
        """
        del at
        power, deviation = solved.scalars["exponent"], solved.deviations.get("exponent", 0.0)
        apart = min(power, abs(power - 1.0))
        return power >= ADMISSIBLE.least_power and apart > ADMISSIBLE.significant * deviation

    def statement(self, solved: FittedCause) -> str:
        """State exponent and coefficient."""
        found = self.by_name(solved)
        grows = "grows" if solved.values[0] > 0.0 else "falls"
        return (
            f"Nonlinear viscous friction on joint {solved.site[0]}: it {grows} with speed to the power "
            f"{found['exponent'].text}, coefficient {found['coefficient'].text}"
        )
