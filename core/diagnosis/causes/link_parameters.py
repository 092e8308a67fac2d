"""Candidate cause: inertial parameters of a link that differ from the reference, not by an added body."""

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter

from ...dynamics.term import Term
from ...dynamics.terms.link_parameters import LinkChange
from ...robot.model import INERTIAL_SYMBOLS, INERTIAL_UNITS, RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Setting, Site
from .shared.bodies import is_body
from .shared.own_joint import OwnJointCause, links_by_joint

LISTED = 3
"""Numbers in a statement."""


@dataclass(frozen=True)
class LinkParameters(OwnJointCause):
    """Candidate cause: a difference of all ten parameters of a link."""

    id = "link_parameters"
    title = "Inertial parameters of a link differ from the reference"
    cure = "robot"
    units = tuple((f"delta_{symbol}", INERTIAL_UNITS[symbol]) for symbol in INERTIAL_SYMBOLS)
    experiment = (
        "fast motion of all joints at once through postures in which this link is vertical and horizontal"
    )
    coordinate = "position"

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List the joints with a link of their own."""
        return [(joint,) for joint in links_by_joint(dataset.robot)]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return LinkChange(at.joint, links_by_joint(at.dataset.robot)[at.joint])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a difference that is neither a body nor minus one: that is a payload."""
        return super().admissible(solved) and not is_body(solved.values, solved.covariance)

    def statement(self, solved: FittedCause) -> str:
        """State the parameters that differ most, in units of their standard deviation."""
        first = sorted(self.quantities(solved), key=attrgetter("clearness"), reverse=True)[:LISTED]
        clear = [change for change in first if change.clearness > ADMISSIBLE.significant] or first[:1]
        changes = ", ".join(f"{change.name.removeprefix('delta_')} by {change.text}" for change in clear)
        return f"Link of joint {solved.site[0]} differs from the reference: {changes}"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State that a description holds no inertial parameters but the prior's."""
        del robot, numbers
        return (
            f"The description stays as it is: a new identification gives the link of joint {joints[0]} its "
            "own parameters"
        )
