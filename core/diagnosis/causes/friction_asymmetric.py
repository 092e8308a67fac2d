"""Candidate cause: viscous friction that differs between the two directions of motion."""

from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.friction_asymmetric import AsymmetricViscous
from .protocol import FittedCause, Setting
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class FrictionAsymmetric(OwnJointCause):
    """Candidate cause: direction-dependent viscous friction."""

    id = "friction_asymmetric"
    title = "Direction-dependent viscous friction"
    units = (("delta_viscous", "N m s/rad"),)
    experiment = "constant-speed moves at three speeds or more, each in both directions"

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return AsymmetricViscous(at.joint)

    def statement(self, solved: FittedCause) -> str:
        """State the direction of more friction and half the difference."""
        found = self.by_name(solved)["delta_viscous"]
        more, less = ("forwards", "backwards") if found.value > 0.0 else ("backwards", "forwards")
        return (
            f"Direction-dependent viscous friction on joint {solved.site[0]}: {more} more and {less} less "
            f"than the mean by {found.text}"
        )
