"""Candidate cause: a spring or counterbalance parallel to a joint's motor."""

from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.spring_compensator import Spring
from .protocol import FittedCause, Setting
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class SpringCompensator(OwnJointCause):
    """Candidate cause: a spring parallel to the motor."""

    id = "spring_compensator"
    title = "Spring parallel to the motor"
    units = (("stiffness", "N m/rad"),)
    experiment = "hold ten postures spread over the whole range of the joint"
    coordinate = "position"

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return Spring(at.joint)

    def statement(self, solved: FittedCause) -> str:
        """State the stiffness and its sign."""
        found = self.by_name(solved)
        acts = "towards" if solved.values[0] > 0.0 else "away from"
        return (
            f"Spring parallel to the motor of joint {solved.site[0]}: {found['stiffness'].text}, "
            f"{acts} its rest angle, which the torque offset absorbs"
        )
