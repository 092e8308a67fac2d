"""Candidate cause: the force of a cable or hose over part of a joint's range."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.cable_force import Cable
from .protocol import FittedCause, Quantity, Scalars, SearchTraits, Setting
from .shared.own_joint import OwnJointCause

SHARES = (0.15, 0.3, 0.45, 0.6, 0.75, 0.85, 0.93)
"""Shares of the samples during which the cable is slack."""


@dataclass(frozen=True)
class CableForce(OwnJointCause):
    """Candidate cause: a cable or hose that is taut over part of the range."""

    id = "cable_force"
    title = "Cable or hose force over part of the range"
    units = (("stiffness", "N m/rad"), ("engage_angle", "rad"))
    experiment = "slow moves to both ends of the joint's range"
    coordinate = "position"
    traits = SearchTraits(discrete=("side",))

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the angle of engagement for pulls above it, then for pulls below it."""
        angle = at.dataset.state.position[:, at.joint - 1]
        above = [(float(np.quantile(angle, share)), 1.0) for share in SHARES]
        below = [(float(np.quantile(angle, 1.0 - share)), -1.0) for share in reversed(SHARES)]
        return [{"engage_angle": engaged, "side": side} for engaged, side in above + below]

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return Cable(at.joint, at.scalars["engage_angle"], at.scalars["side"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a cable that pulls back."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give stiffness and angle of engagement."""
        angle, deviation = solved.scalars["engage_angle"], solved.deviations.get("engage_angle", 0.0)
        return (
            Quantity(
                "stiffness",
                solved.site[0],
                solved.unit("N m/rad"),
                float(solved.values[0]),
                float(solved.covariance[0, 0] ** 0.5),
            ),
            Quantity("engage_angle", solved.site[0], solved.unit("rad"), angle, deviation),
        )

    def statement(self, solved: FittedCause) -> str:
        """State the angle of engagement and the stiffness."""
        found = self.by_name(solved)
        side = "above" if solved.scalars["side"] >= 0.0 else "below"
        return (
            f"Cable or hose force on joint {solved.site[0]}: stiffness {found['stiffness'].text} "
            f"{side} {found['engage_angle'].text}"
        )
