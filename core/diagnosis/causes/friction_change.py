"""Candidate cause: friction or offset of a joint that changed since the reference (wear, grease, cold)."""

from dataclasses import dataclass
from operator import attrgetter

from ...dynamics.term import Term
from ...dynamics.terms.friction_change import FrictionChange as FrictionChangeTerm
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Setting
from .shared.own_joint import OwnJointCause

WORDS = {"delta_viscous": "viscous friction", "delta_coulomb": "Coulomb friction", "delta_offset": "offset"}


@dataclass(frozen=True)
class FrictionChange(OwnJointCause):
    """Candidate cause: friction that has changed since the reference."""

    id = "friction_change"
    title = "Friction change since the reference"
    units = (("delta_viscous", "N m s/rad"), ("delta_coulomb", "N m"), ("delta_offset", "N m"))
    experiment = "constant-speed moves of this joint at three speeds or more, each in both directions"

    def term(self, at: Setting) -> Term:
        """Give the columns, smoothed as those of the operating point's model."""
        widths = at.operating_point.model.smoothing_widths
        return FrictionChangeTerm(at.joint, widths[at.joint - 1] if widths else 0.0)

    def statement(self, solved: FittedCause) -> str:
        """State the significant changes, or the most significant one."""
        found = self.quantities(solved)
        clear = [change for change in found if change.clearness > ADMISSIBLE.significant] or [
            max(found, key=attrgetter("clearness"))
        ]
        changes = " and ".join(f"{WORDS[change.name]} by {change.text}" for change in clear)
        return f"Friction change on joint {solved.site[0]} since the reference: {changes}"
